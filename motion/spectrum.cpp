#include "motion/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"
#include "motion/kinematics/frames.h"

namespace waverig::motion {
namespace {

void require(bool good, const char* key, double value, const char* expected) {
  if (!good) throw UserError(fmt::format("sea: {} = {} is not {}", key, value, expected));
}

}  // namespace

WaveSpectrum::WaveSpectrum(SpectrumShape shape, double hm0_m, double tp_s, double gamma)
    : fp_Hz_(1 / tp_s), gamma_(shape == SpectrumShape::kJonswap ? gamma : 1) {
  require(std::isfinite(hm0_m) && hm0_m > 0, "hm0_m", hm0_m, "a positive height in metres");
  require(std::isfinite(tp_s) && tp_s > 0, "tp_s", tp_s, "a positive period in seconds");
  require(std::isfinite(gamma) && gamma >= 1 && gamma <= 20, "gamma", gamma, "between 1 and 20");
  scale_ = hm0_m * hm0_m / 16 / variance_between(0, 30 * fp_Hz_);
}

double WaveSpectrum::shape(double f_Hz) const {
  if (f_Hz <= 0) return 0;
  const double x = f_Hz / fp_Hz_, sigma = x <= 1 ? 0.07 : 0.09;
  const double x4 = x * x * x * x, z = (x - 1) / sigma;
  const double peak = gamma_ == 1 ? 1 : std::pow(gamma_, std::exp(-0.5 * z * z));
  return std::exp(-1.25 / x4) / (x4 * x) * peak;
}

double WaveSpectrum::variance_between(double f0_Hz, double f1_Hz) const {
  // Midpoint rule, fine against the peak's width of 0.07 fp.
  const int n = std::max(4, static_cast<int>(std::ceil((f1_Hz - f0_Hz) / (0.002 * fp_Hz_))));
  const double df = (f1_Hz - f0_Hz) / n;
  double sum = 0;
  for (int i = 0; i < n; ++i) sum += density(f0_Hz + (i + 0.5) * df);
  return sum * df;
}

double SeaMoments::hm0_m() const { return 4 * std::sqrt(m0); }
double SeaMoments::tm01_s() const { return m0 / m1; }
double SeaMoments::tm02_s() const { return std::sqrt(m0 / m2); }
double SeaMoments::tm_10_s() const { return m_minus1 / m0; }

double significant_steepness(double tp_s, double hm0_m) {
  return 2 * std::numbers::pi * hm0_m / (kStandardGravity * tp_s * tp_s);
}

double largest_hm0_m(double tp_s) {
  const double t = std::clamp((tp_s - 8) / (15 - 8), 0.0, 1.0);
  const double steepness = 1.0 / 15 + t * (1.0 / 25 - 1.0 / 15);
  return steepness / significant_steepness(tp_s, 1);
}

std::optional<std::string> too_steep(double tp_s, double hm0_m) {
  const double largest_m = largest_hm0_m(tp_s);
  if (hm0_m <= largest_m) return std::nullopt;
  return fmt::format("a sea of Tp = {} s carries at most Hm0 = {:.3g} m (DNV-RP-C205), not {} m", tp_s,
                     largest_m, hm0_m);
}

}  // namespace waverig::motion
