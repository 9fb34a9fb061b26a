// Vxi11Side and port mapper: just enough of ONC RPC (RFC 5531, RFC 1833) and VXI-11 for liblxi and other
// clients.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "rig/bench/simulation/rack.h"
#include "rig/bench/virtual_time.h"

namespace waverig::rig::bench {

inline constexpr std::uint32_t kPortMapperProgram = 100000, kVxi11CoreProgram = 0x0607AF;

// Answers one RPC call message (without record mark) to the port mapper; empty: not one.
std::string port_mapper_reply(std::string_view call, int vxi11_port);

// One connection to the VXI-11 core channel.
class Vxi11Side {
 public:
  // time: the client blocks in its call, so virtual time may go on to the moment of the answer.
  Vxi11Side(Rack& rack, VirtualTime* time) : rack_(rack), time_(time) {}
  // Takes bytes of the record stream; appends replies, each at its time. False: not RPC, hang up.
  bool receive(std::string_view bytes, std::int64_t now_utime, std::vector<Answer>& out);

 private:
  struct Link {
    std::size_t device = 0;
    std::string input;            // a command still without its end
    std::vector<Answer> answers;  // not yet read
  };
  Answer reply(std::string_view call, std::int64_t now_utime);

  Rack& rack_;
  VirtualTime* time_;
  std::string stream_, record_;
  std::map<std::uint32_t, Link> links_;
  std::uint32_t next_link_ = 1;
};

// A record mark and the message.
std::string marked(const std::string& message);

}  // namespace waverig::rig::bench
