// waverig node estimator: one method on the bus, record after record.
#include <fmt/format.h>

#include <cstdio>

#include "rig/cli/nodes/addresses.h"
#include "rig/cli/nodes/chosen_run.h"
#include "rig/cli/nodes/nodes.h"
#include "rig/cli/nodes/process.h"
#include "rig/nodes/estimator_node.h"

namespace waverig::cli {
namespace {

constexpr int kTick_ms = 50;

estimator::MethodSettings method_settings(const EstimatorArguments& arguments) {
  if (!arguments.campaign.empty())
    return unit_on_the_rig(rig::read_campaign(arguments.campaign).settings, arguments.calibration).methods;
  if (arguments.calibration.empty()) return {};
  estimator::MethodSettings settings = unit_on_the_rig({}, arguments.calibration).methods;
  settings.sensor.gravity_mps2 = estimator::load_calibration(arguments.calibration).gravity_mps2;
  return settings;
}

}  // namespace

int run_estimator(const EstimatorArguments& arguments) {
  estimator::MethodSettings settings = method_settings(arguments);
  settings.fixed_lag_s = arguments.lag_s;
  Requests requests;
  Bus bus = open_bus(arguments.bus);
  const rig::EstimatorNode node(bus, arguments.method, settings);
  if (arguments.calibration.empty())
    fmt::print(stderr, "estimator {}: no --calibration: uncertainties are a default sensor's\n",
               arguments.method);
  fmt::print(stderr, "estimator {}: ready\n", arguments.method);

  std::int64_t reported = 0;
  bool told = false;
  while (requests.next() != Request::kStop && !(arguments.one_record && node.records() > 0)) {
    bus.handle(kTick_ms);
    if (reported == 0 && node.samples_missing() > 0)
      fmt::print(stderr, "estimator {}: samples are missing, what follows them is flagged\n",
                 arguments.method);
    reported = node.samples_missing();
    if (!told && node.watch().left_out() > 0)
      fmt::print(stderr, "estimator {}: samples are left out; the reasons follow at the end\n",
                 arguments.method);
    told = node.watch().left_out() > 0;
  }
  fmt::print(stderr, "estimator {}: {} records, {} samples, {} missing{}\n", arguments.method, node.records(),
             node.samples(), node.samples_missing(), node.recording() ? "; stopped inside a record" : "");
  if (const std::string words = node.watch().words(); !words.empty())
    fmt::print(stderr, "estimator {}: {}\n", arguments.method, words);
  return 0;
}

}  // namespace waverig::cli
