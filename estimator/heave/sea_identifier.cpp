#include "estimator/heave/sea_identifier.h"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waverig::estimator {
namespace {

constexpr double kDt = kNodeInterval_s;
constexpr double kStandsOut = 6;  // times the noise: there is sea
constexpr double kBiasCorner_radps = 0.02;
constexpr double kLowestSea_hz = 0.02;  // longer waves are no wind sea nor swell
constexpr std::size_t kShortest = 48;   // nodes before the first periodogram: 24 s
constexpr double kLeastSea = 1e-4;      // of the unknown sea: what a calm may still become

double heave_gain(double angle) { return std::pow(2 - 2 * std::cos(angle), 2); }
double noise_shape(double angle) { return std::pow(kDt, 4) * (2 + std::cos(angle)) / 3; }

}  // namespace

struct SeaIdentifier::Transform {
  explicit Transform(int n)
      : in(fftw_alloc_real(static_cast<std::size_t>(n))),
        out(fftw_alloc_complex(static_cast<std::size_t>(n / 2 + 1))),
        plan(fftw_plan_dft_r2c_1d(n, in, out, FFTW_ESTIMATE)) {}
  ~Transform() {
    fftw_destroy_plan(plan);
    fftw_free(out);
    fftw_free(in);
  }
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;
  double* in;
  fftw_complex* out;
  fftw_plan plan;
};

SeaIdentifier::SeaIdentifier(const SeaIdentifierSettings& settings)
    : settings_(settings),
      transform_(std::make_unique<Transform>(settings.block)),
      ring_(static_cast<std::size_t>(settings.block)),
      until_next_(settings.every),
      density_(Eigen::VectorXd::Zero(settings.block / 2 + 1)),
      model_(unknown_sea(settings.order, settings.accel_noise_m2ps3)) {}

SeaIdentifier::~SeaIdentifier() = default;

void SeaIdentifier::gap() {
  has_last_ = false;
  filled_ = 0;
}

bool SeaIdentifier::add(const PathIncrement& increment) {
  if (has_last_) {
    // p(k+1) - 2 p(k) + p(k-1) from the two intervals' increments from rest.
    ring_[next_] = kDt * last_.speed_mps + increment.path_m - last_.path_m;
    next_ = (next_ + 1) % ring_.size();
    filled_ = std::min(filled_ + 1, ring_.size());
  }
  last_ = increment;
  has_last_ = true;
  if (--until_next_ > 0 || filled_ < kShortest) return false;
  until_next_ = settings_.every;
  periodogram();
  identify();
  return true;
}

void SeaIdentifier::periodogram() {
  const std::size_t n = ring_.size(), m = filled_;
  double mean = 0;
  for (std::size_t i = 0; i < m; ++i) mean += ring_[(next_ + n - m + i) % n];
  mean /= static_cast<double>(m);
  double power = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w =
        i < m ? 1 - std::cos(2 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(m))
              : 0;
    transform_->in[i] = i < m ? w * (ring_[(next_ + n - m + i) % n] - mean) : 0;
    power += w * w;
  }
  fftw_execute(transform_->plan);
  // A short first block is coarse and counts for little once longer ones come.
  const double fresh = std::pow(static_cast<double>(m) / static_cast<double>(n), 3);
  const double kept = settings_.memory_s > 0 ? std::exp(-settings_.every * kDt / settings_.memory_s) : 1;
  weight_ = kept * weight_ + fresh;
  const double share = fresh / weight_;
  for (Eigen::Index i = 0; i < density_.size(); ++i) {
    const fftw_complex& c = transform_->out[i];
    density_[i] += share * (kDt * (c[0] * c[0] + c[1] * c[1]) / power - density_[i]);
  }
  ++periodograms_;
}

void SeaIdentifier::identify() {
  const Eigen::Index bins = density_.size();
  const double df = 1 / (kDt * settings_.block);
  Eigen::VectorXd noise(bins),
      level(bins);  // level: X in terms of white acceleration noise, lightly smoothed
  for (Eigen::Index i = 0; i < bins; ++i)
    noise[i] = noise_shape(2 * std::numbers::pi * df * kDt * static_cast<double>(i));
  const Eigen::VectorXd raw = density_.cwiseQuotient(noise);
  for (Eigen::Index i = 0; i < bins; ++i) {
    const Eigen::Index a = std::max<Eigen::Index>(i - 1, 1), b = std::min(i + 1, bins - 1);
    level[i] = raw.segment(a, b - a + 1).mean();
  }
  // The quietest stretch below 0.12 Hz is noise, and what stands out above it sea.
  const auto bin_of = [&](double f_hz) {
    return std::clamp<Eigen::Index>(std::lround(f_hz / df), 1, bins - 1);
  };
  const Eigen::Index lowest = bin_of(kLowestSea_hz);
  const double quiet =
      std::max(level.segment(2, bin_of(0.12) - 1).minCoeff(), 1e-3 * settings_.accel_noise_m2ps3);
  Eigen::Index sea = lowest;
  while (sea < bins - 1 && !(level[sea] > kStandsOut * quiet && level[sea + 1] > kStandsOut * quiet)) ++sea;
  const Eigen::Index edge = std::max<Eigen::Index>(sea - 1, 3);
  const double q = std::max(raw.segment(2, edge - 2).mean(), 0.05 * settings_.accel_noise_m2ps3);

  Eigen::VectorXd density = Eigen::VectorXd::Zero(bins);
  for (Eigen::Index i = edge; i < bins; ++i)
    density[i] = std::max(density_[i] - q * noise[i], 0.0) /
                 heave_gain(2 * std::numbers::pi * df * kDt * static_cast<double>(i));
  SeaModel model = model_of_density(density, df, settings_.order);
  if (model.heave_variance_m2() < kLeastSea * kUnknownSea_m2) {  // calm: whatever comes, comes from anywhere
    model = unknown_sea(settings_.order, q);
    model.autocovariance_m2 *= kLeastSea;
    model.innovation_m2 *= kLeastSea;
  }
  model.accel_noise_m2ps3 = q;
  model.bias_walk_m2ps5 = q * kBiasCorner_radps * kBiasCorner_radps;
  model_ = model;
}

}  // namespace waverig::estimator
