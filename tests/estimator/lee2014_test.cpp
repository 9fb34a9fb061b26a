// Lee, Lee, Heo 2014: the published method.
#include "estimator/waves/lee2014.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lcmtypes/flags.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/synthetic_waves.h"

namespace waverig::estimator {
namespace {

using testing::Collector;
using testing::SensorErrors;
using testing::SyntheticRecord;
using testing::SyntheticWaves;

SensorErrors no_errors() {
  SensorErrors e;
  e.accel_noise_mps2_rthz = e.gyro_noise_radps_rthz = 1e-9;  // a reading that never changes is a flat line
  return e;
}

SyntheticWaves waves_of(double period_s, double height_m) {
  SyntheticWaves w;
  w.period_s = period_s;
  w.height_m = height_m;
  w.rest_s = 5;
  w.ramp_waves = 3;
  w.duration_s = 180;
  w.mounting = {};
  return w;
}

double mean_height(const Collector& found, const SyntheticRecord& record) {
  double sum = 0, n = 0;
  for (const Wave& wave : found.waves) {
    const double t_s = static_cast<double>(wave.start_utime - record.samples.front().utime) * kMicrosecond;
    if (t_s < record.steady_from_s + 2 * wave.period_s) continue;
    sum += wave.height_m;
    n += 1;
  }
  return sum / n;
}

TEST(Lee2014, FindsEveryWaveAndItsHeightWithAPerfectSensor) {
  for (const double period_s : {6.0, 12.0}) {
    const SyntheticRecord record = testing::synthesize(waves_of(period_s, 1), no_errors(), 1);
    Lee2014 method{MethodSettings{}};
    const Collector found = testing::run(method, record.samples);
    EXPECT_NEAR(mean_height(found, record), 1, 0.02) << period_s;
    EXPECT_NEAR(static_cast<double>(found.waves.size()), 180 / period_s - 2, 2) << period_s;
    for (std::size_t k = 6; k < found.waves.size(); ++k) {
      EXPECT_NEAR(found.waves[k].period_s, period_s, 0.02 * period_s);
    }
  }
}

TEST(Lee2014, GivesOneHeaveASampleInOrderOfTimeWithItsTimeAndNumber) {
  SyntheticWaves waves = waves_of(6, 1);
  waves.duration_s = 20;
  const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 1);
  std::vector<ImuSample> samples = record.samples;
  samples.insert(samples.begin() + 700, samples[650]);  // a straggler, which has no place in the order
  Lee2014 method{MethodSettings{}};
  const Collector found = testing::run(method, samples);
  ASSERT_EQ(found.heaves.size(), record.samples.size());
  for (std::size_t i = 0; i < found.heaves.size(); ++i) {
    EXPECT_EQ(found.heaves[i].utime, record.samples[i].utime);
    EXPECT_EQ(found.heaves[i].seq, record.samples[i].seq);
  }
}

TEST(Lee2014, FindsItsWavesAgainAtOnceAfterAGapHoweverLong) {
  const SyntheticRecord record = testing::synthesize(waves_of(6, 1), SensorErrors{}, 1);
  for (const std::int64_t gap_s : {5, 60, 86'400}) {
    for (const std::size_t from : {std::size_t{1}, std::size_t{6000}}) {
      std::vector<ImuSample> samples = record.samples;
      for (std::size_t i = from; i < samples.size(); ++i) samples[i].utime += gap_s * 1'000'000;
      Lee2014 method{MethodSettings{}};
      const Collector found = testing::run(method, samples);
      EXPECT_LT(std::abs(found.heaves.back().heave_m), 300) << gap_s;  // a few milli-g of tilt for minutes
      int after = 0;
      for (const Wave& wave : found.waves) {
        EXPECT_TRUE(wave.start_utime > samples[from].utime ||
                    wave.start_utime + std::llround(wave.period_s * 1e6) < samples[from].utime);
        if (from < 2 || wave.start_utime < samples[from].utime) continue;
        if (after++ == 0) {
          EXPECT_LT(wave.start_utime, samples[from].utime + 12'000'000) << gap_s;
        } else {
          EXPECT_NEAR(wave.height_m, 1, 0.05) << gap_s << " " << after;
        }
      }
      EXPECT_GE(after, from > 1 ? 17 : 0) << gap_s;
    }
  }
}

TEST(Lee2014, TraceOfEquation10RunsAwayWithHalfTheBiasTimesTimeSquared) {
  const double bias = 0.02;
  Lee2014 method{MethodSettings{}};
  RandomStream tiny(1, "tiny");  // a reading that never changes would be a flat line
  Collector found;
  for (int i = 0; i <= 6000; ++i) {
    ImuSample s;
    s.utime = i * 10'000;
    s.seq = i;
    s.f_B = Vector3d(0, 0, -kStandardGravity - bias + 1e-7 * tiny.gaussian());
    method.add(s, found);
  }
  EXPECT_NEAR(found.heaves.back().heave_m, 0.5 * bias * 60 * 60, 0.01 * 36);
}

// The weakness to know: b t^2 / 2 is neither cosine, line nor offset and leaks into alpha in proportion to
// T^2.
TEST(Lee2014, BiasLeaksIntoTheHeightWithThePeriodSquared) {
  const auto leak = [](double period_s) {
    SensorErrors errors = no_errors();
    const SyntheticWaves waves = waves_of(period_s, 2);
    const SyntheticRecord clean = testing::synthesize(waves, errors, 1);
    errors.b_mps2 = Vector3d(0, 0, -0.004);
    const SyntheticRecord biased = testing::synthesize(waves, errors, 1);
    Lee2014 first{MethodSettings{}}, second{MethodSettings{}};
    return mean_height(testing::run(second, biased.samples), biased) -
           mean_height(testing::run(first, clean.samples), clean);
  };
  const double at_4 = leak(4), at_8 = leak(8);
  EXPECT_GT(std::abs(at_4), 1e-3);
  EXPECT_NEAR(at_8 / at_4, 4, 0.8);
}

// b t^2 / 2 over one period has b T^2 / (2 pi^2) in common with the cosine, and the line takes none of it.
TEST(Lee2014, FindsItsWavesUnderAnUncalibratedBiasAndReadsThemTooHighByTheClosedForm) {
  for (const double period_s : {6.0, 12.0}) {
    SensorErrors errors = no_errors();
    errors.b_mps2 = Vector3d(0, 0, -0.2);  // upwards: several times the wave's own acceleration
    const SyntheticRecord record = testing::synthesize(waves_of(period_s, 1), errors, 1);
    Lee2014 method{MethodSettings{}};
    const double expected_m = 1 + 0.2 * period_s * period_s / (testing::kPi * testing::kPi);
    EXPECT_NEAR(mean_height(testing::run(method, record.samples), record), expected_m, 0.02 * expected_m)
        << period_s;
  }
}

TEST(Lee2014, StatesTheHeightThatAnUnknownBiasMayAdd) {
  const double period_s = 8;
  int inside = 0;
  constexpr int kUnits = 40;
  for (int unit = 1; unit <= kUnits; ++unit) {
    MethodSettings settings;
    RandomStream random(static_cast<std::uint64_t>(unit), "unit");
    SensorErrors errors = no_errors();
    errors.b_mps2 = Vector3d(0, 0, random.gaussian(settings.sensor.accel_bias_sigma_mps2));
    errors.E(2, 2) = random.gaussian(settings.sensor.accel_scale_sigma);
    const SyntheticRecord record = testing::synthesize(waves_of(period_s, 1), errors, 1);
    Lee2014 method{settings};
    const Collector found = testing::run(method, record.samples);
    inside +=
        std::abs(mean_height(found, record) - 1) < 2 * found.waves.back().calibration_sigma_m + 0.01 ? 1 : 0;
    EXPECT_LT(found.waves.back().calibration_sigma_m, 0.05);
  }
  EXPECT_GE(inside, 35) << "of " << kUnits << ", k = 2";
}

TEST(Lee2014, TakesNoRestBetweenTwoRunsForAWave) {
  SyntheticRecord record = testing::synthesize(waves_of(6, 1), SensorErrors{}, 1);
  SyntheticWaves again = waves_of(6, 1);
  again.rest_s = 60;
  const std::int64_t end = record.samples.back().utime + 10'000;
  const SyntheticRecord second = testing::synthesize(again, SensorErrors{}, 2);
  for (ImuSample sample : second.samples) {
    sample.utime += end - second.samples.front().utime;
    record.samples.push_back(sample);
  }
  Lee2014 method{MethodSettings{}};
  const Collector found = testing::run(method, record.samples);
  EXPECT_GT(found.waves.size(), 50u);
  for (const Wave& wave : found.waves) EXPECT_LT(wave.period_s, 25.1);
}

TEST(Lee2014, AWaveCarriesWhatItsSamplesSuffered) {
  SyntheticRecord record = testing::synthesize(waves_of(6, 1), SensorErrors{}, 1);
  ImuSample& bad = record.samples[9000];
  bad.flags |= flag::kSaturation;
  const std::int64_t when = bad.utime;
  Lee2014 method{MethodSettings{}};
  int flagged = 0;
  for (const Wave& wave : testing::run(method, record.samples).waves) {
    const bool holds = wave.start_utime < when && when < wave.start_utime + std::llround(1e6 * wave.period_s);
    EXPECT_EQ((wave.flags & flag::kSaturation) != 0, holds) << wave.start_utime;
    flagged += holds;
  }
  EXPECT_EQ(flagged, 1);
}

// Of a scale that nobody knows, one to one: with the bias, which adds b T^2 / pi^2.
TEST(Lee2014, StatesTheHeightThatAnUnknownScaleMayAdd) {
  MethodSettings settings;
  settings.sensor.accel_bias_sigma_mps2 = 0;
  settings.sensor.accel_scale_sigma = 0;
  settings.sensor.accel_slope_sigma = 0.05;
  const SyntheticRecord record = testing::synthesize(waves_of(8, 1), no_errors(), 1);
  Lee2014 method{settings};
  const Wave wave = testing::run(method, record.samples).waves.back();
  EXPECT_NEAR(wave.calibration_sigma_m, 0.05 * wave.height_m, 1e-9);
}

}  // namespace
}  // namespace waverig::estimator
