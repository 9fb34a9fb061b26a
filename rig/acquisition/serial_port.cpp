#include "rig/acquisition/serial_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <map>
#include <stdexcept>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

speed_t speed_of(int baud) {
  static const std::map<int, speed_t> speeds{{9600, B9600},       {19200, B19200},     {38400, B38400},
                                             {57600, B57600},     {115200, B115200},   {230400, B230400},
                                             {460800, B460800},   {921600, B921600},   {1000000, B1000000},
                                             {2000000, B2000000}, {3000000, B3000000}, {4000000, B4000000}};
  const auto found = speeds.find(baud);
  if (found == speeds.end())
    throw UserError(
        fmt::format("serial port: baud = {}: expected a standard rate from 9600 to 4000000", baud));
  return found->second;
}

std::string reason() { return std::strerror(errno); }

// True where the line became ready for `events`; false on time-out.
bool wait_for(int descriptor, short events, int timeout_ms, const std::filesystem::path& path) {
  pollfd waiting{descriptor, events, 0};
  int ready;
  do ready = ::poll(&waiting, 1, timeout_ms);
  while (ready < 0 && errno == EINTR);
  if (ready < 0) throw std::runtime_error(fmt::format("{}: {}", path.string(), reason()));
  if ((waiting.revents & events) == 0 && (waiting.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0)
    throw std::runtime_error(fmt::format("{}: the serial line is gone", path.string()));
  return ready > 0;
}

}  // namespace

SerialPort::SerialPort(const std::filesystem::path& path, int baud) : path_(path) {
  const speed_t speed = speed_of(baud);
  descriptor_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0)
    throw UserError(
        fmt::format("{}: {}: expected a serial port or pseudo-terminal", path.string(), reason()));
  termios mode{};
  bool set = ::tcgetattr(descriptor_, &mode) == 0;
  ::cfmakeraw(&mode);
  mode.c_cflag |= CLOCAL | CREAD;
  set = set && ::cfsetspeed(&mode, speed) == 0 && ::tcsetattr(descriptor_, TCSANOW, &mode) == 0;
  if (set) return;
  const std::string why = reason();
  ::close(descriptor_);
  throw UserError(fmt::format("{}: {}: expected a serial port or pseudo-terminal", path.string(), why));
}

SerialPort::~SerialPort() { ::close(descriptor_); }

std::span<const std::uint8_t> SerialPort::read(std::span<std::uint8_t> buffer, int timeout_ms) {
  if (!wait_for(descriptor_, POLLIN, timeout_ms, path_)) return {};
  const ssize_t got = ::read(descriptor_, buffer.data(), buffer.size());
  if (got > 0) return buffer.first(static_cast<std::size_t>(got));
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return {};
  throw std::runtime_error(fmt::format("{}: the serial line is gone", path_.string()));
}

void SerialPort::write(std::span<const std::uint8_t> bytes, int timeout_ms) {
  while (!bytes.empty()) {
    if (!wait_for(descriptor_, POLLOUT, timeout_ms, path_))
      throw std::runtime_error(
          fmt::format("{}: the serial line took no bytes in {} ms", path_.string(), timeout_ms));
    const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
    if (put < 0 && errno != EAGAIN && errno != EINTR)
      throw std::runtime_error(fmt::format("{}: {}", path_.string(), reason()));
    if (put > 0) bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

}  // namespace waverig::rig
