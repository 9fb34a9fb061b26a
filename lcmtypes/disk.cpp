#include "lcmtypes/disk.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>

#include "lcmtypes/error.h"

namespace waverig {
namespace {

namespace fs = std::filesystem;

// Not every file system can do it of a folder, or lets anybody open one: that is no failure.
void bring_to_disk(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  const std::error_code error(::fsync(descriptor) == 0 ? 0 : errno, std::generic_category());
  ::close(descriptor);
  if (is_of_the_machine(error)) throw fs::filesystem_error("fsync", path, error);
}

}  // namespace

bool is_of_the_machine(const std::error_code& why) {
  if (why.category() != std::generic_category() && why.category() != std::system_category()) return false;
  constexpr std::array kOfTheMachine = {ENOSPC, EDQUOT, EFBIG, EIO, ENOMEM, EMFILE, ENFILE};
  return std::ranges::find(kOfTheMachine, why.value()) != kOfTheMachine.end();
}

void refuse_place(const std::error_code& why, const std::string& sentence) {
  if (is_of_the_machine(why)) throw std::runtime_error(sentence);
  throw UserError(sentence);
}

void rename_whole(const fs::path& from, const fs::path& to) {
  bring_to_disk(from);
  fs::rename(from, to);
  bring_to_disk(to.has_parent_path() ? to.parent_path() : ".");
}

}  // namespace waverig
