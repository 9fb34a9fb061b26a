// Faults of the simulated laboratory: what goes wrong, with whom, and from when to when.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "rig/bench/simulation/world.h"

namespace waverig::rig::bench {

enum class FaultType {
  kHang,       // takes commands, does not answer
  kSlow,       // answers value seconds late
  kDisappear,  // is not there: no connection, silence on the bus
  kError,      // reports SCPI error -300 after each command
  kWrong,      // its readings are value instead
  kCorrupt,    // a port: part value of the frames has a broken bit
  kSilent,     // a port: no frames
  kHunt,       // the chamber never settles: it hunts by value degC
};

struct Fault {
  std::string device;  // instrument, gateway or port
  FaultType type = FaultType::kHang;
  double from_s = 0, to_s = 1e12;  // since the laboratory's start
  double value = 0;
};

struct SimulationSettings {
  std::int64_t start_utime = 1'704'067'200'000'000;  // 2024-01-01: a simulated run does not look at the clock
  WorldSettings world;
  std::vector<Fault> faults;
};

// The fault of that kind that the device has now, or nullptr.
const Fault* active(const std::vector<Fault>& faults, std::string_view device, FaultType type, double time_s);

// A file (TOML): seed, noise_seed, start, [drift] and [[fault]] tables. Throws UserError.
// rig/sequences/simulation.toml shows every key.
SimulationSettings load_simulation(const std::filesystem::path& file);

}  // namespace waverig::rig::bench
