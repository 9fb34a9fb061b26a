#include "motion/envelope.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "motion/kinematics/frames.h"

namespace waverig::motion {
namespace {

// A 4 g part with 350 ug/sqrt(Hz) on an arm that reaches far enough.
EnvelopeSettings cheap_sensor() {
  return {.max_radius_m = 2,
          .sensor_range_mps2 = 4 * kStandardGravity,
          .noise_mps2_sqrtHz = 350e-6 * kStandardGravity,
          .drift_mps2 = 1e-3 * kStandardGravity};
}

const Judgement* find(const std::vector<Judgement>& judgements, EnvelopeReason reason) {
  const auto it =
      std::find_if(judgements.begin(), judgements.end(), [&](const auto& j) { return j.reason == reason; });
  return it == judgements.end() ? nullptr : &*it;
}

TEST(Envelope, LetsThePapersSettingsPass) {
  for (const double period_s : {6.0, 12.0})
    for (const double height_m : {0.6, 0.8, 1.0})
      EXPECT_TRUE(judge(period_s, height_m, 2, cheap_sensor()).empty())
          << period_s << " s " << height_m << " m";
}

TEST(Envelope, DeepWaterBreaksAtASeventhOfTheLength) {
  EXPECT_NEAR(deep_water_length_m(1), 1.5608, 1e-4);
  EXPECT_FALSE(find(judge(1, 0.222, 2, cheap_sensor()), EnvelopeReason::kBreaks));
  const auto judgements = judge(1, 0.224, 2, cheap_sensor());
  const Judgement* breaks = find(judgements, EnvelopeReason::kBreaks);
  ASSERT_TRUE(breaks);
  EXPECT_EQ(breaks->verdict, Verdict::kWarn);
  EXPECT_EQ(breaks->sentence,
            "1 s, 0.224 m: breaks: H/L = 0.144 is above 1/7 (deep water, L = 1.561 m): no sea carries more "
            "than 0.223 m");
}

TEST(Envelope, TwoMetresAtOneSecondNeedFiveGAndClipAFourGPart) {
  EXPECT_NEAR(peak_acceleration_mps2(1, 2) / kStandardGravity, 4.03, 0.01);
  const auto judgements = judge(1, 2, 2, cheap_sensor());
  const Judgement* clips = find(judgements, EnvelopeReason::kClips);
  ASSERT_TRUE(clips);
  EXPECT_EQ(clips->verdict, Verdict::kRefuse);
  EXPECT_NE(clips->sentence.find("5.03 g and clips at 4 g"), std::string::npos) << clips->sentence;
}

// At the orbit's lowest point the sensor feels gravity and the wave together.
TEST(Envelope, AWaveOfThreeAndAHalfGClipsAFourGPart) {
  EXPECT_TRUE(find(judge(1, 1.74, 2, cheap_sensor()), EnvelopeReason::kClips));
  EXPECT_FALSE(find(judge(1, 1.45, 2, cheap_sensor()), EnvelopeReason::kClips));
}

// REFERENCE section 3 grows with T^1.5: at 20 s one wave's height scatters by 1.5 cm.
TEST(Envelope, WarnsAboveATenthOfTheHeightAndRefusesAboveAHalf) {
  const auto verdict_at = [](double height_m) -> std::optional<Verdict> {
    EnvelopeSettings settings = cheap_sensor();
    settings.drift_mps2 = 0;
    const auto judgements = judge(20, height_m, 2, settings);
    const Judgement* noise = find(judgements, EnvelopeReason::kBelowNoise);
    return noise ? std::optional(noise->verdict) : std::nullopt;
  };
  EXPECT_EQ(verdict_at(0.16), std::nullopt);
  EXPECT_EQ(verdict_at(0.14), Verdict::kWarn);
  EXPECT_EQ(verdict_at(0.032), Verdict::kWarn);
  EXPECT_EQ(verdict_at(0.030), Verdict::kRefuse);
}

TEST(Envelope, ATenthOfAMetreAtTwentySecondsIsBelowNoiseAndDrift) {
  EXPECT_NEAR(peak_acceleration_mps2(20, 0.1) / kStandardGravity, 0.5e-3, 0.02e-3);
  const auto judgements = judge(20, 0.1, 2, cheap_sensor());
  EXPECT_EQ(std::count_if(judgements.begin(), judgements.end(),
                          [](const auto& j) { return j.reason == EnvelopeReason::kBelowNoise; }),
            2);
}

TEST(Envelope, NoiseBoundIsTheOneOfTheReference) {
  const double nd = 350e-6 * kStandardGravity;
  EXPECT_NEAR(height_sigma_bound_m(6, nd), 0.0026, 0.0001);
  EXPECT_NEAR(height_sigma_bound_m(12, nd), 0.0072, 0.0001);
}

TEST(Envelope, RefusesWhatIsBeyondTheRigByRadiusRateAndAcceleration) {
  EnvelopeSettings settings = cheap_sensor();
  EXPECT_TRUE(find(judge(8, 4.2, 2, settings), EnvelopeReason::kBeyondRig));
  EXPECT_TRUE(find(judge(8, 0.05, 2, settings), EnvelopeReason::kBeyondRig));
  settings.limits.rate_radps = 1;
  const auto fast = judge(6, 1, 2, settings);
  ASSERT_EQ(fast.size(), 1u);
  EXPECT_EQ(fast[0].sentence,
            "6 s, 1 m: beyond the rig: angular rate 1.047 rad/s is beyond the axis limit 1 rad/s");
  settings = cheap_sensor();
  settings.max_centripetal_mps2 = 5;
  EXPECT_TRUE(find(judge(2, 1.1, 2, settings), EnvelopeReason::kBeyondRig));
  settings = cheap_sensor();
  settings.limits.accel_radps2 = 2;
  EXPECT_TRUE(find(judge(1.5, 0.3, 1, settings), EnvelopeReason::kBeyondRig));
  EXPECT_FALSE(find(judge(1.5, 0.3, 4, settings), EnvelopeReason::kBeyondRig));  // a longer ramp helps
}

TEST(Envelope, RefusesNonsenseInsteadOfDividingByIt) {
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(judge(bad, 1, 2, cheap_sensor()).front().verdict, Verdict::kRefuse);
    EXPECT_EQ(judge(6, bad, 2, cheap_sensor()).front().verdict, Verdict::kRefuse);
  }
}

}  // namespace
}  // namespace waverig::motion
