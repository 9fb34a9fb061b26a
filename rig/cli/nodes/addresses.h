// The addresses that a node is given: checked here, so that a wrong one is a sentence and not a riddle.
#pragma once
#include <string>

#include "lcmtypes/bus.h"
#include "motion/modbus_link.h"

namespace waverig::cli {

inline constexpr const char* kDefaultBus = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

// udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES. Throws UserError where it is none, or where this machine has
// no way to the group.
Bus open_bus(const std::string& url);

// tcp://ADDRESS:PORT or rtu:DEVICE. Throws UserError.
motion::ModbusLinkSettings drive_link(const std::string& address);

}  // namespace waverig::cli
