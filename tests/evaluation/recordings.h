// Where the real recordings are: WAVERIG_DATA, or shared/data beside the project.
#pragma once
#include <cstdlib>
#include <filesystem>

namespace waverig {

inline std::filesystem::path recordings() {
  const char* named = std::getenv("WAVERIG_DATA");
  return named != nullptr ? std::filesystem::path(named)
                          : std::filesystem::path(WAVERIG_SOURCE_DIR) / ".." / "shared" / "data";
}

}  // namespace waverig

#define WAVERIG_NEEDS_RECORDING(path) \
  if (!std::filesystem::exists(path)) \
  GTEST_SKIP() << (path) << " is not there: set WAVERIG_DATA to the recordings"
