// waverig node acquisition: frames from a serial line, counts and calibrated samples on the bus.
#include <fmt/format.h>

#include <array>
#include <cstdio>

#include "rig/acquisition/serial_port.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/chosen_run.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"
#include "rig/nodes/acquisition_node.h"

namespace waverig::cli {
namespace {

constexpr int kTick_ms = 5;  // the begin of a record is heard so late at the most

// Says so at the first frame that is lost or broken, and how many there were at the end.
void report_loss(const rig::FrameStatistics& statistics, std::int64_t& reported) {
  const std::int64_t bad = statistics.lost + statistics.broken;
  if (bad > 0 && reported == 0)
    fmt::print(stderr, "acquisition: {} frames lost, {} broken on the serial line\n", statistics.lost,
               statistics.broken);
  reported = bad;
}

}  // namespace

int run_acquisition(const AcquisitionArguments& arguments) {
  const rig::CampaignSettings campaign = rig::read_campaign(arguments.campaign).settings;
  const rig::CampaignUnit unit = unit_on_the_rig(campaign, arguments.calibration);
  Requests requests;
  Bus bus = open_bus(arguments.bus);
  rig::SerialPort port(arguments.serial, arguments.baud);
  rig::AcquisitionNode node(bus, rig::acquisition_of(unit));
  fmt::print(stderr, "acquisition: ready\n");

  std::array<std::uint8_t, 4096> buffer{};
  std::int64_t reported = 0;
  while (requests.next() != Request::kStop) {
    const auto bytes = port.read(buffer, kTick_ms);
    bus.drain();
    node.take(bytes);
    report_loss(node.statistics(), reported);
  }
  const rig::FrameStatistics& heard = node.statistics();
  fmt::print(stderr, "acquisition: {} frames, {} lost, {} broken\n", heard.frames, heard.lost, heard.broken);
  return 0;
}

}  // namespace waverig::cli
