// Against real recordings: a low-cost unit moved by hand, and an optical truth the methods never see.
#include <gtest/gtest.h>

#include "estimator/calibration/accelerometer_calibration.h"
#include "estimator/calibration/rotation_fit.h"
#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/sample_csv.h"
#include "estimator/method.h"
#include "tests/estimator/collector.h"
#include "tests/estimator/sea_record.h"
#include "tests/evaluation/recordings.h"

namespace waverig::testing {
namespace {

std::vector<estimator::ImuSample> read_samples(const std::filesystem::path& path) {
  evaluation::SampleCsvReader reader(path);
  std::vector<estimator::ImuSample> samples;
  for (estimator::ImuSample s; reader.next(s);) samples.push_back(s);
  return samples;
}

// Butterworth of second order, forward and backward.
void high_pass(std::vector<double>& x, double corner_hz, double dt_s) {
  const double k = std::tan(kPi * corner_hz * dt_s), norm = 1 / (1 + std::sqrt(2.0) * k + k * k);
  for (int pass = 0; pass < 2; ++pass) {
    double x1 = x[0], x2 = x[0], y1 = 0, y2 = 0;
    for (double& value : x) {
      const double y = norm * (value - 2 * x1 + x2 - 2 * (k * k - 1) * y1 - (1 - std::sqrt(2.0) * k + k * k) * y2);
      x2 = std::exchange(x1, value);
      y2 = std::exchange(y1, y);
      value = y;
    }
    std::reverse(x.begin(), x.end());
  }
}

// RMS error in the moving part over 4 std of the truth there, both high-passed at 0.12 Hz.
double moving_rms(std::string_view method_name, const std::vector<estimator::ImuSample>& samples,
                  const evaluation::HeaveSeries& truth) {
  const auto method = estimator::make_method(method_name, {});
  const Collector out = run(*method, samples);
  EXPECT_EQ(out.heaves.size(), truth.heave_m.size());
  std::vector<double> t = truth.heave_m, e;
  double last = 0;
  for (double& z : t) last = z = std::isfinite(z) ? z : last;   // the cameras lost it for some hundredths of a second
  for (const auto& h : out.heaves) e.push_back(h.heave_m);
  high_pass(t, 0.12, 0.0035);
  high_pass(e, 0.12, 0.0035);
  double error = 0, signal = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!truth.moving[i]) continue;
    error += square(e[i] - t[i]);
    signal += square(t[i]);
  }
  return std::sqrt(error / signal) / 4;
}

TEST(RealData, HandMovedBoardComesOutAsTheCamerasSawIt) {
  const auto imu = recordings() / "broad10_translation.csv.gz", seen = recordings() / "broad10_translation.truth.csv.gz";
  WAVERIG_NEEDS_RECORDING(imu);
  const auto samples = read_samples(imu);
  const auto truth = evaluation::read_heave_csv(seen);
  EXPECT_LT(moving_rms("smoothed", samples, truth), 0.008);
  EXPECT_LT(moving_rms("realtime", samples, truth), 0.03);
}

// The rest before the motion is 37 s long; less of it must do.
TEST(RealData, RealtimeFollowsTheMotionHoweverShortTheRestBefore) {
  const auto imu = recordings() / "broad10_translation.csv.gz";
  WAVERIG_NEEDS_RECORDING(imu);
  const auto all = read_samples(imu);
  const auto seen = evaluation::read_heave_csv(recordings() / "broad10_translation.truth.csv.gz");
  for (const double left_out_s : {4.0, 10.0, 16.0, 20.0}) {
    std::ptrdiff_t first = 0;
    while (static_cast<double>(all[static_cast<std::size_t>(first)].utime - all[0].utime) * kMicrosecond < left_out_s)
      ++first;
    evaluation::HeaveSeries truth = seen;
    truth.heave_m.erase(truth.heave_m.begin(), truth.heave_m.begin() + first);
    truth.moving.erase(truth.moving.begin(), truth.moving.begin() + first);
    EXPECT_LT(moving_rms("realtime", {all.begin() + first, all.end()}, truth), 0.03) << left_out_s << " s left out";
  }
}

TEST(RealData, ARotationRecordingCalibratesIt) {
  const auto rotation = recordings() / "broad01_rotation.csv.gz", imu = recordings() / "broad10_translation.csv.gz";
  WAVERIG_NEEDS_RECORDING(rotation);
  const auto fit = estimator::fit_rotation(read_samples(rotation), kStandardGravity);
  const estimator::AccelerometerCorrection correct(fit.calibration);
  auto samples = read_samples(imu);
  for (auto& sample : samples) sample.f_B = correct(sample.f_B);
  const auto truth = evaluation::read_heave_csv(recordings() / "broad10_translation.truth.csv.gz");
  EXPECT_LT(moving_rms("smoothed", samples, truth), 0.008);
  EXPECT_LT(moving_rms("realtime", samples, truth), 0.03);
}

}  // namespace
}  // namespace waverig::testing
