// waverig node recorder: everything on the bus into an LCM event log.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "lcmtypes/error.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/listen.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"
#include "rig/nodes/recorder_node.h"

namespace waverig::cli {
namespace {

constexpr int kTick_ms = 50;
constexpr std::chrono::seconds kLongestRest{1};

void record(Bus& bus, Requests& requests, const rig::RunWatch& watch, const RecorderArguments& arguments) {
  if (arguments.one_record) {
    listen_to_record(bus, requests, watch, arguments.quiet_s);
  } else {
    while (requests.next() != Request::kStop) bus.handle(kTick_ms);
  }
  // What was sent before the end is in the log, even where LCM's own thread has yet to fetch it from the
  // socket: until nothing comes for a tick. A bus that never falls silent is left after a while.
  const auto until = std::chrono::steady_clock::now() + kLongestRest;
  while (std::chrono::steady_clock::now() < until && bus.handle(kTick_ms)) continue;
}

}  // namespace

int run_recorder(const RecorderArguments& arguments) {
  if (!arguments.replace && std::filesystem::exists(arguments.out))
    throw UserError(
        fmt::format("--out {}: is there already; expected a new file, or --replace", arguments.out));
  if (std::filesystem::exists(arguments.out) && !std::filesystem::is_regular_file(arguments.out))
    throw UserError(
        fmt::format("--out {}: is no file that another could replace; expected a new file", arguments.out));
  Requests requests;
  Bus bus = open_bus(arguments.bus);
  rig::RecorderNode node(bus, arguments.out);
  const rig::RunWatch watch(bus);
  fmt::print(stderr, "recorder: ready\n");
  record(bus, requests, watch, arguments);
  node.close();
  for (const auto& [channel, missing] : node.missing())
    fmt::print(stderr, "recorder: {}: {} messages are missing\n", channel, missing);
  fmt::print(stderr, "recorder: {} events in {}\n", node.events(), arguments.out);
  return 0;
}

}  // namespace waverig::cli
