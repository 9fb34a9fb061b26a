// What a test's program brings to the disk, by the names that it has then: the linker takes this fsync instead
// of the C library's. In one source file of a test alone.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace waverig {

inline std::vector<std::string>& synced_files() {
  static std::vector<std::string> files;
  return files;
}

}  // namespace waverig

extern "C" int fsync(int descriptor) {
  waverig::synced_files().push_back(
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor)).string());
  return 0;
}
