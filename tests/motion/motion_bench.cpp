// Speed of the motion part: one item is 10 ms of the axis, or one sample of a sea at 500 Hz.
#include <benchmark/benchmark.h>

#include "motion/axis_controller.h"
#include "motion/sea_state.h"
#include "motion/simulated_drive.h"

namespace waverig::motion {
namespace {

void ControllerAndDrive(benchmark::State& state) {
  SimulatedDrive drive;
  AxisController controller(drive, {});
  std::int64_t utime = 0;
  controller.enable();
  for (auto _ : state) {
    if (controller.cycle(utime).state == AxisState::kReady) controller.start(RotationProfile({}), utime);
    drive.advance(0.01);
    utime += 10000;
  }
  if (controller.status().alarm != Alarm::kNone) state.SkipWithError(controller.alarm_message().c_str());
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(ControllerAndDrive);

void SeaSample(benchmark::State& state) {
  SeaMotion sea(draw_components({.spreading_s = 10, .components = static_cast<int>(state.range(0))}), {});
  std::int64_t utime = 0;
  for (auto _ : state) benchmark::DoNotOptimize(sea.at(utime += 2000));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(SeaSample)->Arg(200)->Arg(400)->Arg(1000)->ArgName("components");

}  // namespace
}  // namespace waverig::motion

BENCHMARK_MAIN();
