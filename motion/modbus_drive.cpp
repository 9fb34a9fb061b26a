#include "motion/modbus_drive.h"

#include <fmt/format.h>

#include <stdexcept>

#include "lcmtypes/error.h"
#include "motion/modbus_registers.h"

namespace waverig::motion {

ModbusDrive::ModbusDrive(const ModbusLinkSettings& settings)
    : settings_(settings), context_(make_modbus_context(settings)) {
  if (modbus_connect(context_.get()) != 0)
    throw UserError(fmt::format("modbus {}: cannot connect: {}", describe(settings_), modbus_error_text()));
  connected_ = true;
}

DriveFeedback ModbusDrive::exchange(const DriveCommand& command) {
  if (!connected_ && modbus_connect(context_.get()) != 0) fail("cannot connect again");
  connected_ = true;
  modbus_flush(context_.get());
  const registers::CommandWords write = registers::encode(command);
  registers::FeedbackWords read{};
  const int count = modbus_write_and_read_registers(
      context_.get(), registers::kCommandAddress, registers::kCommandCount, write.data(),
      registers::kFeedbackAddress, registers::kFeedbackCount, read.data());
  if (count != registers::kFeedbackCount) fail("no answer");
  return registers::decode_feedback(read);
}

void ModbusDrive::fail(const char* what) {
  const std::string reason = fmt::format("modbus {}: {}: {}", describe(settings_), what, modbus_error_text());
  if (settings_.device.empty()) {
    modbus_close(context_.get());
    connected_ = false;
  } else {
    modbus_flush(context_.get());
  }
  throw std::runtime_error(reason);
}

}  // namespace waverig::motion
