#include "lcmtypes/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "lcmtypes/disk.h"

namespace waverig {
namespace fs = std::filesystem;

namespace {

// A device, a pipe, /dev/stdout: no file could take its place, and what is written there stays.
bool is_no_file(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  const bool special = fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
  return special || path.string().starts_with("/proc/");
}

}  // namespace

AtomicFile::AtomicFile(fs::path path) : path_(led_to(std::move(path))), temporary_(path_) {
  if (!is_no_file(path_)) temporary_ += fmt::format(".{}.partial", ::getpid());
  file_.reset(std::fopen(temporary_.c_str(), temporary_ == path_ ? "ab" : "wb"));
  const std::error_code error(file_ ? 0 : errno, std::generic_category());
  if (error) refuse_place(error, fmt::format("{}: cannot be written: {}", path_.string(), error.message()));
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  if (temporary_ != path_) fs::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view text) {
  if (error_ == 0 && std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) error_ = errno;
}

void AtomicFile::flush() {
  if (error_ == 0 && std::fflush(file_.get()) != 0) error_ = errno;
  if (error_ == 0 && temporary_ != path_ && ::fsync(::fileno(file_.get())) != 0) error_ = errno;
  if (error_ != 0)
    throw std::runtime_error(
        fmt::format("{}: not everything could be written: {}", path_.string(), std::strerror(error_)));
}

void AtomicFile::commit() {
  flush();
  try {
    if (temporary_ != path_) rename_whole(temporary_, path_);
  } catch (const fs::filesystem_error& error) {
    refuse_place(error.code(),
                 fmt::format("{}: cannot be written: {}", path_.string(), error.code().message()));
  }
  file_.reset();
}

void write_atomically(const fs::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace waverig
