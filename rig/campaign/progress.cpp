#include "rig/campaign/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace waverig::rig {

Progress::Progress(std::string what, std::size_t total)
    : what_(std::move(what)),
      total_(total),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()) {
  if (terminal_ && total_ > 0) draw("");
}

Progress::~Progress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::done(const std::string& item) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (terminal_) draw(item);
}

void Progress::draw(const std::string& item) const {
  constexpr std::size_t kWidth = 30;
  const std::size_t filled = total_ == 0 ? kWidth : kWidth * done_ / total_;
  std::string bar;
  for (std::size_t i = 0; i < kWidth; ++i) bar += i < filled ? "█" : "░";
  const double elapsed_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string remaining = done_ == 0
                                    ? ""
                                    : fmt::format("{:.0f} s left", elapsed_s / static_cast<double>(done_) *
                                                                       static_cast<double>(total_ - done_));
  fmt::print(stderr, "\r\033[K{} {} {}/{}  {}  {}", what_, bar, done_, total_, remaining, item);
  std::fflush(stderr);
}

}  // namespace waverig::rig
