#include "estimator/calibration/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace fs = std::filesystem;

void write_whole(const fs::path& path, std::string_view text) {
  const fs::path part = fmt::format("{}.{}.part", path.string(), ::getpid());
  std::FILE* file = std::fopen(part.c_str(), "wb");
  std::error_code error(file != nullptr ? 0 : errno, std::generic_category());
  if (error)
    refuse_place(error, fmt::format("{}: cannot be written: {}; expected a writable place", path.string(),
                                    error.message()));
  bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  whole = whole && std::fflush(file) == 0;
  error.assign(whole ? 0 : errno, std::generic_category());
  std::fclose(file);
  try {
    if (whole) return rename_whole(part, path);
  } catch (const fs::filesystem_error& refused) {
    error = refused.code();
  }
  std::error_code ignored;
  fs::remove(part, ignored);
  if (is_of_the_machine(error))
    throw std::runtime_error(
        fmt::format("{}: not everything could be written: {}", path.string(), error.message()));
  throw UserError(
      fmt::format("{}: cannot be written: {}; expected a writable file", path.string(), error.message()));
}

}  // namespace waverig::estimator
