#include "rig/frontend/simulated_unit.h"

#include <gtest/gtest.h>

#include "estimator/calibration/allan.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "rig/acquisition/acquisition.h"
#include "rig/mechanism/rotating_arm.h"
#include "rig/mechanism/static_pose.h"

namespace waverig::rig {
namespace {

constexpr double kStep = 2e-3, kG = kStandardGravity;
constexpr std::int64_t kStep_us = 2000, kBegin = 1'700'000'000'000'000;

struct Recording {
  std::vector<std::uint8_t> bytes;
  std::vector<UnitCounts> counts;
  std::vector<estimator::ImuSample> samples;
};

// motion(t) for duration_s, as the acquisition reads it by nominal sensitivities.
template <class Motion>
Recording record(const UnitSettings& settings, const UnitParameters& parameters, double duration_s,
                 Motion&& motion, std::uint64_t noise_seed = 1) {
  SimulatedUnit unit(settings, parameters, noise_seed);
  Acquisition acquisition(nominal_sensitivities(settings));
  Recording r;
  const auto at = [&](std::int64_t k) {
    BodyMotion m = motion(static_cast<double>(k) * kStep);
    m.utime = kBegin + k * kStep_us;
    return m;
  };
  unit.step(at(0), 0, r.bytes);
  for (std::int64_t k = 1; static_cast<double>(k) * kStep < duration_s + 0.5 * kStep; ++k)
    unit.step(at(k), kStep, r.bytes);
  acquisition.add(r.bytes, [&](const UnitCounts& c, const estimator::ImuSample& s) {
    r.counts.push_back(c);
    r.samples.push_back(s);
  });
  return r;
}

BodyMotion at_rest(double) { return pose_motion(kSixPositions[4], Vector3d::Zero(), 0); }

BodyMotion level(double) { return {}; }

Vector3d mean_force(const Recording& r) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& s : r.samples) sum += s.f_B;
  return sum / static_cast<double>(r.samples.size());
}

const double kQuantum_mps =
    ideal_unit().front_end.quantum_C / nominal_sensitivities(ideal_unit()).current_per_accel_ApMps2;

TEST(SimulatedUnit, FeelsMinusGravityAtRestAndLevel) {
  const Recording r = record(ideal_unit(), draw_unit(ideal_unit(), 1), 10, level);
  ASSERT_EQ(r.samples.size(), 1000U);
  EXPECT_LT((mean_force(r) - Vector3d(0, 0, -kG)).norm(), kQuantum_mps / 10 * 1.01);
  EXPECT_EQ(r.samples[5].w_NB_B, Vector3d::Zero());
  EXPECT_NEAR(mean_force(record(ideal_unit(), draw_unit(ideal_unit(), 1), 10, at_rest)).z(), kG,
              kQuantum_mps / 10 * 1.01);
}

TEST(SimulatedUnit, FeelsNothingInFreeFall) {
  const Recording r = record(ideal_unit(), draw_unit(ideal_unit(), 1), 1, [](double t) {
    BodyMotion m;
    m.acceleration_N = {0, 0, kG};
    m.velocity_N = {0, 0, kG * t};
    m.q_NB = quaternion_of({0.4, -0.3, 2});
    return m;
  });
  for (const auto& s : r.samples) EXPECT_LT(s.f_B.cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SimulatedUnit, StampsTheMiddleOfEachInterval) {
  const Recording r = record(ideal_unit(), draw_unit(ideal_unit(), 1), 1, level);
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    EXPECT_EQ(r.samples[k].utime, kBegin + 5000 + static_cast<std::int64_t>(k) * 10000);
    EXPECT_EQ(r.samples[k].seq, static_cast<std::int64_t>(k));
  }
}

TEST(SimulatedUnit, IsAsWarmAsItWasPoweredUpLongAgo) {
  UnitSettings settings = ideal_unit();
  settings.temperature = {.mean_degC = 20, .warm_up_degC = 5, .warm_up_time_s = 100};
  settings.power_up_utime = kBegin - 100'000'000;
  const Recording r = record(settings, draw_unit(settings, 1), 0.1, level);
  ASSERT_FALSE(r.samples.empty());
  EXPECT_NEAR(r.samples.front().temperature_degC, 20 + 5 * (1 - std::exp(-1.0)), 0.01);
}

TEST(SimulatedUnit, CountsConserveTheIntegralOfSpecificForce) {
  const auto motion = [](double t) {
    BodyMotion m;
    m.acceleration_N = {3 * std::sin(2 * t), 2 * std::cos(5 * t), 1.5 * std::sin(9 * t)};
    return m;
  };
  const Recording r = record(ideal_unit(), draw_unit(ideal_unit(), 1), 20, motion);
  Vector3d velocity = Vector3d::Zero();
  for (std::size_t k = 0; k < r.samples.size(); ++k) {
    velocity += r.samples[k].f_B * 0.01;
    const double t = 0.01 * static_cast<double>(k + 1);
    const Vector3d exact(1.5 * (1 - std::cos(2 * t)), 0.4 * std::sin(5 * t),
                         (1 - std::cos(9 * t)) / 6 - kG * t);
    // One quantum, and the trapezoidal rule's error over the base step.
    EXPECT_LT((velocity - exact).cwiseAbs().maxCoeff(), kQuantum_mps + 2e-5);
  }
}

TEST(SimulatedUnit, SamplesTheGyroscopeInTheMiddleOfTheInterval) {
  const Recording r = record(ideal_unit(), draw_unit(ideal_unit(), 1), 2, [](double t) {
    BodyMotion m;
    m.w_NB_B = {t, 0, 0};
    return m;
  });
  for (const auto& s : r.samples)
    EXPECT_NEAR(s.w_NB_B.x(), static_cast<double>(s.utime - kBegin) * 1e-6, 0.51 * fxas21000().lsb_radps);
}

TEST(SimulatedUnit, NoiseThroughTheWholePathHasTheDensityItStates) {
  UnitSettings s = ideal_unit();
  s.accelerometer.noise_density_mps2 = 350e-6 * kG;
  SimulatedUnit stated(s, draw_unit(s, 1), 1);
  EXPECT_EQ(stated.accel_noise_density_mps2(), 350e-6 * kG);
  const Recording r = record(s, draw_unit(s, 1), 1200, level);
  double square = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> f;
    for (const auto& sample : r.samples) f.push_back(sample.f_B[axis]);
    // Up to a few samples the converter's remainder, which hangs on the noise itself, moves the deviation.
    auto points = estimator::allan_deviation(f, 0.01);
    std::erase_if(points, [](const estimator::AllanPoint& p) { return p.tau_s < 0.3; });
    square += std::pow(estimator::fit_allan(points).one_sided_density(), 2) / 3;
  }
  EXPECT_NEAR(std::sqrt(square) / stated.accel_noise_density_mps2(), 1, 0.025);
}

TEST(SimulatedUnit, ClockErrorChangesTheIntervalAndNotTheStamps) {
  UnitSettings s = ideal_unit();
  s.front_end.master_clock_error = 1e-2;  // fast: short intervals
  const Recording r = record(s, draw_unit(s, 1), 100, level);
  EXPECT_NEAR(static_cast<double>(r.samples.size()), 10100, 1);
  EXPECT_EQ(r.samples[1000].utime - r.samples[0].utime, 10'000'000);
  EXPECT_NEAR(mean_force(r).z(), -kG / 1.01, 1e-4);  // fewer counts in an interval
}

TEST(SimulatedUnit, FlagsWhatIsBeyondItsRange) {
  UnitSettings s = ideal_unit();
  s.accelerometer.range_mps2 = 4 * kG;
  s.gyroscope.largest_count = 8191;
  const auto pulled = [](double a) {
    return [a](double) {
      BodyMotion m;
      m.acceleration_N = {0, 0, kG - a};
      return m;
    };
  };
  const auto flagged = [&](const auto& motion) {
    return (record(s, draw_unit(s, 1), 0.1, motion).samples[5].flags & flag::kSaturation) != 0;
  };
  EXPECT_FALSE(flagged(pulled(3.5 * kG)));
  EXPECT_TRUE(flagged(pulled(4.5 * kG)));
  EXPECT_TRUE(flagged([](double) {
    BodyMotion m;
    m.w_NB_B = {0, 300 * kDegree, 0};
    return m;
  }));
  s.accelerometer.range_mps2 = 0;  // an unlimited sensor drives the converter beyond its own range
  EXPECT_TRUE(flagged(pulled(6 * kG)));
}

TEST(SimulatedUnit, IsTheSameForTheSameSeedsToTheByte) {
  const UnitSettings s = datasheet_unit();
  RotatingArm arm({}, 0.5);
  const auto run = [&](std::uint64_t unit_seed, std::uint64_t noise_seed) {
    RotatingArm fresh({}, 0.5);
    return record(
               s, draw_unit(s, unit_seed), 5,
               [&](double t) {
                 return fresh.advance({t, 1, 0}, kStep, 0);
               },
               noise_seed)
        .bytes;
  };
  EXPECT_EQ(run(1, 2), run(1, 2));
  EXPECT_NE(run(1, 2), run(1, 3));
  EXPECT_NE(run(1, 2), run(2, 2));
}

UnitSettings with_magnetometer() {
  UnitSettings settings = ideal_unit();
  settings.magnetometer = MagnetometerSettings{};
  settings.magnetometer->lsb_uT = 0.1;
  settings.magnetometer->earth = {.total_uT = 50, .dip_rad = 30 * kDegree, .declination_rad = 90 * kDegree};
  return settings;
}

TEST(SimulatedUnit, CarriesAMagnetometerWhereOneIsChosen) {
  const UnitSettings settings = with_magnetometer();
  const auto samples = record(settings, draw_unit(settings, 1), 0.1, level).samples;
  ASSERT_GT(samples.size(), 5u);
  for (const estimator::ImuSample& s : samples) {
    EXPECT_EQ(s.flags & flag::kNoMagnetometer, 0);
    EXPECT_LT((s.m_B_uT - Vector3d(0, 50 * std::cos(30 * kDegree), 25)).cwiseAbs().maxCoeff(), 0.051);
  }
  const auto without = record(ideal_unit(), draw_unit(ideal_unit(), 1), 0.1, level).samples;
  EXPECT_NE(without[0].flags & flag::kNoMagnetometer, 0);
  EXPECT_TRUE(without[0].m_B_uT.isZero(0));
}

TEST(SimulatedUnit, SaysThereIsNoFieldWhereTheMagnetometerIsBeyondItsRange) {
  UnitSettings settings = with_magnetometer();
  settings.magnetometer->largest_count = 200;  // 20 uT
  const auto samples = record(settings, draw_unit(settings, 1), 0.1, level).samples;
  EXPECT_NE(samples[0].flags & flag::kNoMagnetometer, 0);
  EXPECT_EQ(samples[0].m_B_uT, Vector3d::Zero());
}

TEST(SimulatedUnit, SaysTheSameOfItsOtherSensorsWithAMagnetometerAndWithout) {
  UnitSettings without = datasheet_unit(), with = datasheet_unit();
  with.magnetometer = mag3110();
  const auto a = record(without, draw_unit(without, 3), 0.2, level).samples;
  const auto b = record(with, draw_unit(with, 3), 0.2, level).samples;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].f_B, b[i].f_B);
    EXPECT_EQ(a[i].w_NB_B, b[i].w_NB_B);
  }
}

TEST(SimulatedUnit, AgeMovesAUnitAsFarAsStated) {
  const UnitSettings s = datasheet_unit();
  const UnitParameters young = draw_unit(s, 1);
  const AgeingSettings ageing;
  double bias = 0, scale = 0, gyro = 0;
  constexpr int kUnits = 2000;
  for (std::uint64_t seed = 0; seed < kUnits; ++seed) {
    const UnitParameters old = aged(young, ageing, seed);
    bias += (old.accelerometer.bias_mps2 - young.accelerometer.bias_mps2).squaredNorm() / (3 * kUnits);
    scale += (old.accelerometer.M - young.accelerometer.M).squaredNorm() / (9 * kUnits);
    gyro += (old.gyroscope.offset_radps - young.gyroscope.offset_radps).squaredNorm() / (3 * kUnits);
  }
  EXPECT_NEAR(std::sqrt(bias) / (0.4e-3 * kG), 1, 0.04);
  EXPECT_NEAR(std::sqrt(scale) / 1e-3, 1, 0.04);
  EXPECT_NEAR(std::sqrt(gyro) / (0.2 * kDegree), 1, 0.04);
}

TEST(SimulatedUnit, RefusesAnIntervalThatIsNone) {
  UnitSettings s = ideal_unit();
  s.sample_interval_s = 0;
  EXPECT_THROW(SimulatedUnit(s, draw_unit(s, 1), 1), UserError);
}

}  // namespace
}  // namespace waverig::rig
