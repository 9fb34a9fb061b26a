#include "rig/cli/streams.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <stdexcept>
#include <string>

namespace waverig::cli {

void hold_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    // stdout for reading only: what is written there fails, and is told.
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) [[maybe_unused]]
      const int held = ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
}

void finish_stdout() {
  const bool failed = std::ferror(stdout) != 0;  // by then its reason is lost
  errno = 0;
  std::cout.flush();  // the help of the parser; on the same descriptor
  const bool flushed = std::fflush(stdout) == 0 && std::cout.good();
  if (!failed && flushed) return;
  throw std::runtime_error(std::string("stdout: not everything could be written") +
                           (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace waverig::cli
