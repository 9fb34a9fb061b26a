// PrologixSide: one connection to the simulated GPIB gateway, after the Prologix GPIB-ETHERNET manual: "++"
// commands for the gateway, everything else for the addressed instrument; an absent instrument answers with
// silence.
#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rig/bench/simulation/rack.h"

namespace waverig::rig::bench {

class PrologixSide {
 public:
  explicit PrologixSide(Rack& rack) : rack_(rack) {}
  // Takes bytes; appends what comes back, each at its time.
  void receive(std::string_view bytes, std::int64_t now_utime, std::vector<Answer>& out);

 private:
  void line(const std::string& text, bool escaped, std::int64_t now_utime, std::vector<Answer>& out);
  void command(const std::string& text, std::int64_t now_utime, std::vector<Answer>& out);
  void read(std::int64_t now_utime, std::vector<Answer>& out);

  Rack& rack_;
  std::string buffer_;
  bool escape_ = false,
       line_escaped_ = false;  // an escaped character stands in the line: it is no "++" command
  int address_ = 0, read_timeout_ms_ = 200;
  bool auto_ = true;
  std::map<int, Answer> waiting_;  // answers that nobody has read yet, by address
};

}  // namespace waverig::rig::bench
