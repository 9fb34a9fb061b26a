#include "lcmtypes/disk.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
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

std::string content_of(const fs::path& path, std::string_view expected) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  std::string content;
  std::array<char, 1 << 16> block;
  std::size_t got = 0;
  while (file && (got = std::fread(block.data(), 1, block.size(), file.get())) > 0)
    content.append(block.data(), got);
  // A folder opens as a file does, and fails at its first byte.
  const std::error_code error(!file || std::ferror(file.get()) != 0 ? errno : 0, std::generic_category());
  if (error)
    refuse_place(
        error, fmt::format("{}: cannot be read: {}; expected {}", path.string(), error.message(), expected));
  return content;
}

fs::path led_to(fs::path path) {
  constexpr int kMostLinks = 40;  // as Linux; what remains one leads in a circle
  const auto without_slash = [](const fs::path& p) { return p.filename().empty() ? p.parent_path() : p; };
  const auto in_proc = [](const fs::path& p) { return p.string().starts_with("/proc/"); };
  path = without_slash(path);
  std::error_code ignored;  // what may not be looked at is no link
  for (int links = 0; links < kMostLinks && !in_proc(path) && fs::is_symlink(path, ignored); ++links)
    path = without_slash(path.parent_path() / fs::read_symlink(path, ignored));
  return path;
}

void rename_whole(const fs::path& from, const fs::path& to) {
  bring_to_disk(from);
  fs::rename(from, to);
  bring_to_disk(to.has_parent_path() ? to.parent_path() : ".");
}

}  // namespace waverig
