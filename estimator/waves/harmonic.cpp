#include "estimator/waves/harmonic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

using std::numbers::pi;

constexpr double kWavesAhead = 5.5;  // a wave is given once so many follow: its frequency is shared by them
constexpr double kWavesBehind = 11;  // kept for the same reason
constexpr double kQuiet_s = 100;     // without a wave in sight, so much is kept: a slow one may be beginning
constexpr double kLeastInterval_s = 1e-3;  // of samples, before their usual one is known

BlockLevellerSettings leveller_settings(const MethodSettings& settings, const HarmonicSettings& own) {
  BlockLevellerSettings result = own.leveller;
  result.gravity_mps2 = settings.sensor.gravity_mps2;
  result.gyro_bias_sigma_radps = settings.sensor.gyro_bias_sigma_radps;
  return result;
}

// Heave and its rate at t, from waves that surround it; nothing outside of waves.
struct FittedHeave {
  bool inside = false;
  double heave_m = kUnknown, rate_mps = kUnknown, sigma_m = kUnknown;
  std::int32_t flags = 0;
};

FittedHeave heave_at(const std::vector<RegularWave>& waves, double t_s, std::size_t& k) {
  while (k < waves.size() && waves[k].end_s() < t_s) ++k;
  FittedHeave result;
  if (k == waves.size()) return result;
  // Where one wave ends and the next begins each has by its own fit: there may be a sample between.
  const bool seam = k > 0 && waves[k].follows;
  if (t_s < waves[k].begin_s() && !seam) return result;
  const RegularWave& wave = waves[k];
  // The other knot: the crossing before or after, where a wave follows.
  const bool later = t_s >= wave.timing.down_crossing_s;
  const bool has_other = later ? k + 1 < waves.size() && waves[k + 1].follows : k > 0 && wave.follows;
  const RegularWave& other = has_other ? waves[later ? k + 1 : k - 1] : wave;
  const double span_s =
      has_other ? std::abs(other.timing.down_crossing_s - wave.timing.down_crossing_s) : wave.timing.period_s;
  const double part = (t_s - wave.timing.down_crossing_s) / span_s;
  const double height_m = wave.height_m + std::abs(part) * (other.height_m - wave.height_m);
  result.inside = true;
  result.heave_m = -0.5 * height_m * std::sin(2 * pi * part);
  result.rate_mps = -0.5 * height_m * std::cos(2 * pi * part) * 2 * pi / span_s;
  const double sine_m = 0.5 * std::hypot(std::hypot(wave.noise_sigma_m, wave.calibration_sigma_m),
                                         std::hypot(wave.tilt_sigma_m, wave.frequency_sigma_m));
  // A corner bends what lies on the side where heights change, not what lies on the other.
  const double corner_m = has_other ? std::min(std::max(wave.corner_sigma_m, other.corner_sigma_m),
                                               0.25 * std::abs(other.height_m - wave.height_m))
                                    : wave.corner_sigma_m;
  const double shape_m = std::hypot(std::max(wave.shape_sigma_m, other.shape_sigma_m), corner_m);
  result.sigma_m = std::hypot(sine_m, shape_m);
  result.flags = wave.flags | (other.flags & flag::kSettling) | (corner_m > sine_m ? flag::kSettling : 0);
  return result;
}

}  // namespace

Harmonic::Harmonic(const MethodSettings& settings, const HarmonicSettings& own)
    : settings_(settings), own_(own), guard_(own.guard), leveller_(leveller_settings(settings, own)) {}

void Harmonic::add(const ImuSample& sample, Output& output) {
  const GuardVerdict verdict = guard_.check(sample);
  const bool good = verdict.usable && !(verdict.flags & flag::kSaturation);
  // The time of an unusable sample is not to be trusted: it counts by the usual interval.
  if (good)
    silent_s_ = verdict.dt_s;
  else
    silent_s_ += verdict.usable ? verdict.dt_s : std::max(guard_.usual_interval_s(), kLeastInterval_s);
  if (silent_s_ > own_.waves.finder.longest_period_s) finish(output);
  if (good) silent_s_ = 0;
  if (!under_way_ && !good) {
    HeaveSample heave;
    heave.utime = sample.utime;
    heave.seq = sample.seq;
    heave.heave_m = heave.heave_rate_mps = heave.heave_sigma_m = kUnknown;
    heave.flags = verdict.flags | flag::kSettling;
    order_.give(heave, verdict.usable, output);
    return;
  }
  if (!under_way_) {
    under_way_ = true;
    first_utime_ = sample.utime;
  }
  const std::size_t before = levelled_.size();
  leveller_.add(sample, verdict, levelled_);
  if (levelled_.size() == before) return;
  gather();
  process(false, output);
}

void Harmonic::finish(Output& output) {
  if (!under_way_) return;
  leveller_.finish(levelled_);
  gather();
  process(true, output);
  leveller_ = BlockLeveller(leveller_settings(settings_, own_));
  series_ = {};
  given_until_s_ = kNever_s;
  under_way_ = false;
}

void Harmonic::gather() {
  series_.set_sample_interval(guard_.usual_interval_s());
  for (; gathered_ < levelled_.size(); ++gathered_) series_.add(levelled_[gathered_]);
}

void Harmonic::process(bool last, Output& output) {
  const double end_s = series_.end_s();
  const std::optional<double> period_s = dominant_period_s(series_, own_.waves.finder);
  std::vector<RegularWave> waves;
  double until_s = end_s - kQuiet_s;
  if (period_s) {
    waves = regular_waves(series_, *period_s, own_.waves, settings_.sensor);
    until_s = end_s - kWavesAhead * *period_s;
  }
  if (last) until_s = std::numeric_limits<double>::infinity();
  for (const RegularWave& wave : waves) {
    if (wave.timing.down_crossing_s <= given_until_s_) continue;
    if (wave.end_s() > until_s) {
      until_s = std::min(until_s, wave.begin_s());
      break;
    }
    give_wave(wave, output);
    given_until_s_ = wave.end_s();
  }
  give_heave(waves, until_s, output);
  series_.drop_before(until_s - (period_s ? kWavesBehind * *period_s : 0.0));
}

void Harmonic::give_wave(const RegularWave& found, Output& output) {
  Wave wave;
  wave.start_utime = first_utime_ + std::llround(found.begin_s() / kMicrosecond);
  wave.seq = waves_++;
  wave.period_s = found.timing.period_s;
  wave.height_m = found.height_m;
  wave.noise_sigma_m = found.noise_sigma_m;
  wave.calibration_sigma_m = found.calibration_sigma_m;
  wave.tilt_sigma_m = found.tilt_sigma_m;
  wave.frequency_sigma_m = found.frequency_sigma_m;
  wave.flags = found.flags;
  const auto first = std::lower_bound(levelled_.begin(), levelled_.end(), found.begin_s(),
                                      [](const LevelledSample& s, double t) { return s.t_s < t; });
  for (auto it = first; it != levelled_.end() && it->t_s < found.end_s(); ++it) wave.flags |= it->flags;
  output.wave(wave);
}

void Harmonic::give_heave(const std::vector<RegularWave>& waves, double until_s, Output& output) {
  std::size_t k = 0;
  std::size_t given = 0;
  for (; given < gathered_ && levelled_[given].t_s < until_s; ++given) {
    const LevelledSample& sample = levelled_[given];
    const FittedHeave fitted = heave_at(waves, sample.t_s, k);
    HeaveSample heave;
    heave.utime = sample.utime;
    heave.seq = sample.seq;
    heave.heave_m = fitted.heave_m;
    heave.heave_rate_mps = fitted.rate_mps;
    heave.heave_sigma_m = fitted.sigma_m;
    heave.q_NB = sample.q_NB;
    heave.flags = sample.flags | fitted.flags | (fitted.inside ? 0 : flag::kSettling);
    order_.give(heave, sample.usable, output);
  }
  levelled_.erase(levelled_.begin(), levelled_.begin() + static_cast<std::ptrdiff_t>(given));
  gathered_ -= given;
}

}  // namespace waverig::estimator
