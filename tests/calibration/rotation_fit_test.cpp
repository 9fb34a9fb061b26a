#include "estimator/calibration/rotation_fit.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <Eigen/LU>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kG = 9.81;

// A symmetric M, since a rotation record cannot see the rest.
AccelerometerCalibration some_unit() {
  AccelerometerCalibration c;
  c.M << 1.012, 0.004, -0.003, 0.004, 0.991, 0.006, -0.003, 0.006, 1.005;
  c.b_mps2 << 0.2, -0.35, 0.15;
  return c;
}

// Turned by hand: slow turns about wandering axes, and the hand's own acceleration.
std::vector<ImuSample> turned_by_hand(double duration_s, double hand_mps2, double noise_mps2,
                                      const Vector3d& gyro_offset, std::uint64_t seed) {
  RandomStream random(seed, "hand");
  const AccelerometerCalibration unit = some_unit();
  constexpr double kStep = 0.01;
  std::vector<ImuSample> samples;
  Quaterniond q = Quaterniond::Identity();
  Vector3d a_phase(random.uniform(0, 6), random.uniform(0, 6), random.uniform(0, 6));
  for (int k = 0; k * kStep < duration_s; ++k) {
    const double t = k * kStep;
    const bool rest = t < 10;
    const Vector3d w =
        rest ? Vector3d(Vector3d::Zero())
             : Vector3d(0.8 * std::sin(0.13 * t), 0.7 * std::cos(0.21 * t), 0.6 * std::sin(0.34 * t + 1));
    const Vector3d a_N = rest ? Vector3d(Vector3d::Zero())
                              : Vector3d(hand_mps2 * std::sin(2.1 * t + a_phase.x()),
                                         hand_mps2 * std::sin(3.3 * t + a_phase.y()),
                                         hand_mps2 * std::sin(4.7 * t + a_phase.z()));
    const Vector3d f = q.conjugate() * (a_N - Vector3d(0, 0, kG));
    ImuSample s;
    s.utime = 1000000 + static_cast<std::int64_t>(k) * 10000;
    const auto noise = [&](double sigma) {
      return Vector3d(random.gaussian(sigma), random.gaussian(sigma), random.gaussian(sigma));
    };
    s.f_B = unit.M * f + unit.b_mps2 + noise(noise_mps2);
    s.w_NB_B = w + gyro_offset + noise(1e-3);
    samples.push_back(s);
    q = (q * quaternion_exp(w * kStep)).normalized();
  }
  return samples;
}

TEST(RotationFit, RecoversTheUnitFromACleanRecord) {
  const RotationFit fit = fit_rotation(turned_by_hand(200, 0, 0, Vector3d::Zero(), 1), kG);
  // The record is integrated by samples: what is left is the gyroscope's trapezoidal error.
  EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_LT((fit.calibration.b_mps2 - some_unit().b_mps2).norm(), 1e-3);
  EXPECT_GT(fit.coverage, 0.3);
}

// Six degrees a second, seen in the ten seconds of rest, would turn each window's frame by as much.
TEST(RotationFit, TakesTheGyroscopesZeroOff) {
  const Vector3d offset_radps(0.1, -0.1, 0.05);
  const RotationFit fit = fit_rotation(turned_by_hand(200, 0, 0, offset_radps, 1), kG);
  EXPECT_LT((fit.gyroscope.offset_radps - offset_radps).norm(), 2e-4);
  EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 2e-4);
  EXPECT_LT((fit.calibration.b_mps2 - some_unit().b_mps2).norm(), 2e-3);
}

TEST(RotationFit, RecoversTheUnitWithinItsUncertaintyDespiteTheHand) {
  double chi = 0;
  constexpr int kRuns = 12;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const RotationFit fit = fit_rotation(turned_by_hand(200, 0.3, 0.03, {0.01, -0.02, 0.005}, seed), kG);
    EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 4e-3);
    EXPECT_LT((fit.calibration.b_mps2 - some_unit().b_mps2).cwiseAbs().maxCoeff(), 0.03);
    EXPECT_LT(fit.residual_rms_mps2, 0.2 * fit.residual_before_mps2);
    EXPECT_NEAR(fit.gyroscope.offset_radps.y(), -0.02, 2e-4);
    const Vector3d error = fit.calibration.b_mps2 - some_unit().b_mps2;
    chi += error.cwiseQuotient(fit.calibration.sigma_b_mps2()).squaredNorm() / (3.0 * kRuns);
  }
  EXPECT_LT(chi, 3);
}

// White noise of the accelerometer alone: squared error over stated variance. Neighbours share half their samples,
// so that two are counted as one; counted as independent it would be twice as much. It is below one, since a turning
// unit shows neighbours different sides of the unknowns.
TEST(RotationFit, ItsUncertaintyIsThatOfOverlappingWindows) {
  double chi = 0;
  constexpr int kRuns = 40, kUnknowns = 9;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const AccelerometerCalibration found =
        fit_rotation(turned_by_hand(200, 0, 0.3, Vector3d::Zero(), seed), kG).calibration;
    const Matrix3d dM = found.M - some_unit().M;
    const Vector3d db = found.b_mps2 - some_unit().b_mps2;
    for (int i = 0; i < 3; ++i) {
      chi += db[i] * db[i] / found.covariance(9 + i, 9 + i);
      for (int j = i; j < 3; ++j) chi += dM(i, j) * dM(i, j) / found.covariance(3 * i + j, 3 * i + j);
    }
  }
  chi /= kRuns * kUnknowns;
  EXPECT_GT(chi, 0.55);
  EXPECT_LT(chi, 0.95);
}

TEST(RotationFit, AFewKnocksHardlyBendIt) {
  auto samples = turned_by_hand(200, 0, 0, Vector3d::Zero(), 1);
  for (std::size_t begin = 2000; begin < samples.size(); begin += 3000)
    for (std::size_t i = begin; i < begin + 100; ++i) samples[i].f_B += Vector3d(4, 3, 0);
  const RotationFit fit = fit_rotation(samples, kG);
  EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT((fit.calibration.b_mps2 - some_unit().b_mps2).norm(), 0.02);
}

TEST(RotationFit, RefusesARecordThatWasNotTurned) {
  auto samples = turned_by_hand(200, 0, 0.01, Vector3d::Zero(), 1);
  for (auto& s : samples) s.f_B = Vector3d(0, 0, -kG);
  EXPECT_THROW(fit_rotation(samples, kG), UserError);
  EXPECT_THROW(fit_rotation(std::span(samples).first(100), kG), UserError);
}

TEST(RotationFit, LeavesGapsOut) {
  auto samples = turned_by_hand(240, 0, 0, Vector3d::Zero(), 1);
  samples.erase(samples.begin() + 6000, samples.begin() + 9000);
  const RotationFit fit = fit_rotation(samples, kG);
  EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 1e-4);

  // And those shorter than a window, in which the unit turned unseen.
  std::vector<ImuSample> holed;
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (i % 700 < 580) holed.push_back(samples[i]);
  EXPECT_LT((fit_rotation(holed, kG).calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 1e-4);
}

// Ten samples a second, every other one 15 ms late: steps of 85 and 115 ms, of which none is a gap. What is left is
// the gyroscope's trapezoidal error.
TEST(RotationFit, TakesARecordingOfTenSamplesASecondWithJitter) {
  const auto fast = turned_by_hand(300, 0, 0, Vector3d::Zero(), 1);
  std::vector<ImuSample> slow;
  for (std::size_t i = 0; i + 2 < fast.size(); i += 10) {
    slow.push_back(fast[i]);
    if (slow.size() % 2 != 0) continue;
    slow.back().utime += 15'000;
    slow.back().f_B += 1.5 * (fast[i + 1].f_B - fast[i].f_B);
    slow.back().w_NB_B += 1.5 * (fast[i + 1].w_NB_B - fast[i].w_NB_B);
  }
  const RotationFit fit = fit_rotation(slow, kG);
  EXPECT_GT(fit.windows, 140);
  EXPECT_LT((fit.calibration.M - some_unit().M).cwiseAbs().maxCoeff(), 2e-3);
  EXPECT_LT((fit.calibration.b_mps2 - some_unit().b_mps2).norm(), 0.02);
}

std::vector<ImuSample> recording(const std::string& file) {
  const char* set = std::getenv("WAVERIG_DATA");
  const std::filesystem::path folder =
      set != nullptr ? set : std::string(WAVERIG_SOURCE_DIR) + "/../shared/data";
  std::vector<ImuSample> samples;
  gzFile in = gzopen((folder / file).c_str(), "rb");
  if (in == nullptr) return samples;
  char line[512];
  gzgets(in, line, sizeof line);
  while (gzgets(in, line, sizeof line) != nullptr) {
    std::istringstream row(line);
    ImuSample s;
    char comma;
    row >> s.utime;
    for (int i = 0; i < 3; ++i) row >> comma >> s.f_B[i];
    for (int i = 0; i < 3; ++i) row >> comma >> s.w_NB_B[i];
    samples.push_back(s);
  }
  gzclose(in);
  return samples;
}

TEST(RotationFit, MakesTheNormOfARealUnitConstant) {
  const auto samples = recording("broad01_rotation.csv.gz");
  if (samples.empty()) GTEST_SKIP() << "no recordings: set WAVERIG_DATA";
  const RotationFit fit = fit_rotation(samples, 9.81);
  RecordProperty("residual_before_mps2", std::to_string(fit.residual_before_mps2));
  RecordProperty("residual_after_mps2", std::to_string(fit.residual_rms_mps2));
  EXPECT_LT(fit.residual_rms_mps2, 0.02);
  EXPECT_LT(fit.residual_rms_mps2, 0.5 * fit.residual_before_mps2);
  EXPECT_GT(fit.coverage, 0.15);
  EXPECT_LT(fit.calibration.sigma_b_mps2().maxCoeff(), 0.05);
  // Halves of the record agree with each other: the fit finds the unit, not the movement.
  const auto half = samples.size() / 2;
  const RotationFit first = fit_rotation(std::span(samples).first(half), 9.81);
  const RotationFit second = fit_rotation(std::span(samples).subspan(half), 9.81);
  EXPECT_LT((first.calibration.b_mps2 - second.calibration.b_mps2).cwiseAbs().maxCoeff(), 0.08);
  EXPECT_LT((first.calibration.M - second.calibration.M).cwiseAbs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace waverig::estimator
