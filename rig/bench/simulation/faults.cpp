#include "rig/bench/simulation/faults.h"

#include "rig/bench/quantity.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {
namespace {

const std::vector<std::string> kTypes = {"hang", "slow", "disappear", "error", "wrong", "corrupt", "silent", "hunt"};

}  // namespace

const Fault* active(const std::vector<Fault>& faults, std::string_view device, FaultType type, double time_s) {
  for (const Fault& f : faults)
    if (f.device == device && f.type == type && time_s >= f.from_s && time_s < f.to_s) return &f;
  return nullptr;
}

SimulationSettings load_simulation(const std::filesystem::path& file) {
  TomlFile document(file);
  TomlTable& root = document.root();
  SimulationSettings settings;
  settings.world.seed = static_cast<std::uint64_t>(root.integer("seed", 1, {0, 9e15}));
  for (TomlTable& table : root.tables("fault")) {
    const auto seconds = [&](std::string_view key, const char* fallback) {
      return parse_quantity(table.text(key, fallback), "s", table.place_of(key) + ": " + table.name_of(key)).si;
    };
    Fault fault;
    fault.device = table.text("device", {});
    const std::string type = table.choice("type", {}, kTypes);
    for (std::size_t i = 0; i < kTypes.size(); ++i)
      if (kTypes[i] == type) fault.type = static_cast<FaultType>(i);
    fault.from_s = seconds("from", "0 s");
    fault.to_s = seconds("to", "1000000 h");
    fault.value = table.number("value", 0.0);
    settings.faults.push_back(fault);
  }
  root.refuse_unknown_keys();
  return settings;
}

}  // namespace waverig::rig::bench
