// A drive and its Modbus server in a thread of its own, with a clock that the test sets.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "motion/modbus_drive_server.h"

namespace waverig::motion {

// The patience of every test that does not want a timeout.
inline ModbusLinkSettings patient(int port = 0) {
  return {.port = port, .response_timeout_s = 10, .byte_timeout_s = 5};
}

class Bench {
 public:
  explicit Bench(const ModbusLinkSettings& settings = patient())
      : server_(drive, settings, [this] {
          if (const int ms = stall_ms.exchange(0); ms > 0)
            std::this_thread::sleep_for(std::chrono::milliseconds(ms));
          return now_us.load();
        }) {
    begin();
  }
  void begin() {
    thread_ = std::jthread([this](const std::stop_token& stop) { server_.run(stop); });
  }
  // The drive may be touched only while its server rests.
  void rest() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }
  int port() const { return server_.port(); }

  std::atomic<std::int64_t> now_us = 0;
  std::atomic<int> stall_ms = 0;  // how long the next reply is held back, really
  SimulatedDrive drive;

 private:
  ModbusDriveServer server_;
  std::jthread thread_;
};

}  // namespace waverig::motion
