// The bench's instruments, simulated: each kind as SCPI commands over the world's controls.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "rig/bench/simulation/scpi_device.h"
#include "rig/bench/simulation/world.h"

namespace waverig::rig::bench {

// calibrator, switch_matrix, dmm, chamber, function_generator, power_supply.
const std::vector<std::string>& device_kinds();

// wired: it acts on the world. One that is not wired answers all the same, as a spare instrument in the rack
// does. Throws UserError for an unknown kind, naming the known ones.
std::unique_ptr<ScpiDevice> make_device(const std::string& kind, const std::string& name, World& world,
                                        bool wired);

// What the converter unit understands on its ports: "RATE 100", "RATE 0.01", "RATE 0" (silence), "MONITOR 1".
void unit_command(World& world, std::string_view line);

}  // namespace waverig::rig::bench
