#include "estimator/evaluation/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "lcmtypes/error.h"

namespace waverig::evaluation {

AtomicFile::AtomicFile(std::filesystem::path path) : path_(std::move(path)), temporary_(path_) {
  temporary_ += fmt::format(".{}.partial", ::getpid());
  file_.reset(std::fopen(temporary_.c_str(), "wb"));
  if (!file_) throw UserError(fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
}

AtomicFile::~AtomicFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void AtomicFile::write(std::string_view text) { std::fwrite(text.data(), 1, text.size(), file_.get()); }

void AtomicFile::commit() {
  const auto failed = [&] {
    return std::runtime_error(
        fmt::format("{}: not everything could be written: {}", path_.string(), std::strerror(errno)));
  };
  if (std::ferror(file_.get()) != 0 || std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0)
    throw failed();
  std::filesystem::rename(temporary_, path_);
  if (std::fclose(file_.release()) != 0) throw failed();
}

void write_atomically(const std::filesystem::path& path, std::string_view text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace waverig::evaluation
