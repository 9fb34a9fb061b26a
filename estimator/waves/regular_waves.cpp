#include "estimator/waves/regular_waves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "estimator/waves/height_budget.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

using std::numbers::pi;

constexpr std::size_t kNeighbours = 4;  // on either side: noise and mean force are told together
constexpr std::size_t kEvenly = 4;      // waves that share one frequency run evenly
constexpr double kClearMisfit =
    1.5;  // times the noise power: about four standard deviations of twenty blocks
constexpr double kContradiction = 4;  // standard deviations
constexpr double kCorner = 0.25;      // of a change of slope in amplitude, midway between two crossings

// Calls visit(wave j) for k and its unbroken neighbours, as far as kNeighbours.
template <class Visit>
void for_neighbours(const std::vector<RegularWave>& waves, std::size_t k, const Visit& visit) {
  visit(waves[k]);
  for (std::size_t j = k; j > 0 && k - j < kNeighbours && waves[j].follows; --j) visit(waves[j - 1]);
  for (std::size_t j = k + 1; j < waves.size() && j - k <= kNeighbours && waves[j].follows; ++j)
    visit(waves[j]);
}

// Standard deviation of a wave's offset from white noise.
double offset_sigma(const RegularWave& wave) {
  return wave.noise_density / std::sqrt(2 * (wave.fit.end_s - wave.fit.begin_s));
}

double slope_between(const WaveFit& a, const WaveFit& b) {
  return (b.offset_mps2 - a.offset_mps2) / (b.middle_s - a.middle_s);
}

// Drift of the acceleration across wave k, from the offsets of the waves beside it. A wave that speeds up or
// slows down has a mean acceleration of its own, which is no drift of the sensor: where the two sides
// contradict each other beyond the noise, the quieter one is believed.
double drift_mps3(const std::vector<RegularWave>& waves, std::size_t k) {
  const bool has_before = k > 0 && waves[k].follows, has_after = k + 1 < waves.size() && waves[k + 1].follows;
  if (!has_before || !has_after) return 0.0;
  const WaveFit &before = waves[k - 1].fit, &here = waves[k].fit, &after = waves[k + 1].fit;
  const double rising = slope_between(before, here), falling = slope_between(here, after);
  const double noise = kContradiction * std::sqrt(6.0) * offset_sigma(waves[k]) / (here.end_s - here.begin_s);
  if (std::abs(rising - falling) <= noise) return slope_between(before, after);
  return std::abs(rising) < std::abs(falling) ? rising : falling;
}

std::vector<RegularWave> first_fits(const WaveSeries& series, double period_s) {
  std::vector<RegularWave> waves;
  bool broken = true;
  for (const WaveSpan& span : find_waves(series, period_s)) {
    RegularWave wave;
    wave.follows = span.follows && !broken;
    wave.fit = fit_wave(series, span.begin_s, span.end_s, 2 * pi / (span.end_s - span.begin_s), 0);
    broken = !wave.fit.valid;
    if (!broken) waves.push_back(wave);
  }
  return waves;
}

void pool_noise(std::vector<RegularWave>& waves) {
  for (std::size_t k = 0; k < waves.size(); ++k) {
    std::vector<double> densities;
    for_neighbours(waves, k, [&](const RegularWave& w) { densities.push_back(w.fit.noise_density); });
    const auto middle = densities.begin() + static_cast<std::ptrdiff_t>(densities.size() / 2);
    std::nth_element(densities.begin(), middle, densities.end());
    const double limit =
        2 * std::min(*middle, waves[k].fit.noise_density);  // a knock does not speak for the noise
    double squares = 0, count = 0;
    for (const double d : densities) {
      if (d > limit) continue;
      squares += d * d;
      count += 1;
    }
    waves[k].noise_density = std::sqrt(squares / count);
  }
}

// In phase with the wave the drift told by the neighbours' offsets adds a part: (T/pi)^2 var(slope).
double amplitude_sigma(const RegularWave& wave) {
  const double T = wave.fit.end_s - wave.fit.begin_s, d = wave.noise_density;
  const double drift = d * d / (4 * pi * pi * T), fit = wave.fit.sigma_per_density * d;
  return std::sqrt(fit * fit + drift);
}

// Keeps what is wanted; where a wave goes, the next one no longer follows.
template <class Wanted>
void keep(std::vector<RegularWave>& waves, const Wanted& wanted) {
  bool dropped = false;
  std::vector<RegularWave> kept;
  for (RegularWave& wave : waves) {
    if (dropped) wave.follows = false;
    dropped = !wanted(wave);
    if (!dropped) kept.push_back(wave);
  }
  waves.swap(kept);
}

void share_timing(std::vector<RegularWave>& waves, double floor) {
  std::vector<WaveEvent> events;
  for (const RegularWave& wave : waves) {
    const double w = wave.fit.omega_radps, phase_sigma = amplitude_sigma(wave) / wave.fit.amplitude_mps2();
    events.push_back({wave.fit.down_crossing_s(), std::hypot(phase_sigma, 2 * pi * floor) / w, wave.follows});
  }
  const std::vector<WaveTiming> timings = share_frequency(events);
  for (std::size_t k = 0; k < waves.size(); ++k) {
    waves[k].timing = timings[k];
    if (timings[k].waves < 2) {  // alone: its own length, from two crossings of its own
      waves[k].timing.period_s = waves[k].fit.end_s - waves[k].fit.begin_s;
      waves[k].timing.sigma_s = 2 * events[k].sigma_s;
    }
  }
}

// The fits again, at the shared frequency and with the drift told by the neighbours.
void refit(const WaveSeries& series, std::vector<RegularWave>& waves) {
  std::vector<WaveFit> fits;
  for (std::size_t k = 0; k < waves.size(); ++k) {
    const RegularWave& wave = waves[k];
    fits.push_back(
        fit_wave(series, wave.begin_s(), wave.end_s(), 2 * pi / wave.timing.period_s, drift_mps3(waves, k)));
  }
  for (std::size_t k = 0; k < waves.size(); ++k) waves[k].fit = fits[k];
}

void tell_height(const WaveSeries& series, const std::vector<RegularWave>& waves, std::size_t k,
                 const RegularWaveSettings& settings, const SensorKnowledge& knowledge, RegularWave& wave) {
  const double w = wave.fit.omega_radps, sigma = amplitude_sigma(wave), raw = wave.fit.amplitude_mps2();
  // Only waves that run evenly have no mean acceleration of their own.
  std::vector<double> offsets;
  for_neighbours(waves, k, [&](const RegularWave& other) { offsets.push_back(other.fit.offset_mps2); });
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  double mean_up = 0, seconds = 0;
  for_neighbours(waves, k, [&](const RegularWave& other) {
    const double ratio = other.timing.period_s / wave.timing.period_s;
    if (other.timing.waves < kEvenly || std::abs(ratio - 1) > settings.settled_period) return;
    if (std::abs(other.fit.offset_mps2 - *middle) > kContradiction * offset_sigma(wave)) return;
    mean_up += other.fit.offset_mps2 * other.timing.period_s;
    seconds += other.timing.period_s;
  });
  const double mean_sigma =
      seconds > 0 ? wave.noise_density / std::sqrt(2 * seconds) : std::numeric_limits<double>::infinity();
  if (seconds > 0) mean_up /= seconds;
  const AmplitudeBudget budget = amplitude_budget(series, wave.fit, knowledge, mean_up, mean_sigma);
  // Noise across the phase only ever lengthens the amplitude: E[A^2] = A0^2 + sigma^2 from that side.
  const double amplitude = std::sqrt(std::max(0.0, raw * raw - sigma * sigma)) - budget.correction_mps2;
  const double height_per_amplitude = 2 / (w * w);
  wave.height_m = height_per_amplitude * amplitude;
  wave.noise_sigma_m = height_per_amplitude * sigma;
  wave.calibration_sigma_m = height_per_amplitude * budget.calibration_sigma_mps2;
  wave.tilt_sigma_m = height_per_amplitude * budget.tilt_sigma_mps2;
  wave.frequency_sigma_m = wave.height_m * 2 * wave.timing.sigma_s / wave.timing.period_s;

  if (raw < settings.clear_snr * sigma) wave.flags |= flag::kBelowNoise;
  // What the residual has beyond the noise of the neighbours, if it stands out of it at all.
  const double noise = wave.fit.misfit_mps2 * wave.noise_density / std::max(wave.fit.noise_density, 1e-12);
  const double excess = wave.fit.misfit_mps2 * wave.fit.misfit_mps2 - noise * noise;
  const bool misfits = excess > kClearMisfit * noise * noise &&
                       excess > settings.settled_misfit * settings.settled_misfit * raw * raw;
  // A part at twice the frequency, beyond what noise makes of it, leaves the height as it is, but not heave.
  const double second2 = std::max(0.0, square(wave.fit.second_mps2) - square(kContradiction * sigma));
  wave.shape_sigma_m = std::sqrt((misfits ? excess : 0) + second2 / 32) / (w * w);
  bool settling = wave.timing.waves < 3 || misfits;
  const auto spacing_differs = [&](double spacing_s) {
    return std::abs(spacing_s / wave.timing.period_s - 1) > settings.settled_period + 3 * sigma / raw;
  };
  if (wave.follows) {
    settling |= spacing_differs(waves[k].fit.down_crossing_s() - waves[k - 1].fit.down_crossing_s());
  }
  if (k + 1 < waves.size() && waves[k + 1].follows) {
    settling |= spacing_differs(waves[k + 1].fit.down_crossing_s() - waves[k].fit.down_crossing_s());
  }
  if (settling) wave.flags |= flag::kSettling;
}

// Heave between two crossings has an amplitude that goes evenly from the one's to the other's: how far off it
// is where the heights do not, beyond what their noise makes of them. Where a run begins or ends, what the
// step to its neighbour leads to is not known at all.
double corner_sigma_m(const std::vector<RegularWave>& waves, std::size_t k) {
  const bool has_before = k > 0 && waves[k].follows, has_after = k + 1 < waves.size() && waves[k + 1].follows;
  const double before_m = has_before ? waves[k].height_m - waves[k - 1].height_m : 0,
               after_m = has_after ? waves[k + 1].height_m - waves[k].height_m : 0;
  const double noise_m = kContradiction * std::sqrt(6.0) * waves[k].noise_sigma_m;
  const double share = has_before && has_after ? kCorner : 1;
  return 0.5 * share * std::max(0.0, std::abs(after_m - before_m) - noise_m);
}

}  // namespace

std::vector<RegularWave> regular_waves(const WaveSeries& series, double period_s,
                                       const RegularWaveSettings& settings,
                                       const SensorKnowledge& knowledge) {
  // Twice: at the second time the crossings are free of the drift and of each span's own noisy length, and
  // the noise is free of both.
  std::vector<RegularWave> waves = first_fits(series, period_s);
  for (int round = 0; round < 2; ++round) {
    pool_noise(waves);
    keep(waves, [&](const RegularWave& wave) {
      return wave.fit.valid && wave.fit.amplitude_mps2() > settings.least_snr * amplitude_sigma(wave);
    });
    share_timing(waves, settings.timing_floor);
    refit(series, waves);
  }
  keep(waves, [&](const RegularWave& wave) {
    return wave.fit.valid && wave.begin_s() >= series.begin_s() - series.bin_s() &&
           wave.end_s() <= series.end_s() + series.bin_s();
  });
  pool_noise(waves);
  std::vector<RegularWave> result = waves;
  for (std::size_t k = 0; k < waves.size(); ++k)
    tell_height(series, waves, k, settings, knowledge, result[k]);
  for (std::size_t k = 0; k < waves.size(); ++k) result[k].corner_sigma_m = corner_sigma_m(result, k);
  return result;
}

}  // namespace waverig::estimator
