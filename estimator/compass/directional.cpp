#include "estimator/compass/directional.h"

#include <algorithm>
#include <complex>
#include <utility>

#include "estimator/compass/cross_spectra.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Complex = std::complex<double>;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kHannLobe = 3;  // frequencies to either side of a line that it spreads over

double in_turn(double angle_rad) {
  const double a = std::fmod(angle_rad, kTurn);
  return a < 0 ? a + kTurn : a;
}

// Magnetic north in L as a straight line over the segment: the frame turns slowly and evenly (a gyro's bias).
struct NorthFit {
  double angle_rad = 0, rate_per_bin = 0, std_rad = 0;
  double at(double bin) const { return angle_rad + rate_per_bin * bin; }
};

NorthFit fit_north(const std::vector<double>& angles, const std::vector<bool>& known) {
  NorthFit fit;
  Complex mean = 0;
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (known[i]) mean += std::polar(1.0, angles[i]);
  fit.angle_rad = std::arg(mean);
  for (int iteration = 0; iteration < 6; ++iteration) {  // wrapping makes it nonlinear: relinearise
    double n = 0, t1 = 0, t2 = 0, y0 = 0, y1 = 0, square = 0;
    for (std::size_t i = 0; i < angles.size(); ++i) {
      if (!known[i]) continue;
      const double t = static_cast<double>(i), residual = std::remainder(angles[i] - fit.at(t), kTurn);
      n += 1;
      t1 += t;
      t2 += t * t;
      y0 += residual;
      y1 += residual * t;
      square += residual * residual;
    }
    fit.std_rad = std::sqrt(square / std::max(n, 1.0));
    const double determinant = n * t2 - t1 * t1;
    if (!(determinant > 0)) break;
    fit.angle_rad += (t2 * y0 - t1 * y1) / determinant;
    fit.rate_per_bin += (n * y1 - t1 * y0) / determinant;
  }
  return fit;
}

}  // namespace

struct DirectionalAnalysis::Sums {
  std::unique_ptr<CrossSpectra> spectra;  // north is magnetic here
  int segments = 0, dropped = 0;
  double heading_square = 0, norm = 0, norm_square = 0, fields = 0;
};

namespace {

// Of the displacements, noise removed; directions true.
struct Band {
  double z = 0, h = 0;    // densities of the heave and of the horizontal motion, m^2/Hz
  Complex first, second;  // h-weighted cosines and sines of once and twice the direction
  bool above_noise = false;
};

// Noise above the waves; the mean over the bins has flattened white noise there.
double noise_of(const CrossSpectra& s, const std::vector<double>& density, double from_Hz) {
  double sum = 0, count = 0;
  for (auto k = static_cast<std::size_t>(std::ceil(from_Hz / s.step_Hz())); k + 1 < density.size();
       ++k, count += 1)
    sum += density[k];
  return sum / std::max(count, 1.0);
}

std::vector<Band> displacement_bands(const CrossSpectra& s, const DirectionalSettings& settings) {
  const double noise_z = noise_of(s, s.zz, settings.noise_from_Hz);
  const double noise_h =
      noise_of(s, s.nn, settings.noise_from_Hz) + noise_of(s, s.ee, settings.noise_from_Hz);
  // Declination enters here and nowhere else: the coefficients turn from magnetic to true.
  const Complex turn = std::polar(1.0, settings.compass.declination_rad);
  std::vector<Band> bands(s.frequencies());
  for (std::size_t k = 1; k < bands.size(); ++k) {
    const double f = static_cast<double>(k) * s.step_Hz(), x = std::numbers::pi * f * settings.bin_s;
    const double to_displacement = std::pow(x / std::sin(x), 2) / (std::pow(kTurn * f, 4) * s.weight());
    Band& band = bands[k];
    band.z = to_displacement * std::max(0.0, s.zz[k] - noise_z);
    band.h = to_displacement * std::max(0.0, s.nn[k] + s.ee[k] - noise_h);
    band.first = to_displacement * turn * Complex(std::imag(s.zn[k]), std::imag(s.ze[k]));
    band.second = to_displacement * turn * turn * Complex(s.nn[k] - s.ee[k], 2 * std::real(s.ne[k]));
    band.above_noise = s.zz[k] - noise_z > settings.signal_over_noise * noise_z && band.h > 0;
  }
  return bands;
}

DirectionalBand described(const Band& band, double frequency_Hz) {
  DirectionalBand result{.frequency_Hz = frequency_Hz, .a0_m2pHz = band.z};
  if (!(band.z > 0 && band.h > 0)) return result;
  const Complex first = band.first / std::sqrt(band.z * band.h), second = band.second / band.h;
  result.a1 = first.real();
  result.b1 = first.imag();
  result.a2 = second.real();
  result.b2 = second.imag();
  result.check_factor = std::sqrt(band.h / band.z);
  return result;
}

DirectionalSea evaluate(const CrossSpectra& spectra, const DirectionalSettings& settings) {
  DirectionalSea sea;
  const std::vector<Band> bands = displacement_bands(spectra, settings);
  // Below, what the window leaves of offset and trend of a short record.
  const double lowest_Hz = std::max(settings.lowest_Hz, kHannLobe * spectra.step_Hz());
  const auto low = static_cast<std::size_t>(std::ceil(lowest_Hz / spectra.step_Hz()));
  const auto high = static_cast<std::size_t>(settings.highest_Hz / spectra.step_Hz());
  std::size_t peak = 0;
  for (std::size_t k = low; k <= high; ++k) {
    sea.bands.push_back(described(bands[k], static_cast<double>(k) * spectra.step_Hz()));
    if (bands[k].above_noise && bands[k].z > bands[peak].z) peak = k;
  }
  if (peak == 0) return sea;
  Band all;
  for (std::size_t k = low; k <= high; ++k) {
    const Band& band = bands[k];
    if (!band.above_noise || band.z < settings.least_share_of_peak * bands[peak].z) continue;
    all.z += band.z;
    all.h += band.h;
    all.first += band.first;
  }
  sea.hm0_m = 4 * std::sqrt(all.z * spectra.step_Hz());
  sea.mean_direction_rad = in_turn(std::arg(all.first));
  sea.spread_rad = std::sqrt(2 * std::max(0.0, 1 - std::abs(all.first) / std::sqrt(all.z * all.h)));
  sea.check_factor = std::sqrt(all.h / all.z);
  sea.peak_Hz = static_cast<double>(peak) * spectra.step_Hz();
  sea.peak_direction_rad =
      in_turn(std::arg(bands[peak - 1].first + bands[peak].first + bands[peak + 1].first));
  return sea;
}

}  // namespace

double DirectionalBand::direction_from_rad() const { return in_turn(std::atan2(b1, a1)); }
double DirectionalBand::spread_rad() const { return std::sqrt(2 * std::max(0.0, 1 - std::hypot(a1, b1))); }

void DirectionalSea::fill(SeaState& sea) const {
  if (segments == 0) return;
  sea.hm0_m = hm0_m;
  sea.mean_direction_rad = mean_direction_rad;
  sea.spread_rad = spread_rad;
  sea.peak_direction_rad = peak_direction_rad;
  sea.check_factor = check_factor;
}

DirectionalAnalysis::DirectionalAnalysis(const DirectionalSettings& settings)
    : settings_(settings), mean_(settings.bin_s), sums_(std::make_unique<Sums>()) {
  if (!(settings.bin_s > 0 && settings.segment_s >= settings.shortest_segment_s && settings.lowest_Hz > 0 &&
        settings.highest_Hz > settings.lowest_Hz && settings.noise_from_Hz > settings.highest_Hz &&
        settings.noise_from_Hz < 0.5 / settings.bin_s &&
        settings.shortest_segment_s > 4 / settings.highest_Hz))
    throw UserError(
        "directional analysis: expected lowest < highest < noise frequency < half the rate of the bins");
  segment_bins_ =
      kHannSteps * static_cast<std::size_t>(std::lround(settings.segment_s / settings.bin_s / kHannSteps));
}

DirectionalAnalysis::~DirectionalAnalysis() = default;

void DirectionalAnalysis::add(const LevelSample& sample) {
  const auto begin = [&] { mean_.start(sample.utime, sample.a_L.array()); };
  if (!started_) {
    begin();
    started_ = true;
  } else if (const double gap_s = static_cast<double>(sample.utime - mean_.last_utime()) * kMicrosecond;
             gap_s > settings_.largest_gap_s) {
    open_ = {};
    const double longest = static_cast<double>(segment_bins_);  // more says no more than a whole segment
    for (auto missing = std::lround(std::min(gap_s / settings_.bin_s, longest)); missing > 0; --missing)
      close_bin();
    begin();
  } else {
    mean_.add(sample.utime, sample.a_L.array(), [&](std::int64_t, const Increment<Eigen::Array3d>& whole) {
      open_.a_L = whole.speed_mps.matrix() / settings_.bin_s;
      open_.seen = true;
      close_bin();
    });
  }
  if (sample.has_field) {
    open_.m_L += sample.q_LB * settings_.compass.calibration.apply(sample.m_B_uT);
    ++open_.fields;
  }
}

void DirectionalAnalysis::close_bin() {
  if (open_.fields > 0) open_.m_L /= open_.fields;
  bins_.push_back(std::exchange(open_, {}));
  if (bins_.size() > segment_bins_) bins_.pop_front();
  ++closed_;
  if (ends_a_segment()) analyse(hann_window(segment_bins_));
}

bool DirectionalAnalysis::ends_a_segment() const {
  return closed_ >= segment_bins_ && (closed_ - segment_bins_) % (segment_bins_ / kHannSteps) == 0;
}

// The last segment ends where the record does; a record without a whole one is one shorter piece. Its window
// is that of all others: a window of another shape lets short waves leak into long ones, which count by their
// period to the fourth power.
void DirectionalAnalysis::analyse_end() {
  if (bins_.size() < static_cast<std::size_t>(settings_.shortest_segment_s / settings_.bin_s)) return;
  if (ends_a_segment()) return;
  analyse(hann_window(bins_.size()));
}

bool DirectionalAnalysis::usable() const {
  const auto longest = static_cast<int>(settings_.largest_gap_s / settings_.bin_s);
  int gap = 0, fields = 0;
  for (const Bin& bin : bins_) {
    gap = bin.seen ? 0 : gap + 1;
    if (gap > longest) return false;
    fields += bin.fields > 0;
  }
  return fields > static_cast<int>(bins_.size() / 4);
}

void DirectionalAnalysis::analyse(const std::vector<double>& window) {
  Sums& s = *sums_;
  const std::size_t bins = bins_.size();
  if (!usable()) {
    ++s.dropped;
    return;
  }
  // 1. Where magnetic north is in L.
  std::vector<double> angle(bins);
  std::vector<bool> known(bins);
  for (std::size_t i = 0; i < bins; ++i) {
    known[i] = bins_[i].fields > 0;
    angle[i] = std::atan2(bins_[i].m_L.y(), bins_[i].m_L.x());
  }
  const NorthFit north = fit_north(angle, known);
  if (!(north.std_rad <= settings_.largest_heading_std_rad)) {
    ++s.dropped;
    return;
  }
  s.heading_square += north.std_rad * north.std_rad;
  for (const Bin& bin : bins_) {
    if (bin.fields == 0) continue;
    const double norm = bin.m_L.norm();
    s.norm += norm;
    s.norm_square += norm * norm;
    s.fields += 1;
  }

  // 2. Up, magnetic north and east; a short gap is bridged by what came before it.
  std::vector<double> up(bins), to_north(bins), to_east(bins);
  Vector3d a_L = Vector3d::Zero();
  for (std::size_t i = 0; i < bins; ++i) {
    if (bins_[i].seen) a_L = bins_[i].a_L;
    const double angle_rad = north.at(static_cast<double>(i)), c = std::cos(angle_rad),
                 sn = std::sin(angle_rad);
    up[i] = -a_L.z();
    to_north[i] = c * a_L.x() + sn * a_L.y();
    to_east[i] = -sn * a_L.x() + c * a_L.y();
  }

  // 3. Cross-spectra.
  if (!s.spectra) s.spectra = std::make_unique<CrossSpectra>(bins, settings_.bin_s);
  s.spectra->add(std::move(up), std::move(to_north), std::move(to_east), window);
  ++s.segments;
}

DirectionalSea DirectionalAnalysis::finish() {
  analyse_end();
  DirectionalSea sea;
  sea.dropped_segments = sums_->dropped;
  if (sums_->segments > 0) {
    const Sums& s = *sums_;
    sea = evaluate(*s.spectra, settings_);
    sea.segments = std::isnan(sea.mean_direction_rad) ? 0 : s.segments;
    sea.dropped_segments = s.dropped;
    sea.heading_std_rad = std::sqrt(s.heading_square / s.segments);
    const double norm = s.norm / s.fields;
    sea.field_norm_std = std::sqrt(std::max(0.0, s.norm_square / s.fields - norm * norm)) / norm;
  }
  bins_.clear();
  open_ = {};
  closed_ = 0;
  started_ = false;
  sums_ = std::make_unique<Sums>();
  return sea;
}

}  // namespace waverig::estimator
