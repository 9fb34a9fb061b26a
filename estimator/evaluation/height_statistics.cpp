#include "estimator/evaluation/height_statistics.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "lcmtypes/flags.h"

namespace waverig::evaluation {
namespace {

// Expanded uncertainty of what has this budget.
double expanded_m(std::span<const Contribution> budget) {
  double variance = 0;
  for (const Contribution& c : budget) variance += c.sigma_m * c.sigma_m;
  return kCoverageFactor * std::sqrt(variance);
}

}  // namespace

void HeightAccumulator::KnownMean::add(double value) {
  if (!std::isfinite(value)) return;
  ++count;
  sum += value;
}

double HeightAccumulator::KnownMean::mean() const {
  return count > 0 ? sum / static_cast<double>(count) : estimator::kUnknown;
}

void HeightAccumulator::add(const JudgedWave& judged) {
  const estimator::Wave& wave = judged.wave;
  ++waves_;
  const double step = wave.height_m - mean_;
  mean_ += step / static_cast<double>(waves_);
  squares_ += step * (wave.height_m - mean_);
  period_sum_ += wave.period_s;
  const double error = wave.height_m - judged.true_height_m;
  true_height_.add(judged.true_height_m);
  squared_error_.add(error * error);
  noise_variance_.add(wave.noise_sigma_m * wave.noise_sigma_m);
  calibration_.add(wave.calibration_sigma_m);
  tilt_.add(wave.tilt_sigma_m);
  record_frequency_.add(wave.frequency_sigma_m);
  flags_ |= wave.flags;
}

void HeightAccumulator::close_record() {
  if (record_frequency_.count > 0) {
    ++frequency_records_;
    frequency_variance_sum_ += record_frequency_.mean() * record_frequency_.mean();
  }
  record_frequency_ = {};
}

HeightStatistics HeightAccumulator::statistics(double set_height_m, double bound_std_m) const {
  HeightStatistics s;
  s.waves = waves_;
  s.flags = flags_;
  s.bound_std_m = bound_std_m;
  if (waves_ < 2) s.flags |= flag::kTooFewWaves;
  if (waves_ == 0) return s;
  const auto n = static_cast<double>(waves_);
  s.mean_height_m = mean_;
  s.mean_period_s = period_sum_ / n;
  s.error_rate_percent = error_rate_percent(mean_, set_height_m);
  if (waves_ > 1) s.std_m = std::sqrt(squares_ / (n - 1));
  s.rmse_m = std::sqrt(squared_error_.mean());
  s.mean_true_height_m = true_height_.mean();
  s.mean_error_percent = 100 * (mean_ - s.mean_true_height_m) / s.mean_true_height_m;

  const auto contribute = [&s](const char* name, double sigma_m, char type) {
    if (std::isfinite(sigma_m)) s.budget.push_back({name, sigma_m, type});
  };
  const bool noise_known = noise_variance_.count > 0;
  const double noise_variance = noise_known ? noise_variance_.mean() : 0.0;
  if (noise_known) contribute("noise", std::sqrt(noise_variance / n), 'B');
  if (waves_ > 1)
    contribute("scatter", std::sqrt(std::max(0.0, s.std_m * s.std_m - noise_variance) / n), 'A');
  contribute("calibration", calibration_.mean(), 'B');
  contribute("tilt", tilt_.mean(), 'B');
  if (frequency_records_ > 0)
    contribute("frequency", std::sqrt(frequency_variance_sum_) / static_cast<double>(frequency_records_),
               'B');
  if (std::any_of(s.budget.begin(), s.budget.end(), [](const Contribution& c) { return c.type == 'B'; }))
    s.expanded_uncertainty_m = expanded_m(s.budget);
  return s;
}

double error_rate_percent(double mean_height_m, double set_height_m) {
  return 100 * std::abs(mean_height_m - set_height_m) / set_height_m;
}

}  // namespace waverig::evaluation
