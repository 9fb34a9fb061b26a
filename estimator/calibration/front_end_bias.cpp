#include "estimator/calibration/front_end_bias.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Bin {
  double sum_A = 0, sum_squares = 0, sum_degC = 0;
  int count = 0;
  void add(double temperature_degC, double bias_A) {
    sum_A += bias_A;
    sum_squares += bias_A * bias_A;
    sum_degC += temperature_degC;
    ++count;
  }
  double mean_A() const { return count > 0 ? sum_A / count : kNaN; }
  double mean_degC() const { return sum_degC / count; }
};

enum class Ramp { kNone, kUp, kDown };

// Where the temperature at a distance of a few readings either side differs by more than its scatter, it ramps.
std::vector<Ramp> ramps(const std::vector<BiasReading>& readings, double turn_degC) {
  const auto [low, high] = std::minmax_element(readings.begin(), readings.end(), [](const auto& a, const auto& b) {
    return a.temperature_degC < b.temperature_degC;
  });
  const auto n = static_cast<std::ptrdiff_t>(readings.size());
  const std::ptrdiff_t reach = 4;
  std::vector<Ramp> result(readings.size(), Ramp::kNone);
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const auto at = [&](std::ptrdiff_t k) {
      return readings[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(k, 0, n - 1))].temperature_degC;
    };
    const double here = at(i);
    if (here < low->temperature_degC + turn_degC || here > high->temperature_degC - turn_degC) continue;
    const double slope = at(i + reach) - at(i - reach);
    if (std::abs(slope) > 0.2) result[static_cast<std::size_t>(i)] = slope > 0 ? Ramp::kUp : Ramp::kDown;
  }
  return result;
}

// Standard deviation from second differences of neighbouring readings of one ramp: a slow curve drops out.
double reading_noise_A(const std::vector<double>& bias_A, const std::vector<Ramp>& ramp) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 1; i + 1 < bias_A.size(); ++i) {
    if (ramp[i] == Ramp::kNone || ramp[i - 1] != ramp[i] || ramp[i + 1] != ramp[i]) continue;
    const double d = bias_A[i - 1] - 2 * bias_A[i] + bias_A[i + 1];
    sum += d * d / 6;
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

// Weights 1 2 3 2 1 over neighbouring bins: the loop is smooth over a few degrees, its noise is not.
void smooth(std::vector<HalfLoop>& loop) {
  const std::vector<HalfLoop> raw = loop;
  const auto n = static_cast<int>(raw.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0, weights = 0;
    for (int k = std::max(0, i - 2); k <= std::min(n - 1, i + 2); ++k) {
      const double weight = 3 - std::abs(k - i);
      sum += weight * raw[static_cast<std::size_t>(k)].half_A;
      weights += weight;
    }
    loop[static_cast<std::size_t>(i)].half_A = sum / weights;
  }
}

double ramp_rate_degC_s(const std::vector<BiasReading>& readings, const std::vector<Ramp>& ramp) {
  double change = 0, time_s = 0;
  for (std::size_t i = 1; i < readings.size(); ++i) {
    if (ramp[i] == Ramp::kNone || ramp[i - 1] != ramp[i]) continue;
    change += (ramp[i] == Ramp::kUp ? 1 : -1) * (readings[i].temperature_degC - readings[i - 1].temperature_degC);
    time_s += readings[i].duration_s;
  }
  return time_s > 0 ? change / time_s : 0;
}

}  // namespace

BiasResult fit_bias(const std::vector<BiasReading>& readings, const FrontEndChannel& channel,
                    const BiasSettings& settings) {
  if (readings.size() < 20) throw UserError("bias of " + channel.name + ": expected at least 20 readings over both ramps");
  const std::vector<Ramp> ramp = ramps(readings, settings.turn_degC);
  std::vector<double> bias_A;
  std::map<int, std::pair<Bin, Bin>> bins;   // up, down
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const BiasReading& r = readings[i];
    bias_A.push_back(-(channel.K_N_C(r.temperature_degC) * r.rate_N_Hz - channel.K_P_C(r.temperature_degC) * r.rate_P_Hz));
    if (ramp[i] == Ramp::kNone) continue;
    auto& [up, down] = bins[static_cast<int>(std::floor(r.temperature_degC / settings.bin_degC))];
    (ramp[i] == Ramp::kUp ? up : down).add(r.temperature_degC, bias_A.back());
  }

  BiasResult result;
  result.noise_A = reading_noise_A(bias_A, ramp);
  std::vector<TemperaturePoint> middle;
  double squares = 0;
  for (const auto& [index, both] : bins) {
    const auto& [up, down] = both;
    result.loop.push_back({(index + 0.5) * settings.bin_degC, up.mean_A(), down.mean_A()});
    if (up.count == 0 || down.count == 0) continue;
    const double width = up.mean_A() - down.mean_A(), T = 0.5 * (up.mean_degC() + down.mean_degC());
    result.hysteresis_A = std::max(result.hysteresis_A, std::abs(width));
    squares += width * width;
    const double noise = std::max(result.noise_A, 1e-15) * std::sqrt(1.0 / up.count + 1.0 / down.count) / 2;
    middle.push_back({T, 0.5 * (up.mean_A() + down.mean_A()), noise});
    result.half_loop.push_back({T, 0.5 * width});
  }
  if (middle.size() < 4) throw UserError("bias of " + channel.name + ": expected a ramp up and a ramp down");
  const auto n = static_cast<double>(middle.size());
  result.hysteresis_rms_A = std::sqrt(squares / n);
  result.law = fit_temperature_law(middle, settings.law).law;

  smooth(result.half_loop);

  // What single readings leave about their own branch comes with every use: shape, wander, noise.
  FrontEndChannel branches;
  branches.bias_loop = result.half_loop;
  double left = 0;
  int readings_used = 0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (ramp[i] == Ramp::kNone) continue;
    const double T = readings[i].temperature_degC, side = ramp[i] == Ramp::kUp ? 1 : -1;
    left += std::pow(bias_A[i] - result.law.at(T) - side * branches.half_loop_A(T), 2);
    ++readings_used;
  }
  const double left_sigma = std::sqrt(left / readings_used);
  double slope_A_degC = 0;
  for (const TemperaturePoint& p : middle)
    slope_A_degC += std::abs(result.law.at(p.temperature_degC + 0.5) - result.law.at(p.temperature_degC - 0.5)) / n;
  const double rate_degC_s = ramp_rate_degC_s(readings, ramp);
  const double lag_sigma = slope_A_degC * rate_degC_s * settings.lag_s / std::sqrt(3.0);
  result.budget = {{"hysteresis", 0.5 * result.hysteresis_rms_A, 'B'},
                   {"repeatability and shape against temperature", left_sigma, 'A'},
                   {"thermometer lag", lag_sigma, 'B'},
                   {"fit", result.law.sigma_at(settings.law.reference_degC), 'A'}};
  result.law.covariance(0, 0) += left_sigma * left_sigma + lag_sigma * lag_sigma;
  return result;
}

OscillatorResult fit_oscillator(const std::vector<OscillatorReading>& readings, double reference_relative) {
  OscillatorResult result;
  for (const OscillatorReading& r : readings) {
    if (r.reference_counts <= 0) continue;
    const double resolution = std::sqrt(2.0 / 12.0) / r.reference_counts;
    result.points.push_back({r.temperature_degC, r.reference_Hz * r.nominal_s / r.reference_counts - 1, resolution});
  }
  if (result.points.empty()) throw UserError("master oscillator: expected counts of the reference frequency");
  const TemperatureLawFit fit = fit_temperature_law(result.points, {20, 4, false});
  result.law = fit.law;
  result.budget = {{"reference frequency", reference_relative / 2, 'B'}, {"fit", result.law.sigma_at(20), 'A'}};
  result.law.covariance(0, 0) += reference_relative * reference_relative / 4;
  return result;
}

}  // namespace waverig::estimator
