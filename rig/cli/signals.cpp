#include "rig/cli/signals.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>

namespace waverig::cli {
namespace {

// All that a handler may touch.
volatile sig_atomic_t told = 0, words_size = 0;
std::array<char, 1024> words;

void speak(int signal) {
  if (words_size > 0) [[maybe_unused]]
    const auto written = ::write(STDERR_FILENO, words.data(), static_cast<std::size_t>(words_size));
  ::raise(signal);  // by then its action is the default one
}

void keep(int signal) { told = signal; }

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  for (const int each : kEndSignals)
    if (!is_ignored(each)) ::sigaction(each, &action, nullptr);
}

}  // namespace

bool is_ignored(int signal) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler == SIG_IGN;
}

void set_last_words(std::string_view line) {
  words_size = 0;
  const std::string_view fits = line.substr(0, words.size());
  std::ranges::copy(fits, words.begin());
  words_size = static_cast<sig_atomic_t>(fits.size());
  handle(speak);
}

void keep_signals() { handle(keep); }

void end_if_told() {
  if (told != 0) throw Interrupted{told};
}

}  // namespace waverig::cli
