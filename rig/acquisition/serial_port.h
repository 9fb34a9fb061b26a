// SerialPort: bytes from a serial line or pseudo-terminal (termios), raw mode.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace waverig::rig {

class SerialPort {
 public:
  // baud: one of the standard rates up to 4000000 (a pseudo-terminal ignores it). Throws UserError where the
  // port cannot be opened or set.
  SerialPort(const std::filesystem::path& path, int baud);
  ~SerialPort();
  SerialPort(const SerialPort&) = delete;
  SerialPort& operator=(const SerialPort&) = delete;

  // Waits up to timeout_ms for bytes and reads what is there; the part of buffer that was filled, empty on
  // time-out. Throws std::runtime_error where the line is gone.
  std::span<const std::uint8_t> read(std::span<std::uint8_t> buffer, int timeout_ms);
  // Writes all bytes; throws std::runtime_error where the line does not take them in time.
  void write(std::span<const std::uint8_t> bytes, int timeout_ms);
  int descriptor() const { return descriptor_; }  // for poll()

 private:
  std::filesystem::path path_;
  int descriptor_;
};

}  // namespace waverig::rig
