#include "estimator/evaluation/heave_bound.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

#include "estimator/real_transform.h"

namespace waverig::evaluation {
namespace {

constexpr std::size_t kNodes = 1 << 16;        // of the transforms: hours, against minutes of memory
constexpr std::ptrdiff_t kBegin = 800;         // until path and speed are known as in an endless record
constexpr std::ptrdiff_t kWholeLag = 1 << 12;  // what is later tells nothing
constexpr int kFolds = 4;  // multiples of the nodes' rate from which density is folded back

using Sequence = std::vector<double>;

// Of an even real function of frequency, given at k = 0 … kNodes / 2: sum over all k of x_k e^(i 2 pi k n /
// kNodes) / kNodes.
Sequence sequence_of_even(const Sequence& half) {
  estimator::RealTransform transform(kNodes);
  for (std::size_t k = 0; k < kNodes; ++k) transform.in()[k] = half[std::min(k, kNodes - k)];
  transform.execute();
  Sequence sequence(kNodes);
  for (std::size_t n = 0; n < kNodes; ++n) sequence[n] = transform[std::min(n, kNodes - n)].real() / kNodes;
  return sequence;
}

// The same of a function whose value at -k is the conjugate of that at k. Its real part is even, its
// imaginary part odd, and so are what they make of n: one transform of their sum holds both apart.
Sequence sequence_of(const std::vector<std::complex<double>>& half) {
  estimator::RealTransform transform(kNodes);
  for (std::size_t k = 0; k <= kNodes / 2; ++k) {
    transform.in()[k] = half[k].real() + half[k].imag();
    if (k > 0) transform.in()[kNodes - k] = half[k].real() - half[k].imag();
  }
  transform.execute();
  Sequence sequence(kNodes);
  for (std::size_t n = 0; n <= kNodes / 2; ++n) {
    sequence[n] = (transform[n].real() + transform[n].imag()) / kNodes;
    if (n > 0) sequence[kNodes - n] = (transform[n].real() - transform[n].imag()) / kNodes;
  }
  return sequence;
}

// B of Phi = |B|^2: the logarithm's sequence, folded onto n >= 0, is that of log B.
std::vector<std::complex<double>> causal_factor(const Sequence& density) {
  Sequence logarithm(density.size());
  std::ranges::transform(density, logarithm.begin(), [](double x) { return std::log(x); });
  const Sequence cepstrum = sequence_of_even(logarithm);
  estimator::RealTransform transform(kNodes);
  std::ranges::fill(transform.in(), 0.0);
  transform.in()[0] = cepstrum[0] / 2;
  std::copy_n(cepstrum.begin() + 1, kNodes / 2 - 1, transform.in().begin() + 1);
  transform.in()[kNodes / 2] = cepstrum[kNodes / 2] / 2;
  transform.execute();
  std::vector<std::complex<double>> factor(kNodes / 2 + 1);
  for (std::size_t k = 0; k < factor.size(); ++k) factor[k] = std::exp(transform[k]);
  return factor;
}

// Two-sided density of what a one-sided density is on the nodes, over their interval.
double on_nodes(const HeaveBoundSettings& settings, double f_hz) {
  double sum = 0;
  for (int fold = -kFolds; fold <= kFolds; ++fold)
    sum += settings.density_m2_per_hz(std::abs(f_hz + fold / settings.interval_s)) / 2;
  return sum / settings.interval_s;
}

// Two-sided, m^2/s^3.
double bias_density(const HeaveBoundSettings& settings, double w_radps) {
  const double corner = w_radps * settings.instability_time_s;
  return 2 * settings.instability_sigma_mps2 * settings.instability_sigma_mps2 * settings.instability_time_s /
         (1 + corner * corner);
}

}  // namespace

HeaveBound::HeaveBound(const HeaveBoundSettings& settings) : interval_s_(settings.interval_s) {
  const double noise = settings.noise_density_mps2_rthz, dt = interval_s_;
  if (!(std::isfinite(noise) && noise > 0 && dt > 0)) return;
  const double q = noise * noise / 2;
  Sequence phi_yy(kNodes / 2 + 1);
  std::vector<std::complex<double>> phi_zy(kNodes / 2 + 1);
  double heave = 0, whole = 0;
  for (std::size_t k = 0; k < phi_yy.size(); ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / kNodes;  // w dt
    const double sea = on_nodes(settings, static_cast<double>(k) / (kNodes * dt));
    const double mean = angle > 0 ? 2 * std::sin(angle / 2) / angle : 1;  // of a slow wave over an interval
    const double drift =
        dt * dt * dt *
        (q * (2 + std::cos(angle)) / 3 + std::pow(mean, 4) * bias_density(settings, angle / dt));
    const std::complex<double> once = 1.0 - std::polar(1.0, -angle);
    phi_yy[k] = std::norm(once * once) * sea + drift;
    phi_zy[k] = std::conj(once * once) * sea;
    const double both_sides = k == 0 || k == kNodes / 2 ? 1 : 2;
    heave += both_sides * sea;
    whole += both_sides * sea * drift / phi_yy[k];  // S Sn / (S + Sn)
  }
  heave_m2_ = heave / kNodes;
  whole_m2_ = whole / kNodes;

  const std::vector<std::complex<double>> factor = causal_factor(phi_yy);
  std::vector<std::complex<double>> on_innovations(phi_zy.size());
  for (std::size_t k = 0; k < phi_zy.size(); ++k) on_innovations[k] = phi_zy[k] / std::conj(factor[k]);
  const Sequence g = sequence_of(on_innovations);
  lagged_m2_.assign(kWholeLag + 1, whole_m2_);
  double missed = 0;
  for (std::size_t n = kNodes / 2 - 1; n > 0; --n) {  // g(-n) is missed by lags below n
    missed += g[kNodes - n] * g[kNodes - n];
    if (n <= kWholeLag) lagged_m2_[n - 1] += missed;
  }

  heave_y_m2_ = sequence_of(phi_zy);
  const Sequence covariance = sequence_of_even(phi_yy);
  y_factor_.resize(kBegin, kBegin);
  for (std::ptrdiff_t i = 0; i < kBegin; ++i)
    for (std::ptrdiff_t j = 0; j <= i; ++j) y_factor_(i, j) = covariance[static_cast<std::size_t>(i - j)];
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> in_place(y_factor_);
  if (in_place.info() != Eigen::Success) y_factor_.setConstant(estimator::kUnknown);  // noise below rounding
}

std::ptrdiff_t HeaveBound::nodes_of(double lag_s) const {
  return lag_s < kWholeLag * interval_s_ ? std::llround(lag_s / interval_s_) : kWholeLag;
}

double HeaveBound::variance_m2(std::ptrdiff_t lag) const {
  return lagged_m2_.empty() ? estimator::kUnknown : lagged_m2_[static_cast<std::size_t>(lag)];
}

// Of the record's first nodes 0, 1, …, over that in an endless record: y(2) … y(node + lag) are known. With y
// taken backwards from the newest, their covariance is Toeplitz, and each older one takes the square of one
// more element of L^-1 cov(z, y) off the sea's variance.
std::vector<double> HeaveBound::begin_excess_m2(std::ptrdiff_t lag) const {
  std::vector<double> excess;
  if (lag > kBegin / 2) {  // all that follows is known: the begin is an end, seen backwards
    for (std::ptrdiff_t node = 0; node < kBegin; ++node)
      excess.push_back(variance_m2(node) - variance_m2(kWholeLag));
    return excess;
  }
  Eigen::VectorXd known(kBegin);
  for (std::ptrdiff_t n = 0; n < kBegin; ++n) {
    const std::ptrdiff_t behind = n - lag;
    known[n] = heave_y_m2_[behind < 0 ? kNodes - static_cast<std::size_t>(-behind)
                                      : static_cast<std::size_t>(behind)];
  }
  y_factor_.triangularView<Eigen::Lower>().solveInPlace(known);
  const double steady = variance_m2(lag);
  double left = heave_m2_;
  if (lag == 0) excess.push_back(left - steady);
  for (std::ptrdiff_t used = 0; used < kBegin; ++used) {
    if (used + 1 >= lag) excess.push_back(left - steady);  // of node used + 1 - lag
    left -= known[used] * known[used];
  }
  return excess;
}

double HeaveBound::heave_std_m() const { return std::sqrt(heave_m2_); }

double HeaveBound::steady_m(double lag_s) const { return std::sqrt(variance_m2(nodes_of(lag_s))); }

double HeaveBound::record_m(double lag_s, double duration_s, double from_s) const {
  if (lagged_m2_.empty()) return estimator::kUnknown;
  const std::ptrdiff_t lag = nodes_of(lag_s), last = std::llround(duration_s / interval_s_);
  const std::vector<double> begin = begin_excess_m2(lag);
  double sum = 0, nodes = 0;
  for (std::ptrdiff_t node = std::llround(from_s / interval_s_); node <= last; ++node, ++nodes) {
    sum += variance_m2(std::min(lag, last - node));  // what is after it
    if (node < std::ssize(begin)) sum += std::max(begin[static_cast<std::size_t>(node)], 0.0);
  }
  return std::sqrt(sum / nodes);
}

}  // namespace waverig::evaluation
