#include "rig/cli/bench_terminal.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cstdio>

#include "rig/bench/quantity.h"
#include "rig/cli/signals.h"

namespace waverig::cli {
namespace {

constexpr auto kRedraw = std::chrono::milliseconds(100);

std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int number) {
  if (stop_asked.exchange(true)) {  // asked twice: at once, as without us
    ::signal(number, SIG_DFL);
    ::raise(number);
  }
}

}  // namespace

BenchTerminal::BenchTerminal()
    : terminal_(::isatty(STDERR_FILENO) == 1), interactive_(terminal_ && ::isatty(STDIN_FILENO) == 1) {}

BenchTerminal::~BenchTerminal() { clear(); }

void BenchTerminal::clear() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void BenchTerminal::show(const rig::bench::Progress& progress) {
  if (progress.alarm != alarm_ || progress.failures != failures_) {
    alarm_ = progress.alarm;
    failures_ = progress.failures;
    clear();
    if (!alarm_.empty())
      fmt::print(stderr, "{}alarm: {}{}\n", terminal_ ? "\033[31m" : "", alarm_, terminal_ ? "\033[0m" : "");
    drawn_ = {};
  }
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ || now - drawn_ < kRedraw) return;
  drawn_ = now;
  fmt::print(stderr, "\r\033[K{}/{}  {} left  {}  {}{}", progress.step->index + 1, progress.steps,
             rig::bench::show_duration(progress.remaining_s), progress.step->path,
             rig::bench::describe_action(*progress.step),
             failures_ > 0 ? fmt::format("  {} failed", failures_) : "");
  std::fflush(stderr);
}

bool BenchTerminal::ask(const std::string& question) {
  clear();
  fmt::print(stderr, "{} [Y/n] ", question);
  std::fflush(stderr);
  std::array<char, 256> answer{};
  if (std::fgets(answer.data(), answer.size(), stdin) == nullptr) return false;
  return answer[0] == '\n' || answer[0] == 'y' || answer[0] == 'Y';
}

StopOnSignal::StopOnSignal() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int each : kEndSignals)
    if (each != SIGHUP || !is_ignored(each)) ::sigaction(each, &action, nullptr);
}

StopOnSignal::~StopOnSignal() {
  for (const int each : kEndSignals)
    if (each != SIGHUP || !is_ignored(each)) ::signal(each, SIG_DFL);
}

const std::atomic<bool>& StopOnSignal::asked() const { return stop_asked; }
void StopOnSignal::clear() { stop_asked = false; }

}  // namespace waverig::cli
