// The rotating arm as a wave buoy's calibration wheel: the direction of its plane, in four placements.
#include <gtest/gtest.h>

#include "estimator/compass/magnetic_calibration.h"
#include "estimator/method.h"
#include "lcmtypes/flags.h"
#include "motion/kinematics/earth.h"
#include "motion/kinematics/random.h"
#include "rig/mechanism/rotating_arm.h"
#include "rig/sensors/magnetometer.h"

namespace waverig {
namespace {

constexpr double kRate_Hz = 50;
constexpr double kDeclination = -8.5 * kDegree;

// A MAG3110 on its board with the rig's motor near: the unit, and its calibration by turning it through all
// attitudes.
struct Compass {
  rig::MagnetometerSettings settings = rig::mag3110();
  rig::MagnetometerParameters unit;
  estimator::MagneticCalibration calibration;

  explicit Compass(std::uint64_t seed) {
    settings.earth = {.total_uT = 50, .dip_rad = 53 * kDegree, .declination_rad = kDeclination};
    unit = rig::draw_magnetometer(settings, seed);
    unit.soft_iron =
        (0.5 * (unit.soft_iron + unit.soft_iron.transpose())).eval();  // no turn that gravity must find
    rig::Magnetometer magnetometer(settings, unit, seed);
    RandomStream random(seed, "turning");
    std::vector<Vector3d> raw;
    for (int i = 0; i < 1500; ++i) {
      BodyMotion pose;
      pose.utime = i * 20000;
      pose.q_NB = Quaterniond(random.gaussian(), random.gaussian(), random.gaussian(), random.gaussian())
                      .normalized();
      raw.push_back(reading_uT(magnetometer, pose));
    }
    calibration = estimator::ellipsoid_calibration(raw).calibration;
  }
  Vector3d reading_uT(rig::Magnetometer& magnetometer, const BodyMotion& motion) const {
    return magnetometer.sample(motion).cast<double>() * magnetometer_count_uT(settings);
  }
};

// Low-cost sensors after a fresh calibration, riding on the arm.
std::vector<estimator::ImuSample> ride(const Compass& compass, double azimuth_rad, double period_s,
                                       double height_m, double duration_s,
                                       const Vector3d& stator_moment_N_Am2) {
  const LocalEarth earth = local_earth({36 * kDegree, 0, 50});
  rig::RotatingArmSettings settings;
  settings.azimuth_rad = azimuth_rad;
  settings.lever_arm_G_m.setZero();  // at the pivot: the orbit is a circle, whatever the gondola does
  rig::RotatingArm arm(settings, height_m / 2);
  rig::MagnetometerSettings field = compass.settings;
  field.motor = {.hub_N_m = {0.3 * std::sin(azimuth_rad), -0.3 * std::cos(azimuth_rad), -0.1},
                 .azimuth_rad = azimuth_rad,
                 .stator_moment_N_Am2 = stator_moment_N_Am2};
  rig::Magnetometer magnetometer(field, compass.unit, 11);
  RandomStream random(5, "ride");
  const Vector3d accel_bias(2e-3, -2e-3, 2e-3), gyro_bias(0.2 * kDegree, -0.1 * kDegree, 0.15 * kDegree);
  const double accel_sigma = 350e-6 * kStandardGravity * std::sqrt(kRate_Hz / 2);
  const double gyro_sigma = 0.025 * kDegree * std::sqrt(kRate_Hz / 2);
  const auto noise = [&](double sigma) {
    return Vector3d(random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma));
  };
  std::vector<estimator::ImuSample> samples;
  const double rate = 2 * std::numbers::pi / period_s;
  const auto n = static_cast<std::int64_t>(duration_s * kRate_Hz);
  constexpr int kSteps = 4;  // of the mechanism within a sample
  for (std::int64_t i = 0; i < n * kSteps; ++i) {
    const double t = static_cast<double>(i) / (kRate_Hz * kSteps);
    const BodyMotion& motion =
        arm.advance({rate * t, rate, 0}, i == 0 ? 0 : 1 / (kRate_Hz * kSteps), std::llround(t * 1e6));
    if (i % kSteps != 0) continue;
    estimator::ImuSample sample{.utime = motion.utime, .seq = i / kSteps};
    sample.f_B = specific_force_B(motion, earth) + accel_bias + noise(accel_sigma);
    sample.w_NB_B = inertial_rate_B(motion, earth) + gyro_bias + noise(gyro_sigma);
    sample.m_B_uT = compass.reading_uT(magnetometer, motion);
    samples.push_back(sample);
  }
  return samples;
}

class LastSea : public estimator::Output {
 public:
  void sea(const estimator::SeaState& state) override { last = state; }
  estimator::SeaState last;
};

estimator::SeaState told(const estimator::CompassSettings& compass,
                         const std::vector<estimator::ImuSample>& samples) {
  estimator::MethodSettings settings;
  settings.sensor.gravity_mps2 = gravity_mps2({36 * kDegree, 0, 50});
  settings.compass = compass;
  const auto method = estimator::make_method("directional", settings);
  LastSea output;
  for (const auto& sample : samples) method->add(sample, output);
  method->finish(output);
  return output.last;
}

double off_deg(double a_rad, double b_rad) {
  return std::remainder(a_rad - b_rad, 2 * std::numbers::pi) / kDegree;
}

struct Turn {
  double period_s, height_m, largest_check;  // CDIP: 1.05 below 10 s, 1.15 below 15 s, 1.5 above
};

// With a growing angle the arm's tip moves away from the azimuth at the top: its wave comes from the azimuth.
TEST(ArmDirection, IsThePlaneOfTheArmWithinTwoDegreesInFourPlacements) {
  const Compass compass(3);
  const double first_deg = 17;
  for (const Turn& turn :
       {Turn{2, 0.3, 1.05}, Turn{6.25, 1, 1.05}, Turn{12.5, 1, 1.15}, Turn{20, 1.8, 1.5}}) {
    for (int placement = 0; placement < 4; ++placement) {
      const double azimuth = (first_deg + 90 * placement) * kDegree;
      const auto samples = ride(compass, azimuth, turn.period_s, turn.height_m,
                                std::max(120.0, 16 * turn.period_s), {0.1, -0.08, 0.15});
      const estimator::SeaState sea = told({compass.calibration, kDeclination}, samples);
      std::printf("T %5.2f s, arm %3.0f deg: direction %+5.2f deg off, spread %4.1f deg, check factor %.4f\n",
                  turn.period_s, azimuth / kDegree, off_deg(sea.mean_direction_rad, azimuth),
                  sea.spread_rad / kDegree, sea.check_factor);
      EXPECT_LT(std::abs(off_deg(sea.mean_direction_rad, azimuth)), 2) << turn.period_s << " s";
      EXPECT_LT(std::abs(off_deg(sea.peak_direction_rad, azimuth)), 2) << turn.period_s << " s";
      EXPECT_GT(sea.check_factor, 0.99) << turn.period_s << " s";
      EXPECT_LT(sea.check_factor, turn.largest_check) << turn.period_s << " s";
      EXPECT_LT(sea.spread_rad, 6 * kDegree) << turn.period_s << " s";
    }
  }
}

TEST(ArmDirection, WithoutCalibrationErrsByTheIronOfTheBoard) {
  const Compass compass(3);
  const auto samples = ride(compass, 1.0, 6.25, 1, 120, Vector3d::Zero());
  const auto error_deg = [&](const estimator::CompassSettings& settings) {
    return std::abs(off_deg(told(settings, samples).mean_direction_rad, 1.0));
  };
  EXPECT_LT(error_deg({compass.calibration, kDeclination}), 2);
  EXPECT_GT(error_deg({{}, kDeclination}), 5);
  EXPECT_NEAR(error_deg({compass.calibration, 0}), std::abs(kDeclination) / kDegree, 2);
}

TEST(ArmDirection, IsNotToldWithoutAMagnetometer) {
  const Compass compass(3);
  auto samples = ride(compass, 1.0, 6.25, 1, 60, Vector3d::Zero());
  for (auto& sample : samples) sample.flags |= flag::kNoMagnetometer;
  EXPECT_TRUE(std::isnan(told({compass.calibration, kDeclination}, samples).mean_direction_rad));
}


// A reading that never changes is none: it would turn with the body and tell a direction as firmly as a good one.
TEST(ArmDirection, IsNotToldByADeadMagnetometer) {
  const Compass compass(3);
  auto samples = ride(compass, 0.5, 6.25, 1, 120, {0.1, -0.08, 0.15});
  for (const Vector3d& reading_uT : {Vector3d(0, 0, 0), Vector3d(20, -3, 41)}) {
    for (auto& sample : samples) sample.m_B_uT = reading_uT;
    EXPECT_TRUE(std::isnan(told({compass.calibration, kDeclination}, samples).mean_direction_rad));
  }
}

}  // namespace
}  // namespace waverig
