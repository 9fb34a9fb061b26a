// A buoy turns on its mooring: heave does not depend on it, however fast, though the gyroscope's bias, which stays with
// the body, turns in the level frame.
#include <gtest/gtest.h>

#include "estimator/attitude/attitude_filter.h"
#include "estimator/method.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

constexpr double kNever_s = 1e9;

// After the minutes in which the sea is learnt.
double settled_rms(const char* method, const SeaRecord& record) {
  const auto estimator = estimator::make_method(method, {});
  const Collector out = run(*estimator, record.samples);
  EXPECT_EQ(out.heaves.size(), record.samples.size());
  return rms_over_hm0(out.heaves, record, record.samples.size() / 2, out.heaves.size());
}

TEST(TurningBody, IsFollowedAsOneThatKeepsItsHeading) {
  for (const SeaCase& sea : {SeaCase{.tp_s = 7, .hm0_m = 1, .duration_s = 600, .rate_Hz = 50},
                             SeaCase{.tp_s = 12, .hm0_m = 4, .duration_s = 600, .rate_Hz = 50}})
    for (const char* method : {"smoothed", "realtime"}) {
      const double still = settled_rms(method, turning_record(sea, kNever_s, 1));
      for (const double turn_s : {60.0, 40.0, 20.0, -20.0, 10.0})
        EXPECT_NEAR(settled_rms(method, turning_record(sea, turn_s, 1)), still, 0.3 * still)
            << method << ", a turn in " << turn_s << " s";
    }
}

// What the attitude says of itself holds, too.
TEST(TurningBody, LearnsTheGyroscopesBias) {
  const SeaRecord record = turning_record({.tp_s = 7, .hm0_m = 1, .duration_s = 300, .rate_Hz = 50}, 25, 2);
  estimator::AttitudeFilter filter{estimator::AttitudeSettings{}};
  double squares = 0, over_sigma = 0, count = 0;
  for (std::size_t i = 0; i < record.samples.size(); ++i) {
    const estimator::AttitudeSample& told = filter.update(record.samples[i]);
    if (i < record.samples.size() / 2) continue;
    const double squared_rad2 = square(tilt_between(told.q_NB, record.q_NB[i])) / 2;  // an axis
    squares += squared_rad2;
    over_sigma += squared_rad2 / square(told.tilt_sigma_rad);
    ++count;
  }
  EXPECT_LT(std::sqrt(squares / count), 0.1 * kDegree);
  EXPECT_LT(std::sqrt(over_sigma / count), 1.5);
}

}  // namespace
}  // namespace waverig::testing
