#include "rig/campaign/directory_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "lcmtypes/disk.h"

namespace waverig::rig {

void DirectoryLock::Closer::operator()(const int* descriptor) const {
  ::close(*descriptor);
  delete descriptor;
}

std::optional<DirectoryLock> DirectoryLock::take(const std::filesystem::path& directory) {
  const int descriptor = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const std::error_code error(descriptor < 0 ? errno : 0, std::generic_category());
  if (error)
    refuse_place(error, fmt::format("{}: {}; expected a directory that can be read and written",
                                    directory.string(), error.message()));
  DirectoryLock lock(descriptor);
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return std::nullopt;
  return lock;
}

}  // namespace waverig::rig
