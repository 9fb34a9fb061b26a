// PseudoTerminal: the sensor unit's end of a serial line that is none: whoever opens path() finds a serial
// port.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>

namespace waverig::cli {

class PseudoTerminal {
 public:
  // link, where not empty: a name of its own for the line, a symbolic link that lives as long as the line.
  // Throws UserError.
  explicit PseudoTerminal(const std::filesystem::path& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // What nobody listens to is lost, as on a wire; so is what a listener leaves lying too long.
  void send(std::span<const std::uint8_t> bytes);

 private:
  int master_ = -1;
  std::filesystem::path path_, link_;
};

}  // namespace waverig::cli
