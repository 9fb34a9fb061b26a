#include "estimator/compass/directional.h"

#include <gtest/gtest.h>

#include <functional>

#include "estimator/compass/direction_budget.h"
#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "motion/sea_state.h"

namespace waverig::estimator {
namespace {

constexpr double kDip = 60 * kDegree;

double off_deg(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi)) / kDegree;
}

// True acceleration in N to what an attitude filter without a compass gives: a frame L that turns slowly.
struct Presenter {
  double declination_rad = 0;
  double frame_start_rad = 0.7, frame_rate_radps = 0.1 * kDegree;
  double accel_noise_mps2 = 0;
  Matrix3d soft_iron = Matrix3d::Identity();
  Vector3d hard_iron = Vector3d::Zero();  // of the total field
  double field_noise = 0;
  RandomStream random{1, "presenter"};

  LevelSample operator()(const BodyMotion& motion) {
    const double t = static_cast<double>(motion.utime) * kMicrosecond;
    const Quaterniond q_LN = quaternion_of({0, 0, -(frame_start_rad + frame_rate_radps * t)});
    LevelSample sample{
        .utime = motion.utime, .a_L = q_LN * motion.acceleration_N, .q_LB = q_LN * motion.q_NB};
    for (int i = 0; i < 3; ++i) sample.a_L[i] += random.gaussian(accel_noise_mps2);
    const Vector3d m_N(std::cos(kDip) * std::cos(declination_rad), std::cos(kDip) * std::sin(declination_rad),
                       std::sin(kDip));
    sample.m_B_uT = soft_iron * (motion.q_NB.conjugate() * m_N) + hard_iron;
    for (int i = 0; i < 3; ++i) sample.m_B_uT[i] += random.gaussian(field_noise);
    return sample;
  }
};

// A deep-water wave of height H from theta: at the crest the water moves the way the wave goes.
BodyMotion regular_wave(double t_s, double period_s, double height_m, double from_rad) {
  const double w = 2 * std::numbers::pi / period_s, a = height_m / 2;
  const double towards = from_rad + std::numbers::pi;
  BodyMotion motion;
  motion.utime = std::llround(t_s * 1e6);
  const double along = a * std::sin(w * t_s),
               up = a * std::cos(w * t_s);  // velocity along the way: a w cos, at the crest
  motion.position_N = {along * std::cos(towards), along * std::sin(towards), -up};
  motion.acceleration_N = -w * w * motion.position_N;
  return motion;
}

DirectionalSea analysed(const std::function<BodyMotion(double)>& motion, Presenter presenter,
                        double duration_s, DirectionalSettings settings = {}, double rate_Hz = 50) {
  settings.compass.declination_rad = presenter.declination_rad;
  DirectionalAnalysis analysis(settings);
  const auto n = static_cast<std::int64_t>(duration_s * rate_Hz);
  for (std::int64_t i = 0; i < n; ++i) analysis.add(presenter(motion(static_cast<double>(i) / rate_Hz)));
  return analysis.finish();
}

// The bins' mean takes (sin x / x)^2 off a wave of two seconds, five percent; it is given back.
TEST(DirectionalAnalysis, TellsTheHeightOfShortWavesToo) {
  for (const double period_s : {2.0, 4.0, 10.0}) {
    const DirectionalSea sea =
        analysed([&](double t) { return regular_wave(t, period_s, 0.2, 1); }, Presenter{}, 300);
    EXPECT_NEAR(sea.hm0_m, 4 * 0.1 / std::sqrt(2), 0.02 * 4 * 0.1 / std::sqrt(2)) << period_s;
  }
}

TEST(DirectionalAnalysis, AGapOfYearsTakesNeitherTimeNorMemory) {
  DirectionalAnalysis analysis(DirectionalSettings{});
  Presenter presenter;
  for (const double later_s : {0.0, 1e12})  // thirty thousand years
    for (int i = 0; i < 15000; ++i) analysis.add(presenter(regular_wave(later_s + 0.02 * i, 8, 1, 1)));
  EXPECT_LT(off_deg(analysis.finish().mean_direction_rad, 1), 0.1);
}

TEST(DirectionalAnalysis, TellsWhereARegularWaveComesFrom) {
  for (const double from_deg : {0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0}) {
    const double from = from_deg * kDegree;
    const DirectionalSea sea =
        analysed([&](double t) { return regular_wave(t, 8, 1, from); }, Presenter{}, 300);
    EXPECT_LT(off_deg(sea.mean_direction_rad, from), 0.05) << from_deg;
    EXPECT_LT(off_deg(sea.peak_direction_rad, from), 0.05) << from_deg;
    EXPECT_LT(sea.spread_rad, 1.5 * kDegree);
    EXPECT_NEAR(sea.check_factor, 1, 1e-3);
    EXPECT_NEAR(sea.peak_Hz, 0.125, 0.005);
  }
}

TEST(DirectionalAnalysis, WavesFromTheWestRunEastAtTheirCrest) {
  const BodyMotion before = regular_wave(-0.01, 8, 1, 270 * kDegree),
                   after = regular_wave(0.01, 8, 1, 270 * kDegree);
  ASSERT_GT(after.position_N.y(), before.position_N.y());
  ASSERT_LT(regular_wave(0, 8, 1, 0).position_N.z(), 0);  // the crest
  const DirectionalSea sea =
      analysed([](double t) { return regular_wave(t, 8, 1, 270 * kDegree); }, Presenter{}, 200);
  EXPECT_LT(off_deg(sea.mean_direction_rad, 270 * kDegree), 0.05);
}

TEST(DirectionalAnalysis, CoefficientsOfARegularWaveAreThoseOfItsDirection) {
  const double from = 30 * kDegree;
  const DirectionalSea sea =
      analysed([&](double t) { return regular_wave(t, 8, 1, from); }, Presenter{}, 400);
  const DirectionalBand* peak = nullptr;
  double variance = 0;
  for (const DirectionalBand& band : sea.bands) {
    if (!peak || band.a0_m2pHz > peak->a0_m2pHz) peak = &band;
    variance += band.a0_m2pHz * (sea.bands[1].frequency_Hz - sea.bands[0].frequency_Hz);
  }
  EXPECT_NEAR(peak->a1, std::cos(from), 1e-3);
  EXPECT_NEAR(peak->b1, std::sin(from), 1e-3);
  EXPECT_NEAR(peak->a2, std::cos(2 * from), 1e-3);
  EXPECT_NEAR(peak->b2, std::sin(2 * from), 1e-3);
  EXPECT_LT(off_deg(peak->direction_from_rad(), from), 0.1);
  EXPECT_NEAR(4 * std::sqrt(variance), 4 * std::sqrt(0.125), 0.02 * 4 * std::sqrt(0.125));
  EXPECT_NEAR(sea.hm0_m, 4 * std::sqrt(0.125), 0.02 * 4 * std::sqrt(0.125));
}

TEST(DirectionalAnalysis, AddsTheDeclinationOnce) {
  Presenter presenter;
  presenter.declination_rad = -9 * kDegree;
  const double from = 200 * kDegree;
  const auto wave = [&](double t) { return regular_wave(t, 10, 1, from); };
  const DirectionalSea sea = analysed(wave, presenter, 300);
  EXPECT_LT(off_deg(sea.mean_direction_rad, from), 0.05);
  for (const DirectionalBand& band : sea.bands)
    if (std::abs(band.frequency_Hz - 0.1) < 0.01) {
      EXPECT_LT(off_deg(band.direction_from_rad(), from), 0.2);
      EXPECT_LT(off_deg(0.5 * std::atan2(band.b2, band.a2), from - std::numbers::pi), 0.2);
    }
}

TEST(DirectionalAnalysis, DoesNotCareHowTheLevelFrameTurns) {
  const auto wave = [](double t) { return regular_wave(t, 6, 1, 1.0); };
  for (const double rate_degps : {-0.5, 0.0, 0.5}) {
    Presenter presenter;
    presenter.frame_rate_radps = rate_degps * kDegree;
    EXPECT_LT(off_deg(analysed(wave, presenter, 400).mean_direction_rad, 1.0), 0.1);
  }
}

// What a record of that length really holds, closed form: components nearer than 1 / T to each other do not
// separate in it, so its direction departs from that of the endless sea. Means over [0, T] of heave and the
// quarter-period advanced north and east motion, term by term.
struct RecordTruth {
  double direction_from_rad, spread_rad;
};
RecordTruth truth_of_record(const std::vector<motion::WaveComponent>& components, double duration_s) {
  double zz = 0, hh = 0, zn = 0, ze = 0;
  for (const auto& i : components)
    for (const auto& j : components) {
      const double x = 0.5 * (i.w_radps - j.w_radps) * duration_s;
      const double sinc = std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
      const double product =
          0.5 * i.amplitude_m * j.amplitude_m * sinc * std::cos(x + i.phase_rad - j.phase_rad);
      zz += product;
      hh += product * std::cos(i.towards_rad - j.towards_rad);
      zn -= product * std::cos(j.towards_rad);
      ze -= product * std::sin(j.towards_rad);
    }
  return {std::atan2(ze, zn), std::sqrt(2 * (1 - std::hypot(zn, ze) / std::sqrt(zz * hh)))};
}

struct ShortCrested {
  double spreading_s, tp_s, hm0_m;
};

// cos^2s seas over 20 minutes, with the noise of a low-cost accelerometer and magnetometer.
TEST(DirectionalAnalysis, MeasuresShortCrestedSeasWithinOneDegreeAndTheirSpreadWithinTwo) {
  double square = 0;
  int seas = 0;
  for (const ShortCrested& of :
       {ShortCrested{10, 8, 1.5}, ShortCrested{4, 6, 1.0}, ShortCrested{25, 12, 2.5}}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed, ++seas) {
      motion::SeaSettings settings;
      settings.hm0_m = of.hm0_m;
      settings.tp_s = of.tp_s;
      settings.spreading_s = of.spreading_s;
      settings.direction_from_rad = (40 + 83 * static_cast<double>(seed)) * kDegree;
      settings.seed = seed;
      motion::SeaMotion motion(motion::draw_components(settings), {});
      Presenter presenter;
      presenter.accel_noise_mps2 = 350e-6 * kStandardGravity * std::sqrt(10);  // at 20 Hz
      presenter.field_noise = 0.005;
      const DirectionalSea sea =
          analysed([&](double t) { return motion.at(std::llround(t * 1e6)); }, presenter, 1200, {}, 20);
      const RecordTruth truth = truth_of_record(motion.components(), 1200);
      const motion::SeaMoments endless = motion::moments_of(motion.components());
      EXPECT_LT(off_deg(sea.mean_direction_rad, truth.direction_from_rad), 1)
          << of.tp_s << " s, seed " << seed;
      EXPECT_LT(std::abs(sea.spread_rad - truth.spread_rad), 2 * kDegree) << of.tp_s << " s, seed " << seed;
      EXPECT_LT(std::abs(sea.spread_rad - endless.spread_rad), 2 * kDegree) << of.tp_s << " s, seed " << seed;
      EXPECT_NEAR(sea.check_factor, 1, 0.04);
      square += std::pow(off_deg(sea.mean_direction_rad, endless.mean_direction_from_rad), 2);
      std::printf(
          "s %2.0f Tp %2.0f s seed %d: direction %6.2f, record %6.2f, sea %6.2f; spread %5.2f, %5.2f, "
          "%5.2f\n",
          of.spreading_s, of.tp_s, static_cast<int>(seed), sea.mean_direction_rad / kDegree,
          std::remainder(truth.direction_from_rad / kDegree, 360), endless.mean_direction_from_rad / kDegree,
          sea.spread_rad / kDegree, truth.spread_rad / kDegree, endless.spread_rad / kDegree);
    }
  }
  EXPECT_LT(std::sqrt(square / seas), 1);  // against the endless sea: mostly what 20 minutes cannot know
}

TEST(DirectionalAnalysis, OfAnUncalibratedCompassErrsAsTheBudgetSays) {
  const CompassKnowledge knowledge{.hard_iron_sigma = 0.05, .soft_iron_sigma = 0.03};
  const DirectionBudget budget = direction_budget(knowledge, kDip);
  RandomStream random(3, "irons");
  double square = 0;
  const int units = 150;
  for (int unit = 0; unit < units; ++unit) {
    Presenter presenter;
    for (int i = 0; i < 3; ++i) presenter.hard_iron[i] = random.gaussian(knowledge.hard_iron_sigma);
    for (int i = 0; i < 9; ++i)
      presenter.soft_iron(i / 3, i % 3) += random.gaussian(knowledge.soft_iron_sigma);
    const double from = random.uniform(0, 6.28), body_heading = random.uniform(0, 6.28);
    const DirectionalSea sea = analysed(
        [&](double t) {
          BodyMotion motion = regular_wave(t, 8, 1, from);
          motion.q_NB = quaternion_of({0, 0, body_heading});
          return motion;
        },
        presenter, 110, {}, 10);
    square += std::pow(off_deg(sea.mean_direction_rad, from) * kDegree, 2);
  }
  const double rms = std::sqrt(square / units);
  EXPECT_NEAR(rms, budget.total_rad(), 0.2 * budget.total_rad());  // 150 units: 6 % standard deviation
  EXPECT_GT(budget.total_rad(), 5 * kDegree);
}

TEST(DirectionalAnalysis, OfACalibratedCompassDoesNot) {
  Presenter presenter;
  presenter.soft_iron << 1.1, 0.05, 0.02, 0.05, 0.95, -0.03, 0.02, -0.03, 1.02;
  presenter.hard_iron = {0.2, -0.3, 0.1};
  const MagneticCalibration calibration{presenter.soft_iron.inverse(), presenter.hard_iron};
  const auto wave = [](double t) { return regular_wave(t, 8, 1, 2.0); };
  EXPECT_GT(off_deg(analysed(wave, presenter, 200).mean_direction_rad, 2.0), 5);
  const DirectionalSea sea = analysed(wave, presenter, 200, {.compass = {.calibration = calibration}});
  EXPECT_LT(off_deg(sea.mean_direction_rad, 2.0), 0.1);
  EXPECT_LT(sea.field_norm_std, 1e-3);
}

TEST(DirectionalAnalysis, CheckFactorIsHorizontalOverVertical) {
  const DirectionalSea sea = analysed(
      [](double t) {
        BodyMotion motion = regular_wave(t, 10, 1, 0.5);
        motion.acceleration_N.head<2>() *= 1.3;  // shallow water, or a heave that reads low
        return motion;
      },
      Presenter{}, 300);
  EXPECT_NEAR(sea.check_factor, 1.3, 2e-3);
}

TEST(DirectionalAnalysis, KnowsNothingWithoutAMagnetometer) {
  DirectionalAnalysis analysis({});
  Presenter presenter;
  for (int i = 0; i < 4000; ++i) {
    LevelSample sample = presenter(regular_wave(0.05 * i, 8, 1, 1));
    sample.has_field = false;
    analysis.add(sample);
  }
  const DirectionalSea sea = analysis.finish();
  EXPECT_EQ(sea.segments, 0);
  SeaState state;
  sea.fill(state);
  EXPECT_TRUE(std::isnan(state.mean_direction_rad));
}

TEST(DirectionalAnalysis, LeavesOutSegmentsWithAGapAndBeginsAnewAfterFinish) {
  DirectionalAnalysis analysis({});
  Presenter presenter;
  const auto feed = [&](double from_s, double to_s, double direction) {
    for (double t = from_s; t < to_s; t += 0.05) analysis.add(presenter(regular_wave(t, 8, 1, direction)));
  };
  feed(0, 205, 1.0);
  feed(225, 430, 1.0);
  const DirectionalSea sea = analysis.finish();
  EXPECT_GT(sea.dropped_segments, 0);
  EXPECT_GT(sea.segments, 2);
  EXPECT_LT(off_deg(sea.mean_direction_rad, 1.0), 0.3);
  feed(430, 640, 4.0);
  EXPECT_LT(off_deg(analysis.finish().mean_direction_rad, 4.0), 0.1);
  EXPECT_EQ(analysis.finish().segments, 0);
}

TEST(DirectionalAnalysis, AnalysesAShortRecordInOnePiece) {
  const DirectionalSea sea = analysed([](double t) { return regular_wave(t, 4, 1, 3.0); }, Presenter{}, 45);
  EXPECT_EQ(sea.segments, 1);
  EXPECT_LT(off_deg(sea.mean_direction_rad, 3.0), 0.3);
  EXPECT_EQ(analysed([](double t) { return regular_wave(t, 4, 1, 3.0); }, Presenter{}, 10).segments, 0);
}

TEST(DirectionalAnalysis, DropsACompassThatDoesNotAgreeWithItself) {
  Presenter presenter;
  presenter.field_noise = 5;  // ten times the horizontal field
  const DirectionalSea sea =
      analysed([](double t) { return regular_wave(t, 8, 1, 1); }, presenter, 210, {}, 5);
  EXPECT_EQ(sea.segments, 0);
  EXPECT_GT(sea.dropped_segments, 0);
}

TEST(DirectionalAnalysis, RefusesSettingsThatLeaveNoBand) {
  EXPECT_THROW(DirectionalAnalysis({.lowest_Hz = 1, .highest_Hz = 0.5}), UserError);
  EXPECT_THROW(DirectionalAnalysis({.bin_s = 1}), UserError);
}

TEST(DirectionBudget, AddsItsContributions) {
  const DirectionBudget budget = direction_budget({0.03, 0.04, 0, 0, 0}, 0);
  EXPECT_NEAR(budget.total_rad(), 0.05, 1e-12);
  EXPECT_NEAR(direction_budget({0, 0, 0.01, 0, 0}, 45 * kDegree).total_rad(), 0.01, 1e-12);
  EXPECT_NEAR(direction_budget({0.01, 0, 0, 0, 0}, 60 * kDegree).total_rad(), 0.02, 1e-12);
  EXPECT_NEAR(direction_budget({0, 0, 0, 0.03, 0.04}, 60 * kDegree).total_rad(), 0.05, 1e-12);
}


// Bins of a fifth of a second hold no whole number of samples then, or stamps that fall on either side of an edge.
TEST(DirectionalAnalysis, TellsTheSameSpreadAtAnyRateOfSamples) {
  motion::SeaSettings settings;
  settings.tp_s = 7;
  settings.hm0_m = 2;
  settings.direction_from_rad = 1;
  settings.spreading_s = 0;
  motion::FloatSettings level;
  level.slope_following = 0;
  motion::SeaMotion sea(motion::draw_components(settings), level);
  for (const double rate_Hz : {8.0, 10.0, 12.5, 16.0, 25.6, 50.0}) {
    const auto at = [&](double t) { return sea.at(std::llround(t * 1e6)); };
    const DirectionalSea found = analysed(at, Presenter{.accel_noise_mps2 = 0.005}, 600, {}, rate_Hz);
    EXPECT_LT(found.spread_rad, 2 * kDegree) << rate_Hz << " Hz";
    EXPECT_LT(off_deg(found.mean_direction_rad, 1), 1) << rate_Hz << " Hz";
  }
}


// Short waves that leak from a window's ends count as long ones do by their period to the fourth power.
TEST(DirectionalAnalysis, OfARegularWaveHasNoSpreadHoweverLongTheRecord) {
  for (const double period_s : {2.0, 4.0, 7.0})
    for (const double duration_s : {60.0, 100.0, 119.8, 120.0, 120.2, 150.0, 300.0}) {
      const DirectionalSea sea =
          analysed([&](double t) { return regular_wave(t, period_s, 0.3, 1); }, Presenter{}, duration_s);
      EXPECT_LT(sea.spread_rad, kDegree) << period_s << " s, " << duration_s << " s";
      EXPECT_LT(off_deg(sea.mean_direction_rad, 1), 0.5) << period_s << " s, " << duration_s << " s";
    }
}

}  // namespace
}  // namespace waverig::estimator
