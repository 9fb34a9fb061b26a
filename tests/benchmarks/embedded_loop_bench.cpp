// The embedded loop, simulator to evaluator with the LCM codec in the path, against the bare rate at which LCM's
// memq:// publishes and handles one 96-byte message: both in one run, so that a slow machine slows both.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <lcm/lcm-cpp.hpp>

#include "rig/campaign/sweep.h"

namespace {
using namespace waverig;

// Bare LCM, no Bus: publish one message, handle it.
void BareMemqPublishAndHandle(benchmark::State& state) {
  lcm::LCM lcm("memq://");
  struct Sink {
    std::int64_t bytes = 0;
    void take(const lcm::ReceiveBuffer* buffer, const std::string&) { bytes += buffer->data_size; }
  } sink;
  lcm.subscribe("CHANNEL", &Sink::take, &sink);
  const char payload[96] = {};
  for (auto _ : state) {
    lcm.publish("CHANNEL", payload, sizeof payload);
    lcm.handle();
  }
  benchmark::DoNotOptimize(sink.bytes);
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(BareMemqPublishAndHandle);

void EmbeddedLoop(benchmark::State& state) {
  const bool recorded = state.range(0) != 0;
  const rig::Campaign campaign = rig::read_campaign(std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig/default.toml");
  const rig::CalibratedUnit calibrated = rig::calibrate(campaign.settings);
  const rig::RunPlan run = rig::plan_campaign(campaign.settings).runs.front();
  const std::filesystem::path log = std::filesystem::temp_directory_path() / "waverig_benchmark.lcm";
  double simulated_s = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(run_embedded(campaign.settings, calibrated.unit, run, recorded ? log : std::filesystem::path{}));
    simulated_s += run.duration_s;
  }
  std::filesystem::remove(log);
  state.counters["x_real_time"] = benchmark::Counter(simulated_s, benchmark::Counter::kIsRate);
  state.counters["samples"] = benchmark::Counter(simulated_s * 100, benchmark::Counter::kIsRate);
}
BENCHMARK(EmbeddedLoop)->Arg(0)->Arg(1)->ArgName("recorded")->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
