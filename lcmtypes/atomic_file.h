// Files that are there whole or not at all: written beside their name, flushed to the disk, then renamed. Of
// a link that which it leads to; a device or a pipe is written as it is.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace waverig {

class AtomicFile {
 public:
  // Throws UserError where the folder cannot be written, std::runtime_error where the disk is full.
  explicit AtomicFile(std::filesystem::path path);
  ~AtomicFile();  // without commit() nothing remains
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view text);
  // Throws std::runtime_error where the disk did not take everything. Files that belong together are all
  // flushed before the first is committed: what stood there stays until the disk has the whole of the new.
  void flush();
  void commit();

 private:
  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::filesystem::path path_, temporary_;
  std::unique_ptr<std::FILE, Closer> file_;
  int error_ = 0;  // errno of the first write that failed
};

void write_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace waverig
