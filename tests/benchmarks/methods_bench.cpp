// What a sample costs each method, on one minute to twenty of the same sea, beside the cheapest thing that could be
// done with it: one integration of the attitude and one of the vertical acceleration. All in one run.
#include <benchmark/benchmark.h>

#include <string>

#include "estimator/method.h"
#include "motion/kinematics/random.h"
#include "motion/sea_state.h"

namespace {
using namespace waverig;

constexpr double kRate_Hz = 100;

const std::vector<estimator::ImuSample>& samples() {
  static const std::vector<estimator::ImuSample> all = [] {
    motion::SeaMotion buoy(motion::draw_components({.hm0_m = 1.5, .tp_s = 8}), {});
    RandomStream noise(1, "benchmark");
    const auto white = [&](double sigma) { return Vector3d(noise.gaussian(sigma), noise.gaussian(sigma), noise.gaussian(sigma)); };
    std::vector<estimator::ImuSample> made(120'000);
    for (std::size_t i = 0; i < made.size(); ++i) {
      const auto utime = static_cast<std::int64_t>(1'000'000 + i * 10'000);
      const BodyMotion m = buoy.at(utime);
      made[i].utime = utime;
      made[i].seq = static_cast<std::int64_t>(i);
      made[i].f_B = specific_force_B(m, {0, 0, kStandardGravity}) + white(0.024);
      made[i].w_NB_B = m.w_NB_B + white(3e-3);
    }
    return made;
  }();
  return all;
}

struct Sink : estimator::Output {
  double sum = 0;
  void heave(const estimator::HeaveSample& h) override { sum += h.heave_m; }
};

void PlainIntegration(benchmark::State& state) {
  double sum = 0;
  for (auto _ : state) {
    Quaterniond q_NB = Quaterniond::Identity();
    double speed_mps = 0, heave_m = 0;
    for (const auto& s : samples()) {
      q_NB = q_NB * quaternion_exp(s.w_NB_B / kRate_Hz);
      speed_mps += -((q_NB * s.f_B).z() + kStandardGravity) / kRate_Hz;
      heave_m += speed_mps / kRate_Hz;
      sum += heave_m;
    }
  }
  benchmark::DoNotOptimize(sum);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(samples().size()));
}
BENCHMARK(PlainIntegration)->Unit(benchmark::kMillisecond);

// a_sample shows whether the cost is linear: it is to be alike for all lengths.
void MethodOn(benchmark::State& state, const std::string& name) {
  const auto count = static_cast<std::size_t>(state.range(0) * static_cast<std::int64_t>(kRate_Hz));
  Sink sink;
  for (auto _ : state) {
    const auto method = estimator::make_method(name, {});
    for (std::size_t i = 0; i < count; ++i) method->add(samples()[i], sink);
    method->finish(sink);
  }
  benchmark::DoNotOptimize(sink.sum);
  const auto handled = static_cast<double>(state.iterations()) * static_cast<double>(count);
  state.counters["a_sample"] =
      benchmark::Counter(handled, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

const bool kRegistered = [] {
  for (const std::string& name : estimator::method_names())
    benchmark::RegisterBenchmark(("Method/" + name).c_str(), [name](benchmark::State& state) { MethodOn(state, name); })
        ->Arg(60)
        ->Arg(300)
        ->Arg(1200)
        ->ArgName("seconds")
        ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
