#include "motion/modbus_drive_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <utility>

#include "lcmtypes/error.h"
#include "motion/modbus_registers.h"

namespace waverig::motion {
namespace {

constexpr std::uint8_t kWriteSingle = 0x06, kWriteMultiple = 0x10, kMaskWrite = 0x16, kWriteAndRead = 0x17;

int big_endian(const std::uint8_t* bytes) { return (bytes[0] << 8) | bytes[1]; }

struct Write {
  int address = 0, count = 0;
  const std::uint8_t* data = nullptr;  // big-endian words; null where the function carries none
};

// The registers that a well-formed request writes; count 0 where it writes none.
Write written_by(const std::uint8_t* pdu, int size) {
  Write write;
  if (size >= 5 && (pdu[0] == kWriteSingle || pdu[0] == kMaskWrite))
    write = {big_endian(pdu + 1), 1, nullptr};
  if (size >= 6 && pdu[0] == kWriteMultiple) write = {big_endian(pdu + 1), big_endian(pdu + 3), pdu + 6};
  if (size >= 10 && pdu[0] == kWriteAndRead) {
    write = {big_endian(pdu + 5), big_endian(pdu + 7), pdu + 10};
    const int read_end = big_endian(pdu + 1) + big_endian(pdu + 3);
    if (read_end > registers::kMapCount) return {};
  }
  if (write.address + write.count > registers::kMapCount) return {};
  if (write.data && (write.data[-1] != 2 * write.count || write.data + 2 * write.count > pdu + size))
    return {};
  return write;
}

bool commands_drive(const Write& write) {
  return write.count > 0 && write.address < registers::kCommandAddress + registers::kCommandCount;
}

}  // namespace

ModbusDriveServer::ModbusDriveServer(SimulatedDrive& drive, const ModbusLinkSettings& settings, Clock clock)
    : drive_(drive),
      context_(make_modbus_context(settings)),
      clock_(std::move(clock)),
      clock_utime_(clock_()),
      mapping_(modbus_mapping_new(0, 0, registers::kMapCount, 0)),
      serial_(!settings.device.empty()) {
  if (!mapping_) throw std::bad_alloc();
  modbus_set_response_timeout(context_.get(), 0,
                              1000);  // so long libmodbus sleeps before it answers "illegal"
  if (serial_) {
    if (modbus_connect(context_.get()) != 0)
      throw UserError(fmt::format("modbus server {}: {}", describe(settings), modbus_error_text()));
    return;
  }
  listener_ = modbus_tcp_listen(context_.get(), static_cast<int>(kMostClients));
  sockaddr_in address{};
  socklen_t length = sizeof address;
  if (listener_ < 0 || getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) != 0)
    throw UserError(
        fmt::format("modbus server {}: cannot listen: {}", describe(settings), modbus_error_text()));
  port_ = ntohs(address.sin_port);
}

ModbusDriveServer::~ModbusDriveServer() {
  for (const int client : clients_) ::close(client);
  if (listener_ >= 0) ::close(listener_);
  if (!serial_) modbus_set_socket(context_.get(), -1);  // closed already
}

void ModbusDriveServer::serve(int timeout_ms) {
  std::vector<pollfd> waiting;
  if (serial_) waiting.push_back({modbus_get_socket(context_.get()), POLLIN, 0});
  if (listener_ >= 0) waiting.push_back({listener_, POLLIN, 0});
  for (const int client : clients_) waiting.push_back({client, POLLIN, 0});
  const int ready = poll(waiting.data(), waiting.size(), timeout_ms);
  catch_up();
  if (ready <= 0) return;
  for (const pollfd& each : waiting) {
    if (each.revents == 0) continue;
    if (each.fd == listener_) {
      accept_client();
    } else if (!answer(each.fd) && !serial_) {
      ::close(each.fd);
      clients_.erase(std::find(clients_.begin(), clients_.end(), each.fd));
    }
  }
}

void ModbusDriveServer::catch_up() {
  const std::int64_t now = clock_();
  if (now <= clock_utime_) return;
  drive_.advance(1e-6 * static_cast<double>(now - clock_utime_));
  clock_utime_ = now;
}

void ModbusDriveServer::accept_client() {
  const int client = modbus_tcp_accept(context_.get(), &listener_);
  if (client < 0) return;
  if (clients_.size() < kMostClients) {
    clients_.push_back(client);
  } else {
    ::close(client);
  }
}

bool ModbusDriveServer::answer(int socket) {
  if (!serial_) modbus_set_socket(context_.get(), socket);
  std::array<std::uint8_t, MODBUS_MAX_ADU_LENGTH> request{};
  const int size = modbus_receive(context_.get(), request.data());
  if (size < 0) return false;
  if (size == 0) return true;  // for another unit
  catch_up();
  const int header = modbus_get_header_length(context_.get());
  const std::uint8_t* pdu = request.data() + header;
  const Write write = written_by(pdu, size - header);
  const bool commanded = commands_drive(write), reads_too = pdu[0] == kWriteAndRead;
  if (commanded && reads_too) {  // the drive must have acted before the reply is read from the map
    for (int i = 0; i < write.count; ++i)
      mapping_->tab_registers[write.address + i] = static_cast<std::uint16_t>(big_endian(write.data + 2 * i));
    if (!obey()) return true;
  } else {
    show(drive_.observe());
  }
  if (drive_.faults.silent) return true;
  if (modbus_reply(context_.get(), request.data(), size, mapping_.get()) < 0) return false;
  if (commanded && !reads_too) obey();
  return true;
}

bool ModbusDriveServer::obey() {
  const std::span<const std::uint16_t, registers::kCommandCount> words(
      mapping_->tab_registers + registers::kCommandAddress, registers::kCommandCount);
  try {
    show(drive_.exchange(registers::decode_command(words)));
  } catch (const std::exception&) {
    return false;  // a silent drive sends nothing
  }
  return true;
}

void ModbusDriveServer::show(const DriveFeedback& feedback) {
  const registers::FeedbackWords words = registers::encode(feedback);
  std::copy(words.begin(), words.end(), mapping_->tab_registers + registers::kFeedbackAddress);
}

}  // namespace waverig::motion
