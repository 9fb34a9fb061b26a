// waverig node rig-sim: drive, mechanism, sensors and front end in real time. Outside it is what hardware is:
// a drive on Modbus TCP and a serial line with frames; the truth goes to the bus for the evaluator.
#include <fmt/format.h>

#include <cstdio>

#include "motion/modbus_drive_server.h"
#include "rig/campaign/sensor_unit.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/chosen_run.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"
#include "rig/cli/nodes/pseudo_terminal.h"

namespace waverig::cli {
namespace {

constexpr int kTick_ms = 2;

}  // namespace

int run_rig_sim(const RigSimArguments& arguments) {
  const ChosenRun chosen = chosen_run(arguments.campaign, arguments.run);
  const rig::CampaignSettings& campaign = chosen.campaign;
  Requests requests;
  Bus bus = open_bus(arguments.bus);
  const RigClock clock(campaign.start_utime, arguments.speed);
  const std::int64_t start_utime = clock.now();

  rig::CampaignUnit unit;
  unit.settings = rig::unit_settings(campaign);
  unit.settings.power_up_utime =
      start_utime - (chosen.plan.start_utime - campaign.start_utime);  // as warm as embedded
  unit.tested = rig::tested_unit(campaign);
  rig::SimulatedRigSettings settings = rig::rig_settings(campaign, unit, chosen.plan);
  settings.drive.watchdog_s = 1e-3 * arguments.watchdog_ms;
  rig::SimulatedRig rig(bus, settings, unit.tested, start_utime);
  PseudoTerminal line(arguments.serial_link);

  // The server asks for the time before each answer: the moment to bring the whole rig up to it, not the
  // drive alone.
  const auto catch_up = [&]() -> std::int64_t {
    line.send(rig.advance_to(clock.now()));
    return 0;
  };
  motion::ModbusDriveServer server(rig.drive(), {.port = arguments.port}, catch_up);
  become_real_time();
  fmt::print("drive tcp://127.0.0.1:{}\nserial {}\n", server.port(), line.path().string());
  std::fflush(stdout);
  while (requests.next() != Request::kStop) server.serve(kTick_ms);
  return 0;
}

}  // namespace waverig::cli
