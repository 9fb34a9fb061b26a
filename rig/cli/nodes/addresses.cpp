#include "rig/cli/nodes/addresses.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <regex>

#include "lcmtypes/error.h"

namespace waverig::cli {
namespace {

[[noreturn]] void refuse_bus(const std::string& url, const std::string& why) {
  throw UserError(
      fmt::format("--bus {}: {}; expected udpm://GROUP:PORT?ttl=N&recv_buf_size=BYTES, such as \"{}\"", url,
                  why, kDefaultBus));
}

// -1 where the text is no number up to largest.
long number(const std::string& text, long largest) {
  if (text.empty() || text.size() > 10 || text.find_first_not_of("0123456789") != std::string::npos)
    return -1;
  const long value = std::stol(text);
  return value <= largest ? value : -1;
}

// LCM only prints a warning at an argument that it does not know.
void check_arguments(const std::string& url, const std::string& arguments) {
  static const std::regex kArgument("([^=&]*)=([^&]*)(&|$)");
  for (std::size_t at = 0; at < arguments.size();) {
    std::smatch match;
    const std::string rest = arguments.substr(at);
    if (!std::regex_search(rest, match, kArgument, std::regex_constants::match_continuous))
      refuse_bus(url, fmt::format("\"{}\" is no argument", rest));
    const bool good = match[1] == "ttl"             ? number(match[2], 255) >= 0
                      : match[1] == "recv_buf_size" ? number(match[2], 1L << 30) > 0
                                                    : false;
    if (!good)
      refuse_bus(url, fmt::format("\"{}\" = \"{}\" is no argument of it", match[1].str(), match[2].str()));
    at += static_cast<std::size_t>(match.length());
  }
}

void check_route(const std::string& url, const sockaddr_in& group) {
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool reachable =
      probe >= 0 && ::connect(probe, reinterpret_cast<const sockaddr*>(&group), sizeof group) == 0;
  const int reason = errno;
  if (probe >= 0) ::close(probe);
  if (!reachable)
    throw UserError(
        fmt::format("--bus {}: no way to the group: {}; expected a multicast route on this machine, such as "
                    "\"ip link set lo up; ip route add 224.0.0.0/4 dev lo\" makes",
                    url, std::strerror(reason)));
}

}  // namespace

Bus open_bus(const std::string& url) {
  static const std::regex kForm(R"(udpm://([0-9.]+):([0-9]+)(\?(.*))?)");
  std::smatch match;
  if (url.starts_with("memq:")) refuse_bus(url, "memq stays inside one process");
  if (!std::regex_match(url, match, kForm)) refuse_bus(url, "no such address");
  const long port = number(match[2], 65535);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(static_cast<std::uint16_t>(port));
  if (port < 1) refuse_bus(url, fmt::format("\"{}\" is no port", match[2].str()));
  if (inet_pton(AF_INET, match[1].str().c_str(), &group.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(group.sin_addr.s_addr)))
    refuse_bus(url,
               fmt::format("\"{}\" is no multicast group (224.0.0.0 to 239.255.255.255)", match[1].str()));
  check_arguments(url, match[4]);
  check_route(url, group);
  return Bus(url);
}

motion::ModbusLinkSettings drive_link(const std::string& address) {
  static const std::regex kTcp(R"(tcp://([0-9.]+):([0-9]+))");
  std::smatch match;
  motion::ModbusLinkSettings link;
  if (address.starts_with("rtu:") && address.size() > 4) {
    link.device = address.substr(4);
    return link;
  }
  in_addr host{};
  const bool tcp =
      std::regex_match(address, match, kTcp) && inet_pton(AF_INET, match[1].str().c_str(), &host) == 1;
  const long port = tcp ? number(match[2], 65535) : -1;
  if (port < 1)
    throw UserError(
        fmt::format("--drive {}: no such address; expected tcp://ADDRESS:PORT, such as tcp://127.0.0.1:5020, "
                    "or rtu:DEVICE, such as rtu:/dev/ttyUSB0",
                    address));
  link.host = match[1];
  link.port = static_cast<int>(port);
  return link;
}

}  // namespace waverig::cli
