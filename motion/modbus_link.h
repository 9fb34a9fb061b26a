// Where a Modbus drive is reached, and the libmodbus context that reaches it.
#pragma once
#include <modbus/modbus.h>

#include <memory>
#include <string>

namespace waverig::motion {

struct ModbusLinkSettings {
  std::string host = "127.0.0.1";  // TCP; server: the address to listen on
  int port = 502;                  // server: 0 takes any free one
  std::string device{};            // not empty: RTU on this serial device
  int baud = 115200;
  char parity = 'E';
  int unit = 1;
  double response_timeout_s = 0.02;
  double byte_timeout_s = 0.01;
};

struct ModbusCloser {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using ModbusContext = std::unique_ptr<modbus_t, ModbusCloser>;

// Not connected yet. Throws UserError where the settings make no link.
ModbusContext make_modbus_context(const ModbusLinkSettings& settings);
std::string describe(const ModbusLinkSettings& settings);  // "127.0.0.1:502" or the device
std::string modbus_error_text();                           // of errno

}  // namespace waverig::motion
