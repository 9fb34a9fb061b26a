// Heave of the methods that answer every sample: a series in order of time, whatever the samples' times are.
#include "estimator/waves/heave_order.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "estimator/waves/harmonic.h"
#include "estimator/waves/lee2014.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/synthetic_waves.h"

namespace waverig::estimator {
namespace {

using testing::Collector;

std::vector<ImuSample> waves() {
  testing::SyntheticWaves w;
  w.period_s = 6;
  w.height_m = 1;
  w.rate_Hz = 50;
  w.duration_s = 120;
  return testing::synthesize(w, testing::SensorErrors{}, 1).samples;
}

std::vector<std::int64_t> seqs(const Collector& found) {
  std::vector<std::int64_t> seqs;
  for (const HeaveSample& heave : found.heaves) seqs.push_back(heave.seq);
  return seqs;
}

void expect_heave_of(const std::vector<ImuSample>& samples, const std::vector<std::int64_t>& expected) {
  Harmonic harmonic{MethodSettings{}};
  EXPECT_EQ(seqs(testing::run(harmonic, samples)), expected) << "harmonic";
  Lee2014 lee2014{MethodSettings{}};
  EXPECT_EQ(seqs(testing::run(lee2014, samples)), expected) << "lee2014";
}

TEST(HeaveOrder, LeavesOutSamplesWhoseTimeDoesNotGrow) {
  std::vector<ImuSample> samples;
  std::vector<std::int64_t> expected;
  for (const ImuSample& s : waves()) {
    samples.push_back(s);
    expected.push_back(s.seq);
    ImuSample again = s;
    again.seq = -1;
    samples.push_back(again);
    again.utime -= 35'000;
    if (s.seq % 10 == 0) samples.push_back(again);
  }
  expect_heave_of(samples, expected);
}

TEST(HeaveOrder, BelievesNoTimeFarAheadOfARejectedSampleAlone) {
  for (const std::int64_t ahead : {std::int64_t{3'600'000'000}, std::numeric_limits<std::int64_t>::max() / 2,
                                   -std::numeric_limits<std::int64_t>::max()})
    for (const std::size_t bad : {0, 3000}) {
      std::vector<ImuSample> samples = waves();
      std::vector<std::int64_t> expected;
      samples[bad].utime += ahead;
      samples[bad].f_B.x() = kUnknown;
      for (std::size_t i = 0; i < samples.size(); ++i)
        if (i != bad || (i == 0 && ahead < 0)) expected.push_back(samples[i].seq);
      expect_heave_of(samples, expected);
    }
}

// Such as a sensor tells that sends nothing sound after a pause.
TEST(HeaveOrder, BelievesATimeFarAheadOnceTheNextIsOfItToo) {
  std::vector<ImuSample> samples = waves();
  std::vector<std::int64_t> expected;
  for (std::size_t i = 3000; i < samples.size(); ++i) {
    samples[i].utime += 3'600'000'000;
    samples[i].f_B.x() = kUnknown;
  }
  for (const ImuSample& s : samples) expected.push_back(s.seq);
  expect_heave_of(samples, expected);
}

}  // namespace
}  // namespace waverig::estimator
