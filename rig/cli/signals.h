// What the signals that ask for an end do to a command that would leave something lying about. Where the
// program was started with a signal ignored it stays so.
#pragma once
#include <signal.h>

#include <array>
#include <string_view>

namespace waverig::cli {

// SIGHUP comes where the terminal was closed or its connection lost; under nohup it is ignored.
inline constexpr std::array kEndSignals = {SIGINT, SIGTERM, SIGHUP};
bool is_ignored(int signal);

// For commands that may end anywhere: a signal says the line on stderr and ends the program. An empty one:
// says nothing.
void set_last_words(std::string_view line);

struct Interrupted {
  int signal;
};

// For commands that clean up: from now on a signal is kept until end_if_told() throws Interrupted, which
// main() turns into the end by that signal. A second signal ends the program at once.
void keep_signals();
void end_if_told();

}  // namespace waverig::cli
