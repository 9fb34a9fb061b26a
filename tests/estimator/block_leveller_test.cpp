#include "estimator/waves/block_leveller.h"

#include <gtest/gtest.h>

#include "tests/estimator/synthetic_waves.h"

namespace waverig::estimator {
namespace {

using testing::SensorErrors;
using testing::Swing;
using testing::SyntheticRecord;
using testing::SyntheticWaves;

SensorErrors gyro_bias(double degree_per_s) {
  SensorErrors e;
  e.gyro_bias_radps = degree_per_s * kDegree * Vector3d(1, -1, 1);
  return e;
}

std::deque<LevelledSample> level(const std::vector<ImuSample>& samples, BlockLeveller& leveller) {
  SampleGuard guard;
  std::deque<LevelledSample> out;
  for (const ImuSample& s : samples) leveller.add(s, guard.check(s), out);
  leveller.finish(out);
  return out;
}

// Angle between the true and the found vertical.
double lean_rad(const Quaterniond& truth, const Quaterniond& found) {
  const Vector3d a = truth.conjugate() * Vector3d::UnitZ(), b = found.conjugate() * Vector3d::UnitZ();
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

TEST(BlockLeveller, GivesEverySampleOnceAndInOrder) {
  SyntheticWaves waves;
  waves.rate_Hz = 50;
  waves.duration_s = 333;
  const SyntheticRecord record = testing::synthesize(waves, gyro_bias(0.2), 1);
  BlockLeveller leveller{{}};
  const std::deque<LevelledSample> out = level(record.samples, leveller);
  ASSERT_EQ(out.size(), record.samples.size());
  for (std::size_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i].seq, record.samples[i].seq);
}

TEST(BlockLeveller, LearnsTheGyroBiasThatWouldLeanTheFrameBy40DegreesToWithinTheGyrosRandomWalk) {
  const auto rms_lean_rad = [](const SyntheticWaves& waves, double gyro_noise) {
    SensorErrors errors = gyro_bias(0.2);
    errors.gyro_noise_radps_rthz = gyro_noise;
    const SyntheticRecord record = testing::synthesize(waves, errors, 1);
    BlockLeveller leveller{{}};
    const std::deque<LevelledSample> out = level(record.samples, leveller);
    double squares = 0;
    for (std::size_t i = 0; i < out.size(); ++i)
      squares += std::pow(lean_rad(record.q_NB[i], out[i].q_NB), 2);
    return std::sqrt(squares / static_cast<double>(out.size()));
  };
  // A random walk of one-sided rate density d strays by d sqrt(block / 2) over a block; less once a line is
  // taken off.
  const double density = SensorErrors{}.gyro_noise_radps_rthz, walk_rad = density * std::sqrt(50.0);
  for (const Swing swing : {Swing::kLevel, Swing::kForced, Swing::kPendulum}) {
    for (const double period_s : {2.0, 6.0, 20.0}) {
      SyntheticWaves waves;
      waves.period_s = period_s;
      waves.height_m = period_s < 3 ? 0.4 : 1.0;
      waves.swing = swing;
      waves.rate_Hz = 50;
      waves.duration_s = 200;
      EXPECT_LT(rms_lean_rad(waves, 1e-9), 3e-4) << period_s;
      EXPECT_LT(rms_lean_rad(waves, density), 1.2 * walk_rad) << period_s;
    }
  }
}

TEST(BlockLeveller, AGyroBiasOfDegreesPerSecondIsNoHindrance) {
  SyntheticWaves waves;
  waves.rate_Hz = 50;
  waves.duration_s = 120;
  const SyntheticRecord record = testing::synthesize(waves, gyro_bias(3), 1);
  BlockLeveller leveller{{}};
  const std::deque<LevelledSample> out = level(record.samples, leveller);
  EXPECT_LT(lean_rad(record.q_NB[3000], out[3000].q_NB), 3e-3);
}

TEST(BlockLeveller, BeginsAnewAfterAGapInWhichTheRotationIsUnknown) {
  SyntheticWaves waves;
  waves.rate_Hz = 50;
  waves.duration_s = 160;
  waves.swing = Swing::kForced;
  const SyntheticRecord record = testing::synthesize(waves, gyro_bias(0.2), 1);
  std::vector<ImuSample> samples = record.samples;
  const Quaterniond turned = quaternion_of({0.4, 0.2, 0});  // someone moved the sensor meanwhile
  for (std::size_t i = 4000; i < samples.size(); ++i) {
    samples[i].utime += 5'000'000;
    samples[i].f_B = turned.conjugate() * samples[i].f_B;
    samples[i].w_NB_B = turned.conjugate() * samples[i].w_NB_B;
  }
  BlockLeveller leveller{{}};
  const std::deque<LevelledSample> out = level(samples, leveller);
  ASSERT_EQ(out.size(), samples.size());
  EXPECT_LT(lean_rad(record.q_NB[2000], out[2000].q_NB), 3e-3);
  EXPECT_LT(lean_rad(record.q_NB[6000] * turned, out[6000].q_NB), 3e-3);
}

TEST(BlockLeveller, BeginsWithTheFirstUsableSampleHoweverManyCameBefore) {
  SyntheticWaves waves;
  waves.rate_Hz = 50;
  waves.duration_s = 320;
  SyntheticRecord record = testing::synthesize(waves, gyro_bias(0.2), 1);
  constexpr std::size_t kBad = 6000;  // longer than a block
  for (std::size_t i = 0; i < kBad; ++i) record.samples[i].f_B.setConstant(kUnknown);
  BlockLeveller leveller{{}};
  const std::deque<LevelledSample> out = level(record.samples, leveller);
  ASSERT_EQ(out.size(), record.samples.size());
  for (std::size_t i = 0; i < out.size(); ++i) ASSERT_EQ(out[i].seq, record.samples[i].seq);
  EXPECT_EQ(out[kBad].t_s, 0);
  for (std::size_t i = kBad; i < out.size(); i += 500)
    EXPECT_LT(lean_rad(record.q_NB[i], out[i].q_NB), 1e-2) << i;
}

TEST(BlockLeveller, ABlockShorterThanANodeIsOnlyABadSetting) {
  SyntheticWaves waves;
  waves.rate_Hz = 50;
  waves.duration_s = 10;
  const SyntheticRecord record = testing::synthesize(waves, gyro_bias(0.2), 1);
  BlockLevellerSettings settings;
  settings.block_s = 0.05;
  BlockLeveller leveller{settings};
  EXPECT_EQ(level(record.samples, leveller).size(), record.samples.size());
}

}  // namespace
}  // namespace waverig::estimator
