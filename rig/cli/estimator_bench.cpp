#include "rig/cli/estimator_bench.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>

#include "estimator/evaluation/bound.h"
#include "estimator/evaluation/heave_comparison.h"
#include "estimator/evaluation/zero_crossing.h"
#include "lcmtypes/flags.h"
#include "motion/regular_wave.h"
#include "motion/sea_state.h"
#include "rig/campaign/sea_bound.h"

namespace waverig::cli {
namespace {

constexpr double kStep_s = 2e-3;  // of buoy and sensors
constexpr double kSettled_s = 300;
constexpr double kTilt_rad = 3 * kDegree;  // of a regular wave's platform
constexpr std::array kRelativeFrequencies = {0.7, 1.0, 1.3, 1.6, 2.0, 3.0, 4.0};  // of the peak's

using estimator::square;

// Motion by motion: both answer body motion at a time.
template <class Motion>
BenchRecord recorded(const BenchCase& settings, const rig::CampaignUnit& unit, Motion motion,
                     std::int64_t start_utime, std::uint64_t seed) {
  BenchRecord record{settings, {}, {}};
  rig::SimulatedUnit sensor(unit.settings, unit.tested, seed);
  rig::Acquisition acquisition = rig::acquisition_of(unit);
  std::vector<std::uint8_t> bytes;
  const auto step_us = std::llround(kStep_s / kMicrosecond);
  const auto steps = std::llround(settings.duration_s / kStep_s);
  const auto truth_every = std::llround(unit.settings.sample_interval_s / kStep_s);
  for (std::int64_t i = 0; i <= steps; ++i) {
    const BodyMotion body = motion.at(start_utime + i * step_us);
    sensor.step(body, i > 0 ? kStep_s : 0, bytes);
    if (i % truth_every == 0) record.truth.add(body.utime, heave_m(body), -body.velocity_N.z());
    if (bytes.empty()) continue;
    acquisition.add(bytes, [&](const rig::UnitCounts&, const estimator::ImuSample& sample) {
      record.samples.push_back(sample);
    });
    bytes.clear();
  }
  return record;
}

class Collector : public estimator::Output {
 public:
  void heave(const estimator::HeaveSample& h) override { heaves.push_back(h); }
  void wave(const estimator::Wave& w) override { waves.push_back(w); }
  void sea(const estimator::SeaState& s) override { seas.push_back(s); }
  std::vector<estimator::HeaveSample> heaves;
  std::vector<estimator::Wave> waves;
  std::vector<estimator::SeaState> seas;
};

struct Moments {
  double n = 0, z = 0, zz = 0, v = 0, vv = 0;
  void add(double heave_m, double rate_mps) {
    n += 1;
    z += heave_m;
    zz += heave_m * heave_m;
    v += rate_mps;
    vv += rate_mps * rate_mps;
  }
  double m0() const { return zz / n - square(z / n); }
  double m2() const { return vv / n - square(v / n); }
  double hm0_m() const { return 4 * std::sqrt(m0()); }
  double tm02_s() const { return 2 * std::numbers::pi * std::sqrt(m0() / m2()); }
};

double percent(double value, double of) { return 100 * (value / of - 1); }

motion::SeaSettings sea_of(const BenchCase& settings, std::uint64_t seed) {
  return {.shape = settings.motion == BenchMotion::kJonswap ? motion::SpectrumShape::kJonswap
                                                            : motion::SpectrumShape::kPiersonMoskowitz,
          .hm0_m = settings.height_m,
          .tp_s = settings.period_s,
          .spreading_s = 10,
          .random_amplitudes = true,
          .exact_hm0 = false,
          .seed = seed};
}

// Single waves: the method's own, else those of its heave, against the truth over the very same spans.
void judge_waves(const BenchRecord& record, const Collector& found, const rig::CampaignUnit& unit,
                 BenchFigures& figures) {
  double n = 0, sum = 0, squares = 0, truth = 0;
  for (const estimator::Wave& wave : found.waves) {
    if (wave.flags & (flag::kIncomplete | flag::kSettling)) continue;
    const double true_height_m = record.truth.height_m(
        wave.start_utime, wave.start_utime + std::llround(wave.period_s / kMicrosecond));
    if (!std::isfinite(true_height_m) || !std::isfinite(wave.height_m)) continue;
    n += 1;
    sum += wave.height_m;
    squares += square(wave.height_m - true_height_m);
    truth += true_height_m;
  }
  if (n < 2) return;
  figures.mean_height_error = percent(sum, truth);
  if (record.settings.motion != BenchMotion::kRegular) return;
  const double std_m = std::sqrt(std::max(0.0, squares / n - square((sum - truth) / n)));
  figures.std_over_bound =
      std_m /
      evaluation::height_bound_m({.period_s = record.settings.period_s,
                                  .noise_density_mps2_rthz = unit.settings.accelerometer.noise_density_mps2,
                                  .sample_rate_hz = 1 / unit.settings.sample_interval_s});
}

void judge_heave(const BenchRecord& record, const Collector& found, BenchFigures& figures) {
  evaluation::HeaveComparison whole, settled;
  Moments estimate, truth;
  std::vector<double> heave_m, true_heave_m;
  const std::int64_t settled_utime = record.samples.front().utime + std::llround(kSettled_s / kMicrosecond);
  for (const estimator::HeaveSample& h : found.heaves) {
    const auto point = record.truth.at(h.utime);
    if (!std::isfinite(point.heave_m) || !std::isfinite(h.heave_m)) continue;
    whole.add(h.heave_m, point.heave_m, point.heave_rate_mps);
    estimate.add(h.heave_m, h.heave_rate_mps);
    truth.add(point.heave_m, point.heave_rate_mps);
    if (h.utime < settled_utime) continue;
    settled.add(h.heave_m, point.heave_m, point.heave_rate_mps);
    heave_m.push_back(h.heave_m);
    true_heave_m.push_back(point.heave_m);
  }
  if (truth.n < 2) return;
  figures.rms = 100 * whole.rmse_m() / truth.hm0_m();
  figures.settled_rms = 100 * settled.rmse_m() / truth.hm0_m();
  figures.gain = settled.gain();
  figures.lag_s = settled.lag_s();
  const bool told = !found.seas.empty() && std::isfinite(found.seas.front().hm0_m);
  figures.hm0_error = percent(told ? found.seas.front().hm0_m : estimate.hm0_m(), truth.hm0_m());
  figures.tm02_error = percent(told ? found.seas.front().tm02_s : estimate.tm02_s(), truth.tm02_s());
  std::vector<double> frequencies_hz;
  for (const double relative : kRelativeFrequencies)
    frequencies_hz.push_back(relative / record.settings.period_s);
  if (record.settings.motion == BenchMotion::kRegular) frequencies_hz = {1 / record.settings.period_s};
  const double rate_hz =
      static_cast<double>(record.samples.size() - 1) /
      (static_cast<double>(record.samples.back().utime - record.samples.front().utime) * kMicrosecond);
  figures.transfer = evaluation::transfer(heave_m, true_heave_m, rate_hz, frequencies_hz);
}

}  // namespace

BenchRecord bench_record(const BenchCase& settings, const rig::CampaignUnit& unit, std::uint64_t seed) {
  const std::int64_t start_utime = unit.settings.power_up_utime + std::llround(3600 / kMicrosecond);
  RandomStream draw(seed, "bench");
  const double phase_rad = 2 * std::numbers::pi * draw.uniform(),
               heading_rad = 2 * std::numbers::pi * draw.uniform();
  if (settings.motion == BenchMotion::kRegular)
    return recorded(settings, unit,
                    motion::RegularWave({.period_s = settings.period_s,
                                         .height_m = settings.height_m,
                                         .tilt_rad = kTilt_rad,
                                         .heading_rad = heading_rad,
                                         .phase_rad = phase_rad,
                                         .start_utime = start_utime}),
                    start_utime, seed);
  const motion::FloatSettings buoy{.heading_rad = heading_rad, .start_utime = start_utime, .seed = seed};
  return recorded(settings, unit, motion::SeaMotion(motion::draw_components(sea_of(settings, seed)), buoy),
                  start_utime, seed);
}

std::optional<evaluation::HeaveBound> bound_of(const BenchCase& settings, const rig::CampaignUnit& unit) {
  if (settings.motion == BenchMotion::kRegular) return std::nullopt;  // a line is no spectrum
  return rig::sea_bound(sea_of(settings, 0), unit.settings.accelerometer);
}

BenchLimits limits(const BenchCase& settings, const BenchMethod& method,
                   const evaluation::HeaveBound& bound) {
  const double lag_s = rig::heave_lag_s(method.name, method.fixed_lag_s);
  const double percent_m = settings.height_m / 100;
  return {bound.record_m(lag_s, settings.duration_s) / percent_m,
          bound.record_m(lag_s, settings.duration_s, kSettled_s) / percent_m};
}

std::string BenchMethod::title() const {
  return fixed_lag_s > 0 ? fmt::format("{}, {:g} s late", name, fixed_lag_s) : name;
}

BenchFigures judge_method(const BenchMethod& chosen, const BenchRecord& record,
                          const rig::CampaignUnit& unit) {
  constexpr double kNo = estimator::kUnknown;
  BenchFigures figures{kNo, kNo, kNo, kNo, kNo, kNo, kNo, kNo, kNo, {}};
  estimator::MethodSettings settings = unit.methods;
  settings.fixed_lag_s = chosen.fixed_lag_s;
  const auto method = estimator::make_method(chosen.name, settings);
  Collector found;
  found.heaves.reserve(record.samples.size());
  const auto begin = std::chrono::steady_clock::now();
  for (const estimator::ImuSample& sample : record.samples) method->add(sample, found);
  method->finish(found);
  const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - begin;
  figures.us_a_sample = took.count() / static_cast<double>(record.samples.size());
  if (chosen.tells_heave) judge_heave(record, found, figures);
  judge_waves(record, found, unit, figures);
  return figures;
}

BenchFigures pooled(const std::vector<BenchFigures>& all) {
  BenchFigures result = all.front();
  const auto n = static_cast<double>(all.size());
  const auto mean = [&](double BenchFigures::*field) {
    double sum = 0;
    for (const BenchFigures& f : all) sum += f.*field;
    result.*field = sum / n;
  };
  const auto root_mean_square = [&](double BenchFigures::*field) {
    double sum = 0;
    for (const BenchFigures& f : all) sum += square(f.*field);
    result.*field = std::sqrt(sum / n);
  };
  for (auto field : {&BenchFigures::rms, &BenchFigures::settled_rms, &BenchFigures::std_over_bound})
    root_mean_square(field);
  for (auto field : {&BenchFigures::hm0_error, &BenchFigures::tm02_error, &BenchFigures::mean_height_error,
                     &BenchFigures::gain, &BenchFigures::lag_s, &BenchFigures::us_a_sample})
    mean(field);
  for (std::size_t i = 0; i < result.transfer.size(); ++i) {
    double gain = 0, lag = 0, error = 0;
    for (const BenchFigures& f : all) {
      gain += f.transfer[i].gain;
      lag += f.transfer[i].lag_s;
      error += square(f.transfer[i].error_ratio);
    }
    result.transfer[i].gain = gain / n;
    result.transfer[i].lag_s = lag / n;
    result.transfer[i].error_ratio = std::sqrt(error / n);
  }
  return result;
}

}  // namespace waverig::cli
