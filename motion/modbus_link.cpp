#include "motion/modbus_link.h"

#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdint>

#include "lcmtypes/error.h"

namespace waverig::motion {

ModbusContext make_modbus_context(const ModbusLinkSettings& s) {
  if (!(s.response_timeout_s > 0 && s.response_timeout_s < 60 && s.byte_timeout_s > 0 &&
        s.byte_timeout_s < 60))
    throw UserError(fmt::format("modbus {}: timeouts of {} s and {} s are not between 0 and 60 s",
                                describe(s), s.response_timeout_s, s.byte_timeout_s));
  ModbusContext context(s.device.empty() ? modbus_new_tcp(s.host.c_str(), s.port)
                                         : modbus_new_rtu(s.device.c_str(), s.baud, s.parity, 8, 1));
  if (!context || modbus_set_slave(context.get(), s.unit) != 0)
    throw UserError(fmt::format("modbus {}, unit {}: {}", describe(s), s.unit, modbus_error_text()));
  const auto micros = [](double time_s) { return static_cast<std::uint32_t>(std::lround(1e6 * time_s)); };
  const std::uint32_t response = micros(s.response_timeout_s), byte = micros(s.byte_timeout_s);
  modbus_set_response_timeout(context.get(), response / 1000000, response % 1000000);
  modbus_set_byte_timeout(context.get(), byte / 1000000, byte % 1000000);
  return context;
}

std::string describe(const ModbusLinkSettings& s) {
  return s.device.empty() ? fmt::format("{}:{}", s.host, s.port) : s.device;
}

std::string modbus_error_text() { return modbus_strerror(errno); }

}  // namespace waverig::motion
