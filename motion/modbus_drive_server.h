// Serves a SimulatedDrive over Modbus TCP or RTU, so that simulation and hardware stand behind one interface.
//
// A write to the command registers (functions 6, 16, 22 or 23) is one exchange with the drive; reads alone
// only look, and do not feed the drive's watchdog. The drive's time is the clock that is passed in.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include "motion/modbus_link.h"
#include "motion/simulated_drive.h"

namespace waverig::motion {

class ModbusDriveServer {
 public:
  using Clock = std::function<std::int64_t()>;  // microseconds, never decreasing
  static constexpr std::size_t kMostClients = 4;

  // Listens at once. drive must outlive the server. Throws UserError where the address cannot be had.
  ModbusDriveServer(SimulatedDrive& drive, const ModbusLinkSettings& settings, Clock clock);
  ~ModbusDriveServer();
  ModbusDriveServer(const ModbusDriveServer&) = delete;
  ModbusDriveServer& operator=(const ModbusDriveServer&) = delete;

  int port() const { return port_; }  // TCP: the one that was really taken
  // Waits at most so long for requests, answers them, and lets the drive's time go on.
  void serve(int timeout_ms);
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) serve(kTick_ms);
  }

 private:
  struct MappingCloser {
    void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
  };
  static constexpr int kTick_ms = 5;

  void catch_up();  // the drive's time to the clock's
  void accept_client();
  bool answer(int socket);  // false: this client is gone
  bool obey();              // the command registers to the drive; false: the drive is silent
  void show(const DriveFeedback& feedback);

  SimulatedDrive& drive_;
  ModbusContext context_;
  Clock clock_;
  std::int64_t clock_utime_;
  std::unique_ptr<modbus_mapping_t, MappingCloser> mapping_;
  bool serial_ = false;
  int listener_ = -1, port_ = 0;
  std::vector<int> clients_;
};

}  // namespace waverig::motion
