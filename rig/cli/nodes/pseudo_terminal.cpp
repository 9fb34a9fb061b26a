#include "rig/cli/nodes/pseudo_terminal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "lcmtypes/error.h"

namespace waverig::cli {

PseudoTerminal::PseudoTerminal(const std::filesystem::path& link) {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  const char* name =
      master_ >= 0 && grantpt(master_) == 0 && unlockpt(master_) == 0 ? ptsname(master_) : nullptr;
  const int other_end = name != nullptr ? ::open(name, O_RDWR | O_NOCTTY | O_CLOEXEC) : -1;
  termios mode{};
  if (other_end < 0 || tcgetattr(other_end, &mode) != 0) {
    const std::string why = std::strerror(errno);
    if (master_ >= 0) ::close(master_);
    throw UserError(fmt::format("serial line: this machine gives no pseudo-terminal: {}", why));
  }
  cfmakeraw(&mode);  // no echo of what nobody has read yet
  tcsetattr(other_end, TCSANOW, &mode);
  ::close(other_end);  // from now on the line hangs up while nobody listens
  path_ = name;
  if (link.empty()) return;
  std::error_code error;
  if (std::filesystem::is_symlink(link, error)) std::filesystem::remove(link, error);
  std::filesystem::create_symlink(path_, link, error);
  if (error) {
    ::close(master_);
    throw UserError(fmt::format("--serial-link {}: {}; expected a name that can be made", link.string(),
                                error.message()));
  }
  link_ = link;
}

PseudoTerminal::~PseudoTerminal() {
  ::close(master_);
  std::error_code error;
  if (!link_.empty()) std::filesystem::remove(link_, error);
}

void PseudoTerminal::send(std::span<const std::uint8_t> bytes) {
  pollfd line{master_, POLLOUT, 0};
  if (bytes.empty() || ::poll(&line, 1, 0) <= 0 || (line.revents & POLLHUP) != 0) return;
  if (::write(master_, bytes.data(), bytes.size()) < 0) return;  // the line is full, or hung up just now
}

}  // namespace waverig::cli
