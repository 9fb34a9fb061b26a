// Calm: of noise alone nothing comes up; of a swell that comes up softly the onset is found.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "estimator/heave/calm.h"
#include "estimator/heave/disturbance.h"
#include "estimator/heave/heave_steps.h"
#include "estimator/heave/sea_identifier.h"
#include "motion/kinematics/random.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::Calm;
using estimator::HeaveStep;
using estimator::kFineInterval_s;

struct Seen {
  int nodes = 0, drifted = 0;  // after the first fifteen seconds
  double found_s = NAN, onset_s = NAN;  // when a slow sea was first likelier, and since when
};

// A level sensor of a calm's noise that feels the given vertical acceleration.
Seen watch(double lasts_s, std::uint64_t seed, const std::function<double(double)>& a_mps2) {
  constexpr double kRate_Hz = 100;
  const estimator::SensorKnowledge sensor;
  estimator::SeaIdentifierSettings settings;
  settings.accel_noise_m2ps3 = estimator::accel_noise_m2ps3(sensor);
  settings.offset_sigma_mps2 = estimator::offset_sigma_mps2(sensor);
  estimator::SeaIdentifier identifier(settings);
  estimator::HeaveFilter filter(identifier.model(), settings.offset_sigma_mps2, 0);
  estimator::HeaveSteps path(sensor);
  RandomStream noise(seed, "noise");
  const double sigma_mps2 = std::sqrt(settings.accel_noise_m2ps3 * kRate_Hz), bias_mps2 = noise.gaussian(0.01);
  Calm calm;
  Seen seen;
  std::vector<HeaveStep> steps;
  for (int i = 0; i < static_cast<int>(lasts_s * kRate_Hz); ++i) {
    estimator::ImuSample sample;
    estimator::AttitudeSample level;
    const double t_s = i / kRate_Hz;
    sample.utime = std::llround(t_s / kMicrosecond);
    level.a_N.z() = -(a_mps2(t_s) + bias_mps2 + noise.gaussian(sigma_mps2));
    if (i == 0)
      path.start(sample, level);
    else
      path.add(sample, level, 1 / kRate_Hz, steps);
    for (const HeaveStep& step : steps) {
      calm.add(filter, step);
      filter.step(step);
      if (identifier.add(filter.without_leaks(step.increment)) && t_s < 20) filter.set_model(identifier.identify());
      if (!calm.is_long()) continue;
      ++seen.nodes;
      seen.drifted += calm.drifts_away(filter);
      if (seen.nodes % 4 != 0) continue;
      const Calm::Since* onset = calm.onset(identifier.slow_sea(), 0, filter.log_likelihood());
      if (!onset || std::isfinite(seen.found_s)) continue;
      seen.found_s = t_s;
      seen.onset_s = static_cast<double>(onset->at) * kFineInterval_s;
    }
    steps.clear();
  }
  return seen;
}

TEST(Calm, OfNoiseNothingComesUp) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Seen seen = watch(60, seed, [](double) { return 0.0; });
    EXPECT_GT(seen.nodes, 150);
    EXPECT_EQ(seen.drifted, 0) << seed;
    EXPECT_TRUE(std::isnan(seen.found_s)) << seed << ": " << seen.found_s;
  }
}

TEST(Calm, FindsTheOnsetOfASwellThatHidAtFirst) {
  constexpr double kBegins_s = 30, kAmplitude_m = 0.5;
  for (const double period_s : {8.0, 12.0, 16.0})
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const double omega = 2 * kPi / period_s;
      const Seen seen = watch(60, seed, [&](double t_s) {
        const Ramp r = ramp(t_s, kBegins_s, 2 * period_s);
        const double phase = omega * t_s + static_cast<double>(seed);
        return kAmplitude_m * ((r.ddw - omega * omega * r.w) * std::sin(phase) + 2 * omega * r.dw * std::cos(phase));
      });
      EXPECT_GT(seen.onset_s, kBegins_s - 1) << period_s << " s, " << seed;
      EXPECT_LT(seen.onset_s, seen.found_s) << period_s << " s, " << seed;
      EXPECT_LT(seen.found_s, kBegins_s + 1.2 * period_s) << period_s << " s, " << seed;
      EXPECT_GT(seen.drifted, 0) << period_s << " s, " << seed;
    }
}

}  // namespace
}  // namespace waverig::testing
