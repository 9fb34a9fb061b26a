// waverig node motion: one run of the arm in real time, through a drive on Modbus. Every way out stops the
// drive; where the process itself is killed, the drive's own watchdog does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "lcmtypes/error.h"
#include "motion/modbus_drive.h"
#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/chosen_run.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"
#include "rig/nodes/motion_node.h"

namespace waverig::cli {
namespace {

motion::AxisSettings axis_settings(const rig::CampaignSettings& campaign, const MotionArguments& arguments) {
  motion::AxisSettings axis = campaign.axis;
  axis.max_cycle_gap_s = std::max(axis.control_period_s, 1e-3 * arguments.max_cycle_gap_ms);
  axis.max_following_error_rad = arguments.max_following_error_deg * kDegree;
  return axis;
}

// A hold where nothing runs is no reason to stop anything.
void follow(Request request, rig::MotionNode& node) {
  try {
    if (request == Request::kStop) node.stop();
    if (request == Request::kHold) node.hold();
    if (request == Request::kResume) node.resume();
  } catch (const UserError& refused) {
    fmt::print(stderr, "motion: {}\n", refused.what());
  }
}

}  // namespace

int run_motion(const MotionArguments& arguments) {
  const ChosenRun chosen = chosen_run(arguments.campaign, arguments.run);
  motion::ModbusLinkSettings link = drive_link(arguments.drive);
  link.response_timeout_s = 1e-3 * arguments.response_timeout_ms;
  link.byte_timeout_s = link.response_timeout_s / 2;
  Requests requests;
  Bus bus = open_bus(arguments.bus);
  motion::ModbusDrive drive(link);
  const RigClock clock(chosen.campaign.start_utime, arguments.speed);
  const motion::AxisSettings axis = axis_settings(chosen.campaign, arguments);
  const auto period_us = static_cast<std::int64_t>(std::lround(axis.control_period_s * 1e6));
  if (!become_real_time())
    fmt::print(stderr, "motion: no real-time scheduling for this user: a busy machine may miss a deadline\n");

  rig::MotionNode node(bus, drive, axis, rig::profile_of(chosen.campaign, chosen.plan),
                       rig::ordered_run(chosen.plan));
  if (arguments.tells_truth) node.tell_truth(rig::arm_placement(chosen.campaign, chosen.plan));
  bool told_to_stop = false;
  std::int64_t tick = clock.now();
  while (!(node.finished() && node.at_rest())) {
    for (Request request; (request = requests.next()) != Request::kNone;) {
      told_to_stop |= request == Request::kStop;
      follow(request, node);
    }
    node.cycle(clock.now());
    // A tick that has passed is left out, not made good: the drive goes on by itself for so long.
    tick = std::max(tick + period_us, clock.now());
    clock.sleep_until(tick);
  }
  if (!node.alarm().empty())
    throw NegativeAnswer(
        fmt::format("run {}: motion stopped by an alarm: {}", chosen.plan.name, node.alarm()));
  if (told_to_stop)
    throw NegativeAnswer(fmt::format("run {}: motion stopped before its end, as told", chosen.plan.name));
  fmt::print(stderr, "motion: {} done, largest following error {:.3f} deg\n", chosen.plan.name,
             node.status().peak_following_error_rad / kDegree);
  return 0;
}

}  // namespace waverig::cli
