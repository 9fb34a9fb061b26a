#include "estimator/evaluation/transfer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waverig::evaluation {
namespace {

constexpr double kRate_Hz = 20;

// A sum of harmonics between 0.03 and 1 Hz, each passed with the gain and lag given for its frequency.
template <class Gain, class Lag>
std::vector<double> heave_with(const Gain& gain, const Lag& lag_s) {
  std::vector<double> heave(24000);
  for (int k = 1; k <= 60; ++k) {
    const double f = 0.03 + 0.0163 * k, w = 2 * std::numbers::pi * f;
    for (std::size_t i = 0; i < heave.size(); ++i)
      heave[i] += gain(f) * std::cos(w * (static_cast<double>(i) / kRate_Hz - lag_s(f)) + 1.7 * k * k);
  }
  return heave;
}

constexpr auto kOne = [](double) { return 1.0; };
constexpr auto kNone = [](double) { return 0.0; };

TEST(Transfer, FindsTheGainAtEachFrequency) {
  const auto truth = heave_with(kOne, kNone), estimate = heave_with([](double f) { return 1.2 - 0.4 * f; }, kNone);
  const std::vector<double> at = {0.1, 0.25, 0.5, 0.8};
  for (const TransferPoint& p : transfer(estimate, truth, kRate_Hz, at)) {
    EXPECT_NEAR(p.gain, 1.2 - 0.4 * p.f_hz, 0.01) << p.f_hz;
    EXPECT_NEAR(p.lag_s, 0, 0.005) << p.f_hz;
    EXPECT_NEAR(p.error_ratio, std::abs(0.2 - 0.4 * p.f_hz), 0.02) << p.f_hz;
  }
}

TEST(Transfer, FindsTheLagAndItsSign) {
  const auto truth = heave_with(kOne, kNone), late = heave_with(kOne, [](double) { return 0.15; });
  const std::vector<double> at = {0.1, 0.3, 0.9};
  for (const TransferPoint& p : transfer(late, truth, kRate_Hz, at)) EXPECT_NEAR(p.lag_s, 0.15, 0.01) << p.f_hz;
  for (const TransferPoint& p : transfer(truth, late, kRate_Hz, at)) EXPECT_NEAR(p.lag_s, -0.15, 0.01) << p.f_hz;
}

TEST(Transfer, KnowsNothingOfARecordShorterThanABlock) {
  const std::vector<double> few(100, 1.0), at = {0.2};
  EXPECT_TRUE(std::isnan(transfer(few, few, kRate_Hz, at).front().gain));
  EXPECT_TRUE(std::isnan(transfer({}, {}, kRate_Hz, at).front().gain));
}

}  // namespace
}  // namespace waverig::evaluation
