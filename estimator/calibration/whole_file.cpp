#include "estimator/calibration/whole_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace fs = std::filesystem;

void write_whole(const fs::path& path, std::string_view text) {
  const fs::path part = fmt::format("{}.{}.part", path.string(), ::getpid());
  std::FILE* file = std::fopen(part.c_str(), "wb");
  if (file == nullptr)
    throw UserError(fmt::format("{}: cannot be written: {}; expected a writable place", path.string(),
                                std::strerror(errno)));
  bool whole = std::fwrite(text.data(), 1, text.size(), file) == text.size();
  whole = whole && std::fflush(file) == 0 && ::fsync(::fileno(file)) == 0;
  std::error_code error(whole ? 0 : errno, std::generic_category());
  std::fclose(file);
  if (whole) fs::rename(part, path, error);
  if (!error) return;
  const std::string reason = error.message();
  fs::remove(part, error);
  if (whole)
    throw UserError(
        fmt::format("{}: cannot be written: {}; expected a writable file", path.string(), reason));
  throw std::runtime_error(fmt::format("{}: not everything could be written: {}", path.string(), reason));
}

}  // namespace waverig::estimator
