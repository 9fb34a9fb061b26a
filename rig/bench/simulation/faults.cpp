#include "rig/bench/simulation/faults.h"

#include <ctime>

#include "rig/bench/quantity.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {
namespace {

const std::vector<std::string> kTypes = {"hang",  "slow",    "disappear", "error",
                                         "wrong", "corrupt", "silent",    "hunt"};

// "2025-03-01T08:00:00Z", or a day.
std::int64_t utime_of(TomlTable& table, const char* key) {
  std::tm tm{};
  const std::string text = table.text(key, {});
  const char* end = ::strptime(text.c_str(), text.size() > 10 ? "%Y-%m-%dT%H:%M:%SZ" : "%Y-%m-%d", &tm);
  if (end == nullptr || *end != '\0') table.refuse(key, "a time such as \"2025-03-01T08:00:00Z\", or a day");
  return static_cast<std::int64_t>(::timegm(&tm)) * 1'000'000;
}

}  // namespace

const Fault* active(const std::vector<Fault>& faults, std::string_view device, FaultType type,
                    double time_s) {
  for (const Fault& f : faults)
    if (f.device == device && f.type == type && time_s >= f.from_s && time_s < f.to_s) return &f;
  return nullptr;
}

SimulationSettings load_simulation(const std::filesystem::path& file) {
  TomlFile document(file);
  TomlTable& root = document.root();
  SimulationSettings settings;
  const auto seed = [](TomlTable& table, const char* key) {
    return static_cast<std::uint64_t>(table.integer(key, 1, {0, 9e15}));
  };
  settings.world.seed = seed(root, "seed");
  settings.world.noise_seed = seed(root, "noise_seed");
  if (root.has("start")) settings.start_utime = utime_of(root, "start");
  TomlTable drift = root.table("drift");
  const auto quantity = [&](const char* key, const char* fallback, const char* base) {
    return parse_quantity(drift.text(key, fallback), base, drift.place_of(key) + ": " + drift.name_of(key))
        .si;
  };
  settings.world.drift = {seed(drift, "seed"), quantity("scale", "0 ppm", "1"), quantity("bias", "0 A", "A")};
  for (TomlTable& table : root.tables("fault")) {
    const auto seconds = [&](std::string_view key, const char* fallback) {
      return parse_quantity(table.text(key, fallback), "s", table.place_of(key) + ": " + table.name_of(key))
          .si;
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
