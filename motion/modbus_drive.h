// A drive behind Modbus TCP or RTU: one transaction an exchange (function 23, write and read).
//
// Modbus RTU has no transaction id: what lies in the line is flushed before each request, and the drive
// echoes a sequence register that the controller checks. After a failed TCP exchange the connection is made
// anew, so that a late answer dies with the old one.
#pragma once
#include "motion/drive.h"
#include "motion/modbus_link.h"

namespace waverig::motion {

class ModbusDrive final : public Drive {
 public:
  // Connects. Throws UserError where it cannot.
  explicit ModbusDrive(const ModbusLinkSettings& settings);

  DriveFeedback exchange(const DriveCommand& command) override;

 private:
  [[noreturn]] void fail(const char* what);

  ModbusLinkSettings settings_;
  ModbusContext context_;
  bool connected_ = false;
};

}  // namespace waverig::motion
