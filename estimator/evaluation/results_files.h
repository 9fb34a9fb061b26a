// What lies in the results directory of a campaign, by name.
#pragma once
#include <filesystem>
#include <string>

namespace waverig::evaluation {

inline constexpr const char* kSettingsFile = "campaign.toml";  // resolved; anyone can run it again from there
inline constexpr const char* kCalibrationFile = "calibration.json";
inline constexpr const char* kResultsFile = "results.json";
inline constexpr const char* kResultsTable = "results.csv";
inline std::filesystem::path runs_of(const std::filesystem::path& directory) { return directory / "runs"; }
inline std::filesystem::path log_of(const std::filesystem::path& directory, const std::string& run) {
  return runs_of(directory) / (run + ".lcm");
}

}  // namespace waverig::evaluation
