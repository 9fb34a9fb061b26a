// Progress of a long job on stderr, with the remaining time; silent where stderr is no terminal.
// The one place of a campaign that reads a clock: it decides nothing.
#pragma once
#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>

namespace waverig::rig {

class Progress {
 public:
  Progress(std::string what, std::size_t total);
  ~Progress();
  void done(const std::string& item);  // one more is done; any thread

 private:
  void draw(const std::string& item) const;

  std::string what_;
  std::size_t total_, done_ = 0;
  bool terminal_;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
};

}  // namespace waverig::rig
