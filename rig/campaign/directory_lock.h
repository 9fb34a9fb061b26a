// One process at a time in a directory: a lock that ends with the process, however it ends.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>

namespace waverig::rig {

class DirectoryLock {
 public:
  // Nothing where another process holds the directory. Where the file system knows no locks it holds nothing
  // back. Throws UserError where the directory cannot be opened.
  static std::optional<DirectoryLock> take(const std::filesystem::path& directory);

 private:
  struct Closer {
    void operator()(const int* descriptor) const;
  };
  explicit DirectoryLock(int descriptor) : descriptor_(new int(descriptor)) {}
  std::unique_ptr<const int, Closer> descriptor_;
};

}  // namespace waverig::rig
