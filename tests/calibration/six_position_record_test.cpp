// The six positions found in a recording that a hand made.
#include "estimator/calibration/six_position_record.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kStep_s = 0.01;

// The unit published in Lee 2014, eqs (14), (15).
AccelerometerCalibration published() {
  AccelerometerCalibration c;
  c.M << 1.0074, -0.0022, 0.0039, -0.0065, 0.9856, 0.0138, -0.0027, 0.0087, 0.9963;
  c.b_mps2 = kStandardGravity * Vector3d(-0.0354, 0.0081, 0.0041);
  return c;
}
const Vector3d kGyroOffset_radps(0.01, -0.02, 0.03);

// Each pose for held_s, with a turn of two seconds before it; the sides miss by fixture_rad.
std::vector<ImuSample> recording(const std::vector<StaticPose>& poses, double held_s, std::uint64_t seed,
                                 double fixture_rad = 0) {
  RandomStream noise(seed, "noise"), fixture(seed, "fixture");
  const AccelerometerCalibration unit = published();
  std::vector<ImuSample> samples;
  Vector3d before(0, 0, -kStandardGravity);
  const auto add = [&](const Vector3d& f_B, const Vector3d& w_B) {
    ImuSample sample;
    sample.utime = static_cast<std::int64_t>(samples.size()) * std::llround(kStep_s / kMicrosecond);
    sample.seq = static_cast<std::int64_t>(samples.size());
    for (int i = 0; i < 3; ++i) {
      sample.f_B[i] = unit.reading(f_B)[i] + 0.02 * noise.gaussian();
      sample.w_NB_B[i] = w_B[i] + kGyroOffset_radps[i] + 0.002 * noise.gaussian();
    }
    sample.temperature_degC = 21;
    samples.push_back(sample);
  };
  for (const StaticPose& pose : poses) {
    const Vector3d miss(fixture.gaussian(fixture_rad), fixture.gaussian(fixture_rad),
                        fixture.gaussian(fixture_rad));
    const Vector3d up = kStandardGravity * pose.sign * Vector3d::Unit(pose.axis);
    const Vector3d f_B = up + up.cross(miss);
    for (double t = 0; t < 2; t += kStep_s) {  // by hand: it shakes and turns unevenly
      const double part = t / 2;
      add((before + part * (f_B - before)) + Vector3d::Constant(0.5 * std::sin(25 * t)),
          Vector3d::Constant(0.6 + 0.4 * std::sin(9 * t)));
    }
    for (double t = 0; t < held_s; t += kStep_s) add(f_B, Vector3d::Zero());
    before = f_B;
  }
  return samples;
}

std::vector<StaticPose> six() { return {kSixPositions.begin(), kSixPositions.end()}; }

std::string complaint(const std::vector<ImuSample>& samples) {
  try {
    fit_six_position_record(samples, kStandardGravity);
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(SixPositionRecord, FindsThePublishedUnitInAnyOrderOfPositions) {
  auto order = six();
  std::swap(order[0], order[5]);
  std::swap(order[1], order[3]);
  const SixPositionRecord record = fit_six_position_record(recording(order, 10, 1), kStandardGravity);
  const AccelerometerCalibration unit = published();
  EXPECT_LT((record.fit.calibration.M - unit.M).cwiseAbs().maxCoeff(), 4e-4);
  EXPECT_LT((record.fit.calibration.b_mps2 - unit.b_mps2).cwiseAbs().maxCoeff(), 4e-3);
  EXPECT_LT((record.gyroscope.offset_radps - kGyroOffset_radps).cwiseAbs().maxCoeff(), 2e-4);
  double seconds = 0;
  for (const double still_s : record.still_s) {
    EXPECT_NEAR(still_s, 10, 1.01);
    seconds += still_s;
  }
  const double of_mean = 0.002 / std::sqrt(seconds / kStep_s);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(record.gyroscope.offset_sigma_radps[i] / of_mean, 1, 0.5);
  EXPECT_NEAR(record.temperature_degC, 21, 1e-9);
}

TEST(SixPositionRecord, StatesAnUncertaintyThatHoldsOverManySeeds) {
  SixPositionRecordSettings settings;
  settings.fixture_sigma_rad = 0.3 * kDegree;
  double chi_square = 0, degrees = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const auto samples = recording(six(), 6, seed, settings.fixture_sigma_rad);
    const auto record = fit_six_position_record(samples, kStandardGravity, settings);
    const CalibrationError error = error_against(record.fit.calibration, published());
    chi_square += error.chi_square;
    degrees += error.degrees_of_freedom;
  }
  // 30 fits of 12 unknowns: the mean of chi-square over its degrees scatters by sqrt(2 / 360) = 0.075.
  EXPECT_NEAR(chi_square / degrees, 1, 0.3);
}

TEST(SixPositionRecord, NamesThePositionThatIsMissing) {
  auto order = six();
  order.erase(order.begin() + 3);
  EXPECT_EQ(complaint(recording(order, 8, 1)),
            "six-position calibration: y down held still for 0 s; expected each position for at least 5 s");
  EXPECT_NE(complaint(recording(six(), 3, 1)).find("x up held still"), std::string::npos);
  EXPECT_NE(complaint({}), "");
}

TEST(SixPositionRecord, TakesNoMeanAcrossAGap) {
  const auto whole = recording(six(), 10, 1);
  auto broken = whole;  // an hour is missing in the middle of the first stretch: 2 s turned, 5.5 s still
  for (std::size_t i = 750; i < broken.size(); ++i) broken[i].utime += 3'600'000'000;
  const SixPositionRecord a = fit_six_position_record(whole, kStandardGravity);
  const SixPositionRecord b = fit_six_position_record(broken, kStandardGravity);
  EXPECT_LT(b.still_s[0], a.still_s[0]);
  EXPECT_GE(b.still_s[0], a.still_s[0] - 2);
  EXPECT_LT((a.fit.calibration.M - b.fit.calibration.M).cwiseAbs().maxCoeff(), 2e-4);
}

// Ten samples a second whose times miss by up to 30 ms: steps of up to 160 ms, of which none is a gap.
TEST(SixPositionRecord, TakesARecordingOfTenSamplesASecondWithJitter) {
  const auto fast = recording(six(), 20, 1);
  std::vector<ImuSample> slow;
  RandomStream jitter(1, "jitter");
  for (std::size_t i = 0; i < fast.size(); i += 10) {
    slow.push_back(fast[i]);
    slow.back().utime += std::llround(jitter.uniform(-0.03, 0.03) / kMicrosecond);
  }
  const SixPositionRecord record = fit_six_position_record(slow, kStandardGravity);
  for (const double still_s : record.still_s) EXPECT_NEAR(still_s, 19, 1.01);
  EXPECT_LT((record.fit.calibration.M - published().M).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((record.fit.calibration.b_mps2 - published().b_mps2).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace waverig::estimator
