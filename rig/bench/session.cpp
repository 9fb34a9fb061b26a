#include "rig/bench/session.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <lxi.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kLineMax = 1 << 20;  // no instrument of ours says more in one line

std::int64_t microseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e6); }

std::string without_end(std::string line) {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  return line;
}

}  // namespace

TcpLink::TcpLink(Reactor& reactor, std::string who, const std::string& host, int port)
    : reactor_(reactor), who_(std::move(who)), host_(host), port_(port) {}

void TcpLink::fail(FaultKind kind, const std::string& what) {
  close();
  throw InstrumentError(kind, who_, what);
}

void TcpLink::close() {
  if (descriptor_ < 0) return;
  if (VirtualTime* time = reactor_.virtual_time(); time != nullptr) time->closed(cable_);
  ::close(descriptor_);
  descriptor_ = -1;
  buffer_.clear();
}

void TcpLink::connect(double timeout_s) {
  addrinfo hints{}, *found = nullptr;
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  if (::getaddrinfo(host_.c_str(), std::to_string(port_).c_str(), &hints, &found) != 0 || found == nullptr)
    fail(FaultKind::kRefused, fmt::format("{}:{}: unknown host", host_, port_));
  descriptor_ = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  int result = descriptor_ < 0 ? -1 : ::connect(descriptor_, found->ai_addr, found->ai_addrlen);
  ::freeaddrinfo(found);
  if (result < 0 && errno == EINPROGRESS) {
    pollfd waiting{descriptor_, POLLOUT, 0};
    const int ready = ::poll(&waiting, 1, static_cast<int>(timeout_s * 1000));
    int error = ETIMEDOUT;
    socklen_t size = sizeof error;
    if (ready > 0) ::getsockopt(descriptor_, SOL_SOCKET, SO_ERROR, &error, &size);
    result = error == 0 ? 0 : -1;
    errno = error;
  }
  if (result < 0) fail(FaultKind::kRefused, fmt::format("{}:{}: {}", host_, port_, std::strerror(errno)));
  const int on = 1;
  ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own), &size);
  cable_ = ntohs(own.sin_port);
}

void TcpLink::send(std::string_view bytes, double timeout_s) {
  if (!connected()) connect(timeout_s);
  if (VirtualTime* time = reactor_.virtual_time(); time != nullptr)
    time->sent(cable_, static_cast<std::int64_t>(bytes.size()));
  while (!bytes.empty()) {
    const ssize_t put = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (put > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(put));
      continue;
    }
    pollfd waiting{descriptor_, POLLOUT, 0};
    if (put < 0 && errno == EAGAIN && ::poll(&waiting, 1, static_cast<int>(timeout_s * 1000)) > 0) continue;
    fail(FaultKind::kDisconnected, std::strerror(errno));
  }
}

std::string TcpLink::read_line(double timeout_s) {
  const std::int64_t deadline = reactor_.now() + microseconds(timeout_s);
  while (true) {
    if (const std::size_t end = buffer_.find('\n'); end != std::string::npos) {
      const std::string line = without_end(buffer_.substr(0, end));
      buffer_.erase(0, end + 1);
      return line;
    }
    if (buffer_.size() > kLineMax) fail(FaultKind::kUnexpected, "an answer without an end");
    bool readable = false;
    try {
      readable = reactor_.wait_readable(descriptor_, deadline);
    } catch (...) {  // stopped while an answer is under way: nobody may take it for that of the next question
      close();
      throw;
    }
    if (!readable) fail(FaultKind::kTimeout, fmt::format("waited {:g} s", timeout_s));
    std::array<char, 4096> bytes;
    const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (got <= 0)
      fail(FaultKind::kDisconnected, got == 0 ? "closed by the other side" : std::strerror(errno));
    if (VirtualTime* time = reactor_.virtual_time(); time != nullptr) time->received(cable_, got);
    buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  }
}

void ScpiTcpSession::write(const std::string& command, double timeout_s) {
  link_.send(command + "\n", timeout_s);
}

std::string ScpiTcpSession::query(const std::string& command, double timeout_s) {
  link_.send(command + "\n", timeout_s);
  return link_.read_line(timeout_s);
}

void PrologixGateway::address(int address, double timeout_s) {
  if (!link_.connected()) {
    // Controller, no reading of its own accord, EOI ends a message, LF ends a line.
    link_.send("++mode 1\n++auto 0\n++eoi 1\n++eos 2\n++read_tmo_ms 3000\n", timeout_s);
    current_ = -1;
  }
  if (current_ == address) return;
  link_.send(fmt::format("++addr {}\n", address), timeout_s);
  current_ = address;
}

void PrologixGateway::write(int gpib_address, const std::string& command, double timeout_s) {
  address(gpib_address, timeout_s);
  std::string escaped;
  for (const char c : command) {
    if (c == '\r' || c == '\n' || c == '\x1b' || c == '+') escaped += '\x1b';
    escaped += c;
  }
  link_.send(escaped + "\n", timeout_s);
}

std::string PrologixGateway::query(int gpib_address, const std::string& command, double timeout_s) {
  write(gpib_address, command, timeout_s);
  link_.send("++read eoi\n", timeout_s);
  // An absent instrument is silence; the link is closed and opened anew after it.
  return link_.read_line(timeout_s);
}

void GpibSession::write(const std::string& command, double timeout_s) {
  try {
    gateway_->write(address_, command, timeout_s);
  } catch (const InstrumentError& error) {
    throw InstrumentError(error.kind, who_, error.what());
  }
}

std::string GpibSession::query(const std::string& command, double timeout_s) {
  try {
    return gateway_->query(address_, command, timeout_s);
  } catch (const InstrumentError& error) {
    throw InstrumentError(error.kind, who_, error.what());
  }
}

void Vxi11Session::connect(double timeout_s) {
  static const bool initialised = lxi_init() == LXI_OK;
  if (device_number_ >= 0) return;
  const int timeout_ms = static_cast<int>(timeout_s * 1000);
  device_number_ =
      initialised ? lxi_connect(host_.c_str(), 0, device_.c_str(), timeout_ms, VXI11) : LXI_ERROR;
  if (device_number_ < 0)
    throw InstrumentError(FaultKind::kRefused, who_, fmt::format("VXI-11 device {} at {}", device_, host_));
}

void Vxi11Session::close() {
  if (device_number_ >= 0) lxi_disconnect(device_number_);
  device_number_ = -1;
}

void Vxi11Session::write(const std::string& command, double timeout_s) {
  connect(timeout_s);
  const std::string line = command + "\n";
  if (lxi_send(device_number_, line.data(), static_cast<int>(line.size()),
               static_cast<int>(timeout_s * 1000)) == static_cast<int>(line.size()))
    return;
  close();
  throw InstrumentError(FaultKind::kDisconnected, who_,
                        fmt::format("VXI-11 device {} at {} took no command", device_, host_));
}

std::string Vxi11Session::query(const std::string& command, double timeout_s) {
  write(command, timeout_s);
  std::array<char, 65536>
      answer;  // liblxi blocks; what the answer's delay brought meanwhile is served after it
  const int size = lxi_receive(device_number_, answer.data(), static_cast<int>(answer.size()),
                               static_cast<int>(timeout_s * 1000));
  reactor_.sleep_until(reactor_.now());
  if (size > 0) return without_end(std::string(answer.data(), static_cast<std::size_t>(size)));
  close();
  throw InstrumentError(FaultKind::kTimeout, who_, fmt::format("waited {:g} s", timeout_s));
}

}  // namespace waverig::rig::bench
