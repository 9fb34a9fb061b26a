#include <gtest/gtest.h>

#include "estimator/attitude/attitude_filter.h"
#include "estimator/attitude/attitude_smoother.h"
#include "lcmtypes/flags.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::AttitudeFilter;
using estimator::AttitudeSample;
using estimator::AttitudeSettings;

AttitudeSettings settings() {
  AttitudeSettings s;
  s.gravity_mps2 = kStandardGravity;
  return s;
}

std::vector<AttitudeSample> filtered(const std::vector<estimator::ImuSample>& samples) {
  AttitudeFilter filter(settings());
  std::vector<AttitudeSample> attitude;
  for (const auto& sample : samples) attitude.push_back(filter.update(sample));
  return attitude;
}

double rms_tilt_deg(const std::vector<AttitudeSample>& attitude, const SeaRecord& record, std::size_t begin) {
  double sum = 0;
  for (std::size_t i = begin; i < attitude.size(); ++i) sum += square(tilt_between(attitude[i].q_NB, record.q_NB[i]));
  return std::sqrt(sum / static_cast<double>(attitude.size() - begin)) / kDegree;
}

TEST(AttitudeFilter, LevelsAtOnceByTheFirstSampleAtRest) {
  const Quaterniond q_NB = quaternion_of({0.2, -0.1, 0});
  estimator::ImuSample sample;
  sample.utime = 1;
  sample.f_B = q_NB.conjugate() * Vector3d(0, 0, -kStandardGravity);
  AttitudeFilter filter(settings());
  const AttitudeSample& a = filter.update(sample);
  EXPECT_NEAR(tilt_between(a.q_NB, q_NB), 0, 1e-9);
  EXPECT_NEAR(a.a_N.norm(), 0, 1e-9);
}

TEST(AttitudeFilter, KeepsTheTiltWithinAFifthOfADegreeOnAnySea) {
  for (const auto& [tp, hm0] : {std::pair{4.0, 0.5}, {8.0, 1.5}, {12.0, 4.0}}) {
    const SeaRecord record = sea_record({.tp_s = tp, .hm0_m = hm0, .duration_s = 400}, 3);
    EXPECT_LT(rms_tilt_deg(filtered(record.samples), record, 12000), 0.2) << tp;
  }
}

TEST(AttitudeFilter, LearnsAGyroBiasWithinAMinute) {
  SeaRecord record = sea_record({.duration_s = 120}, 5);
  const Vector3d bias_B(0.4 * kDegree, -0.4 * kDegree, 0);
  for (auto& sample : record.samples) sample.w_NB_B += bias_B;
  const AttitudeSample with = filtered(record.samples)[6000];
  EXPECT_LT(tilt_between(with.q_NB, record.q_NB[6000]), 0.4 * kDegree);
  EXPECT_LT((with.gyro_bias_B - bias_B).head<2>().norm(), 0.6 * kDegree);
}

TEST(AttitudeFilter, StatesATiltSigmaThatHoldsOverManySensors) {
  double squared = 0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SeaRecord record = sea_record({.tp_s = 7, .hm0_m = 1, .duration_s = 150}, seed);
    const auto attitude = filtered(record.samples);
    for (std::size_t i = 9000; i < attitude.size(); i += 500, ++n)
      squared += square(tilt_between(attitude[i].q_NB, record.q_NB[i]) / attitude[i].tilt_sigma_rad) / 2;  // two axes
  }
  EXPECT_GT(squared / n, 0.2);
  EXPECT_LT(squared / n, 1.5);
}

TEST(AttitudeFilter, LevelsAnewAfterALongGapAndKeepsTheBias) {
  SeaRecord record = sea_record({.duration_s = 300}, 7);
  AttitudeFilter filter(settings());
  AttitudeSample last;
  record.samples[16000].flags |= flag::kGap;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    if (i < 12000 || i >= 16000) last = filter.update(record.samples[i]);
    if (i == 16000) {  // no more is known than one sample tells
      EXPECT_FALSE(last.settled);
      EXPECT_LT(tilt_between(last.q_NB, record.q_NB[i]), 0.2);
    }
  }
  EXPECT_LT(tilt_between(last.q_NB, record.q_NB.back()), 0.4 * kDegree);
  EXPECT_TRUE(last.settled);
}

TEST(AttitudeFilter, WidensItsSigmaWhileTheSensorIsSaturated) {
  SeaRecord record = sea_record({.duration_s = 100}, 8);
  AttitudeFilter filter(settings());
  for (auto& sample : record.samples) filter.update(sample);
  const double before = filter.update([&] {
    auto s = record.samples.back();
    s.utime += 10000;
    return s;
  }()).tilt_sigma_rad;
  double after = 0;
  for (int i = 2; i < 12; ++i) {
    auto s = record.samples.back();
    s.utime += i * 10000;
    s.flags = flag::kSaturation;
    after = filter.update(s).tilt_sigma_rad;
  }
  EXPECT_GT(after, 1.5 * before);
}

TEST(AttitudeSmoother, IsTwiceAsGoodAsTheFilter) {
  const SeaRecord record = sea_record({.tp_s = 9, .hm0_m = 2, .duration_s = 400}, 11);
  const auto smooth = estimator::smooth_attitude(record.samples, settings());
  ASSERT_EQ(smooth.size(), record.samples.size());
  EXPECT_LT(rms_tilt_deg(smooth, record, 0), 0.1);
}

// The first sample has nothing before it: over several seas, since one tells little of an error of its size.
TEST(AttitudeSmoother, KnowsTheFirstSamplesAttitudeWithinAFifthOfADegree) {
  double squares = 0;
  constexpr int kSeas = 8;
  for (int sea = 0; sea < kSeas; ++sea) {
    const SeaRecord record = sea_record({.tp_s = 9, .hm0_m = 2, .duration_s = 400}, 11U + static_cast<std::uint64_t>(sea));
    const auto smooth = estimator::smooth_attitude(record.samples, settings());
    squares += std::pow(tilt_between(smooth.front().q_NB, record.q_NB.front()), 2) / kSeas;
  }
  EXPECT_LT(std::sqrt(squares), 0.2 * kDegree);
}

TEST(AttitudeSmoother, TakesRecordsOfNoneOneAndTwoSamples) {
  const SeaRecord record = sea_record({.duration_s = 1}, 12);
  EXPECT_TRUE(estimator::smooth_attitude({}, settings()).empty());
  for (const std::size_t n : {1u, 2u, 20u}) {
    const std::vector<estimator::ImuSample> few(record.samples.begin(), record.samples.begin() + static_cast<std::ptrdiff_t>(n));
    EXPECT_EQ(estimator::smooth_attitude(few, settings()).size(), n);
  }
}

}  // namespace
}  // namespace waverig::testing
