// Method "harmonic" against the physical limit of REFERENCE section 3 and the uncertainty it states.
#include "estimator/waves/harmonic.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <functional>

#include "lcmtypes/flags.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/synthetic_waves.h"

namespace waverig::estimator {
namespace {

using testing::Collector;
using testing::kPi;
using testing::SensorErrors;
using testing::Swing;
using testing::SyntheticRecord;
using testing::SyntheticWaves;

constexpr double kMilliG = 1e-3 * kStandardGravity;

// What a calibration leaves, as standard deviations.
struct Calibration {
  double bias_mps2 = 0, scale = 0, misalignment = 0;
};
constexpr Calibration kFresh{0.2 * kMilliG, 1e-4, 1e-4};
constexpr Calibration kAged{0.4 * kMilliG, 1e-3, 1e-3};

MethodSettings knowing(const Calibration& c) {
  MethodSettings settings;
  settings.sensor.accel_bias_sigma_mps2 = c.bias_mps2;
  settings.sensor.accel_scale_sigma = c.scale;
  settings.sensor.accel_misalignment_sigma_rad = c.misalignment;
  settings.sensor.gravity_sigma_mps2 = 1e-4;
  return settings;
}

SyntheticWaves waves_of(double period_s, double height_m, Swing swing) {
  SyntheticWaves w;
  w.period_s = period_s;
  w.height_m = height_m;
  w.swing = swing;
  w.rate_Hz = 50;
  return w;
}

// Mean over the waves, its error and its stated standard uncertainty.
struct Mean {
  double height_m = 0, sigma_m = 0, std_m = 0;
  int waves = 0;
};

Mean mean_of(const std::vector<Wave>& waves) {
  Mean mean;
  double sum = 0, squares = 0, noise = 0, calibration = 0, tilt = 0, frequency = 0;
  const double n = static_cast<double>(waves.size());
  for (const Wave& w : waves) {
    sum += w.height_m;
    noise += w.noise_sigma_m * w.noise_sigma_m;
    calibration += w.calibration_sigma_m;
    tilt += w.tilt_sigma_m;
    frequency += w.frequency_sigma_m;
  }
  mean.waves = static_cast<int>(waves.size());
  mean.height_m = sum / n;
  for (const Wave& w : waves) squares += std::pow(w.height_m - mean.height_m, 2);
  mean.std_m = std::sqrt(squares / (n - 1));
  mean.sigma_m = std::sqrt(noise + calibration * calibration + tilt * tilt + frequency * frequency) / n;
  return mean;
}

Collector measure(const SyntheticRecord& record, const MethodSettings& settings) {
  Harmonic method{settings};
  return testing::run(method, record.samples);
}

double bound_m(double period_s, double density) {
  const double w = 2 * kPi / period_s;
  return 2 / (w * w) * density / std::sqrt(period_s);
}

TEST(Harmonic, ScattersWithinAQuarterOfTheCramerRaoBoundAndStatesItsNoise) {
  for (const auto& [period_s, height_m] : {std::pair{2.0, 0.3}, {6.0, 0.6}, {12.0, 1.0}, {20.0, 3.0}}) {
    double variance = 0, stated = 0, n = 0;
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SyntheticWaves waves = waves_of(period_s, height_m, Swing::kPendulum);
      waves.duration_s = std::max(100.0, 14 * period_s);
      waves.phase_rad = 0.8 * static_cast<double>(seed);
      const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, seed);
      const Mean mean = mean_of(measure(record, knowing(kFresh)).waves);
      variance += mean.std_m * mean.std_m;
      for (const Wave& w : measure(record, knowing(kFresh)).waves) stated += w.noise_sigma_m, n += 1;
    }
    const double bound = bound_m(period_s, SensorErrors{}.accel_noise_mps2_rthz),
                 std_m = std::sqrt(variance / 8);
    EXPECT_LT(std_m, 1.25 * bound) << period_s;
    EXPECT_GT(std_m, 0.8 * bound) << period_s;
    EXPECT_NEAR(stated / n / std_m, 1, 0.15) << period_s;
  }
}

TEST(Harmonic, MeanHeightAfterAFreshCalibrationIsGoodToAPerMilleAboveTheNoise) {
  for (const auto& [period_s, height_m] :
       {std::pair{2.0, 0.3}, {4.0, 1.0}, {6.0, 0.6}, {6.0, 3.0}, {12.0, 1.0}, {20.0, 3.0}}) {
    for (const Swing swing : {Swing::kForced, Swing::kPendulum}) {
      RandomStream random(11, "fresh");
      SensorErrors errors =
          testing::random_errors(random, kFresh.bias_mps2, kFresh.scale, kFresh.misalignment, 0.2 * kDegree);
      SyntheticWaves waves = waves_of(period_s, height_m, swing);
      waves.duration_s = 300;
      const Mean mean = mean_of(measure(testing::synthesize(waves, errors, 3), knowing(kFresh)).waves);
      const double noise = bound_m(period_s, errors.accel_noise_mps2_rthz) / std::sqrt(mean.waves);
      EXPECT_LT(std::abs(mean.height_m - height_m), 1e-3 * height_m + 2.5 * noise)
          << period_s << " " << height_m;
      EXPECT_LT(std::abs(mean.height_m - height_m), (period_s < 16 ? 0.005 : 0.01) * height_m);
    }
  }
}

TEST(Harmonic, AgedCalibrationWithTheGondolaTiltingStaysWithinOneAndAHalfPercentAndItsUncertainty) {
  for (const auto& [period_s, height_m] : {std::pair{2.0, 0.3}, {6.0, 0.6}, {12.0, 1.0}, {20.0, 3.0}}) {
    for (const Swing swing : {Swing::kForced, Swing::kPendulum}) {
      for (std::uint64_t seed = 0; seed < 4; ++seed) {
        RandomStream random(seed, "aged");
        SensorErrors errors;  // every error at its full size, signs at random
        const auto sign = [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) errors.E(i, j) = 1e-3 * sign();
          errors.b_mps2(i) = 0.4 * kMilliG * sign();
          errors.gyro_bias_radps(i) = 0.2 * kDegree * sign();
        }
        SyntheticWaves waves = waves_of(period_s, height_m, swing);
        waves.duration_s = 300;
        waves.forced_phase_rad = random.uniform(0, 2 * kPi);
        waves.forced_azimuth_rad = random.uniform(0, 2 * kPi);
        const Mean mean = mean_of(measure(testing::synthesize(waves, errors, seed), knowing(kAged)).waves);
        EXPECT_LT(std::abs(mean.height_m - height_m), 0.015 * height_m) << period_s << " " << seed;
        EXPECT_LT(std::abs(mean.height_m - height_m), 2.5 * mean.sigma_m) << period_s << " " << seed;
      }
    }
  }
}

// 240 sensors: 93-97 % of the true heights inside mean +- 2 sigma, and sigma neither idle nor timid.
TEST(Harmonic, StatedUncertaintyCoversTheTruthAsOftenAsItSays) {
  constexpr int kSensors = 240;
  int inside = 0;
  double squares = 0;
  for (std::uint64_t seed = 0; seed < kSensors; ++seed) {
    RandomStream random(seed, "coverage");
    const double period_s = random.uniform(3, 10), height_m = random.uniform(0.3, 1.0);
    SyntheticWaves waves = waves_of(period_s, height_m, seed % 2 ? Swing::kForced : Swing::kPendulum);
    waves.duration_s = 90;
    waves.phase_rad = random.uniform(0, 2 * kPi);
    waves.forced_phase_rad = random.uniform(0, 2 * kPi);
    waves.forced_azimuth_rad = random.uniform(0, 2 * kPi);
    waves.mounting = {random.gaussian(0.1), random.gaussian(0.1), 0};
    const SensorErrors errors =
        testing::random_errors(random, kAged.bias_mps2, kAged.scale, kAged.misalignment, 0.2 * kDegree);
    const Mean mean = mean_of(measure(testing::synthesize(waves, errors, seed), knowing(kAged)).waves);
    const double z = (mean.height_m - height_m) / mean.sigma_m;
    inside += std::abs(z) <= 2;
    squares += z * z;
  }
  EXPECT_GE(inside, kSensors * 93 / 100);
  EXPECT_LE(inside, kSensors * 97 / 100 + 1);
  EXPECT_NEAR(std::sqrt(squares / kSensors), 1, 0.12);
}

// The true crest-to-trough height of each wave's own span.
double worst_error(const SyntheticRecord& record, const Collector& found, double period_s) {
  double worst = 0;
  for (const Wave& wave : found.waves) {
    const auto index = [&](double t_s) {
      return std::min(record.samples.size(),
                      static_cast<std::size_t>(std::lround(
                          std::max(0.0, static_cast<double>(wave.start_utime - record.samples.front().utime) *
                                                kMicrosecond +
                                            t_s) *
                          50)));
    };
    const auto [low, high] =
        std::minmax_element(record.heave_m.begin() + static_cast<std::ptrdiff_t>(index(0)),
                            record.heave_m.begin() + static_cast<std::ptrdiff_t>(index(period_s)));
    worst = std::max(worst, std::abs(wave.height_m - (*high - *low)));
  }
  return worst;
}

TEST(Harmonic, FollowsAModulatedAmplitudeWaveByWave) {
  SyntheticWaves waves = waves_of(6, 1, Swing::kPendulum);
  waves.modulation = 0.2;
  waves.modulation_period_s = 80;
  const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 1);
  const Collector found = measure(record, knowing(kFresh));
  EXPECT_GE(found.waves.size(), 47U);
  EXPECT_LT(worst_error(record, found, 6), 0.015);
}

TEST(Harmonic, FollowsASlowlyChangingPeriod) {
  SyntheticWaves waves = waves_of(8, 1, Swing::kPendulum);
  waves.chirp_ps = 5e-4;  // 15 % over the record
  const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 1);
  const Collector found = measure(record, knowing(kFresh));
  ASSERT_GE(found.waves.size(), 37U);
  EXPECT_LT(worst_error(record, found, 8), 0.02);
  const Wave& late = found.waves[found.waves.size() - 6];
  const double t_s = static_cast<double>(late.start_utime - record.samples.front().utime) * kMicrosecond + 4;
  EXPECT_NEAR(late.period_s, 8 / (1 + waves.chirp_ps * t_s), 0.01);
}

TEST(Harmonic, SaysNothingAtRestAndFlagsTheWavesOfTheRamp) {
  SyntheticWaves waves = waves_of(6, 1, Swing::kPendulum);
  waves.rest_s = 60;
  waves.ramp_waves = 4;
  waves.duration_s = 120;
  const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 1);
  const Collector found = measure(record, knowing(kFresh));
  int steady = 0;
  for (const Wave& wave : found.waves) {
    const double t_s = static_cast<double>(wave.start_utime - record.samples.front().utime) * kMicrosecond;
    EXPECT_GT(t_s + wave.period_s, 60);
    if (t_s < record.steady_from_s - 6) {
      EXPECT_TRUE(wave.flags & flag::kSettling) << t_s;
    } else if (t_s > record.steady_from_s) {
      EXPECT_EQ(wave.flags, 0) << t_s;
      EXPECT_NEAR(wave.height_m, 1, 0.015) << t_s;
      ++steady;
    }
  }
  EXPECT_GE(steady, 15);
  for (const HeaveSample& heave : found.heaves) {
    if (heave.utime < record.samples.front().utime + 50'000'000) {
      EXPECT_TRUE(std::isnan(heave.heave_m));
      EXPECT_TRUE(heave.flags & flag::kSettling);
    }
  }
}

TEST(Harmonic, BadSamplesCostNothingButTheirFlags) {
  SyntheticWaves waves = waves_of(6, 1, Swing::kPendulum);
  waves.duration_s = 200;
  SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 1);
  std::vector<ImuSample> samples;
  for (ImuSample s : record.samples) {
    if (s.seq % 1000 > 990) continue;                // gaps
    if (s.seq % 997 == 0) s.f_B.z() += 25;           // spikes
    if (s.seq % 1009 == 0) s.w_NB_B.x() = kUnknown;  // not a number
    samples.push_back(s);
    if (s.seq % 503 == 0) samples.push_back(s);                                         // repeats
    if (s.seq % 701 == 0 && s.seq > 9) samples.push_back(samples[samples.size() - 6]);  // stragglers
  }
  const Collector found = measure({samples, record.heave_m, record.q_NB, 0}, knowing(kFresh));
  std::vector<std::int64_t> in_order;  // neither repeats nor stragglers
  std::int64_t newest_utime = -1;
  for (const ImuSample& s : samples) {
    if (s.utime <= newest_utime) continue;
    newest_utime = s.utime;
    in_order.push_back(s.seq);
  }
  ASSERT_LT(in_order.size(), samples.size());
  ASSERT_EQ(found.heaves.size(), in_order.size());
  for (std::size_t i = 0; i < in_order.size(); ++i) ASSERT_EQ(found.heaves[i].seq, in_order[i]);
  ASSERT_GE(found.waves.size(), 31U);
  std::int32_t flags = 0;
  for (const Wave& wave : found.waves) {
    EXPECT_NEAR(wave.height_m, 1, 0.015);
    flags |= wave.flags;
  }
  EXPECT_EQ(flags & (flag::kGap | flag::kSpike | flag::kRange), flag::kGap | flag::kSpike | flag::kRange);
}

// Waves of 6 s and 1 m whose samples from one on come late.
std::vector<ImuSample> with_gap(std::size_t from, std::int64_t gap_us) {
  std::vector<ImuSample> samples =
      testing::synthesize(waves_of(6, 1, Swing::kPendulum), SensorErrors{}, 1).samples;
  for (std::size_t i = from; i < samples.size(); ++i) samples[i].utime += gap_us;
  return samples;
}

TEST(Harmonic, BeginsWithTheFirstUsableSample) {
  SyntheticRecord record = testing::synthesize(waves_of(6, 1, Swing::kPendulum), SensorErrors{}, 1);
  constexpr std::size_t kBad = 6000;
  for (std::size_t i = 0; i < kBad; ++i) record.samples[i].f_B.setConstant(kUnknown);
  record.samples.front().utime -= 3'600'000'000'000;  // nor is its time of any use
  const Collector found = measure(record, knowing(kFresh));
  ASSERT_EQ(found.heaves.size(), record.samples.size());
  for (std::size_t i = 0; i < kBad; ++i) ASSERT_TRUE(std::isnan(found.heaves[i].heave_m));
  EXPECT_GE(found.waves.size(), 28U);
  for (const Wave& wave : found.waves) {
    EXPECT_GT(wave.start_utime, record.samples[kBad].utime);
    EXPECT_NEAR(wave.height_m, 1, 0.015);
  }
}

TEST(Harmonic, AGapCostsNothingHoweverLong) {
  for (const std::int64_t gap_s : {60LL, 86'400LL, 1'700'000'000LL}) {  // the last: a clock that is set
    const std::vector<ImuSample> samples = with_gap(7500, gap_s * 1'000'000);
    const Collector found = measure({samples, {}, {}, 0}, knowing(kFresh));
    ASSERT_EQ(found.heaves.size(), samples.size()) << gap_s;
    EXPECT_GE(found.waves.size(), 46U) << gap_s;
    for (const Wave& wave : found.waves) {
      EXPECT_NEAR(wave.height_m, 1, 0.015) << gap_s;
      EXPECT_FALSE(wave.start_utime < samples[7499].utime &&
                   wave.start_utime + std::llround(wave.period_s * 1e6) > samples[7500].utime);
    }
  }
}

TEST(Harmonic, HoldsNoSamplesBackForASensorThatIsStuck) {
  const std::vector<ImuSample> good =
      testing::synthesize(waves_of(6, 1, Swing::kPendulum), SensorErrors{}, 1).samples;
  const auto stuck = [](ImuSample& s) { s.f_B = Vector3d(0, 0, -9.8); };
  const auto no_number = [](ImuSample& s) { s.f_B.setConstant(kUnknown); };
  const auto saturated = [](ImuSample& s) { s.f_B.z() -= 40; };
  for (const std::function<void(ImuSample&)>& fail :
       {std::function<void(ImuSample&)>(stuck), {no_number}, {saturated}}) {
    HarmonicSettings own;
    own.guard.accel_limit_mps2 = 39;
    Harmonic method{knowing(kFresh), own};
    Collector found;
    std::size_t most_held = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
      ImuSample s = good[i];
      if (i >= 6000) fail(s);
      method.add(s, found);
      if (i >= 6000 + 30 * 50) most_held = std::max(most_held, i + 1 - found.heaves.size());
    }
    EXPECT_EQ(most_held, 0U);
    EXPECT_GE(found.waves.size(), 18U);
    method.finish(found);
    ASSERT_EQ(found.heaves.size(), good.size());
    for (std::size_t i = 0; i < good.size(); ++i) ASSERT_EQ(found.heaves[i].seq, good[i].seq);
  }
}

// A buoy's record has no end: what the method holds is some waves, in waves and at rest, after an hour as after
// four.
TEST(Harmonic, HoldsNoMoreOfALongRecordThanOfAShortOne) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitizer's allocator does not tell what is in use";
#endif
  for (const double height_m : {1.0, 0.0}) {
    Harmonic method(knowing(kFresh));
    Output nobody;
    RandomStream random(5, "noise");
    auto held_after = [&, row = std::int64_t{0}](std::int64_t hours) mutable {
      constexpr double kRate_Hz = 10, kPeriod_s = 8;
      for (; row < hours * 36000; ++row) {
        const double phase = 2 * kPi * static_cast<double>(row) / (kRate_Hz * kPeriod_s);
        ImuSample sample;
        sample.utime = row * 100000;
        sample.f_B = {random.gaussian(0.01), random.gaussian(0.01),
                      -kStandardGravity + square(2 * kPi / kPeriod_s) * height_m / 2 * std::sin(phase) +
                          random.gaussian(0.01)};
        method.add(sample, nobody);
      }
      return ::mallinfo2().uordblks;
    };
    const auto short_bytes = held_after(1), long_bytes = held_after(4);
    EXPECT_LT(long_bytes, 2 * short_bytes) << height_m << " m";
  }
}

TEST(Harmonic, HeaveIsTheTruthWithinTheNoiseOfAWave) {
  const SyntheticRecord record = testing::synthesize(waves_of(6, 1, Swing::kPendulum), SensorErrors{}, 1);
  const Collector found = measure(record, knowing(kFresh));
  ASSERT_EQ(found.heaves.size(), record.samples.size());
  double squares = 0, n = 0;
  for (std::size_t i = 500; i + 700 < found.heaves.size(); ++i) {
    squares += std::pow(found.heaves[i].heave_m - record.heave_m[i], 2);
    n += 1;
  }
  EXPECT_LT(std::sqrt(squares / n), 0.003);

  // What is stated of heave is half of what is stated of the wave's height, all of it.
  const Wave& wave = found.waves.at(10);
  const auto inside = std::find_if(found.heaves.begin(), found.heaves.end(), [&](const HeaveSample& h) {
    return h.utime > wave.start_utime + std::llround(0.5e6 * wave.period_s);
  });
  EXPECT_NEAR(inside->heave_sigma_m,
              0.5 * std::hypot(std::hypot(wave.noise_sigma_m, wave.calibration_sigma_m), wave.tilt_sigma_m,
                               wave.frequency_sigma_m),
              1e-12);
}

// Where the arm starts and, the record read backwards, where it stops, waves are of no one height: sigma and flag of
// heave say so, and those of the waves between them are left as they are.
TEST(Harmonic, SaysHowFarHeaveIsOffWhereTheArmStartsAndStops) {
  for (const double period_s : {3.0, 6.0, 12.0}) {
    for (const bool stops : {false, true}) {
      SyntheticWaves waves = waves_of(period_s, 1, Swing::kLevel);
      waves.rate_Hz = 100;
      waves.rest_s = 15;
      waves.ramp_waves = 2;
      waves.phase_rad = 0;
      waves.duration_s = 240;
      SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 4);
      if (stops) {
        const std::int64_t ends = record.samples.front().utime + record.samples.back().utime;
        std::reverse(record.samples.begin(), record.samples.end());
        std::reverse(record.heave_m.begin(), record.heave_m.end());
        for (ImuSample& sample : record.samples) {
          sample.utime = ends - sample.utime;
          sample.w_NB_B = -sample.w_NB_B;
        }
        for (std::size_t i = 0; i < record.samples.size(); ++i)
          record.samples[i].seq = static_cast<std::int64_t>(i);
      }
      const Collector found = measure(record, knowing(kFresh));
      ASSERT_EQ(found.heaves.size(), record.samples.size());
      double squares = 0, told = 0, settling = 0, worst_settled = 0;
      for (std::size_t i = 0; i < found.heaves.size(); ++i) {
        const HeaveSample& heave = found.heaves[i];
        if (!std::isfinite(heave.heave_m)) continue;
        const double z = std::abs(heave.heave_m - record.heave_m[i]) / heave.heave_sigma_m;
        squares += z * z;
        ++told;
        if (heave.flags & flag::kSettling)
          ++settling;
        else
          worst_settled = std::max(worst_settled, z);
      }
      const auto text = ::testing::Message() << period_s << " s, " << (stops ? "stops" : "starts");
      EXPECT_LT(std::sqrt(squares / told), 1.5) << text;
      EXPECT_LT(worst_settled, 5) << text;
      EXPECT_GT(settling, 0) << text;
      EXPECT_LT(settling * 0.01, 6 * period_s) << text;
    }
  }
}

// Stokes' second harmonic leaves crest to trough as it is; heave, a sine, is off by it and says so.
TEST(Harmonic, StatesWhatASecondHarmonicAddsToHeave) {
  SyntheticWaves waves = waves_of(6, 1, Swing::kLevel);
  waves.rate_Hz = 100;
  waves.mounting = {};
  SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, 2);
  const double second_m = 0.05, w = 2 * kPi / waves.period_s;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    const double t_s = static_cast<double>(record.samples[i].utime - record.samples.front().utime) * kMicrosecond;
    const double up_m = second_m * std::cos(2 * (w * t_s + waves.phase_rad));
    record.heave_m[i] += up_m;
    record.samples[i].f_B.z() += 4 * w * w * up_m;
  }
  const Collector found = measure(record, knowing(kFresh));
  const Mean mean = mean_of(found.waves);
  EXPECT_NEAR(mean.height_m, waves.height_m, 3 * mean.sigma_m);
  double squares = 0, variance = 0, n = 0;
  for (std::size_t i = 1000; i + 1400 < found.heaves.size(); ++i) {
    EXPECT_FALSE(found.heaves[i].flags & flag::kSettling);
    squares += std::pow(found.heaves[i].heave_m - record.heave_m[i], 2);
    variance += std::pow(found.heaves[i].heave_sigma_m, 2);
    n += 1;
  }
  EXPECT_NEAR(std::sqrt(squares / n), second_m / std::sqrt(2), 0.002);
  EXPECT_NEAR(std::sqrt(variance / n), std::sqrt(squares / n), 0.002);
}

// Where one wave ends and the next begins each has by its own fit.
TEST(Harmonic, KnowsHeaveBetweenTwoWavesToo) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    SyntheticWaves waves = waves_of(12, 0.6, Swing::kForced);
    waves.rate_Hz = 100;
    waves.duration_s = 400;
    const SyntheticRecord record = testing::synthesize(waves, SensorErrors{}, seed);
    const Collector out = measure(record, knowing(kFresh));
    const auto known = [](const HeaveSample& h) { return std::isfinite(h.heave_m); };
    const auto first = std::find_if(out.heaves.begin(), out.heaves.end(), known);
    const auto last = std::find_if(out.heaves.rbegin(), out.heaves.rend(), known).base();
    ASSERT_GT(last - first, 30000);
    EXPECT_EQ(std::count_if(first, last, known), last - first) << "seed " << seed;
  }
}

TEST(Harmonic, FindsTheSameWavesAtAnyRateAndInAnyMounting) {
  for (const double rate_Hz : {10.0, 20.0, 100.0, 285.7}) {
    SyntheticWaves waves = waves_of(5, 1, Swing::kPendulum);
    waves.rate_Hz = rate_Hz;
    waves.duration_s = 100;
    waves.mounting = rate_Hz > 50 ? Euler{2.9, 0.3, 1} : Euler{0.5, -0.4, 1};
    const Mean mean = mean_of(measure(testing::synthesize(waves, SensorErrors{}, 1), knowing(kFresh)).waves);
    EXPECT_GE(mean.waves, 18) << rate_Hz;
    EXPECT_NEAR(mean.height_m, 1, 0.003) << rate_Hz;
  }
}

}  // namespace
}  // namespace waverig::estimator
