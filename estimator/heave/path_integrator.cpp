#include "estimator/heave/path_integrator.h"

namespace waverig::estimator {

void PathIntegrator::start(std::int64_t utime, double a_mps2) {
  node_utime_ = last_utime_ = utime;
  last_a_mps2_ = a_mps2;
  last_length_s_ = 0;
  partial_ = {};
}

PathIntegrator::Segment PathIntegrator::segment_to(std::int64_t utime, double a_mps2) const {
  const double h = 1e-6 * static_cast<double>(utime - last_utime_);
  const double slope = (a_mps2 - last_a_mps2_) / h;
  // Newton's divided differences; a straight line while there are only two samples.
  const double c2 = last_length_s_ > 0 ? (slope - last_slope_) / (h + last_length_s_) : 0.0;
  return {last_a_mps2_, slope - c2 * h, c2, h};
}

void PathIntegrator::advance(const Segment& g, double from_s, double to_s) {
  const double h = to_s - from_s;
  const double a = g.c0 + from_s * (g.c1 + from_s * g.c2), b = g.c1 + 2 * g.c2 * from_s;  // about from_s
  partial_.path_m += h * (partial_.speed_mps + h * (a / 2 + h * (b / 6 + h * g.c2 / 12)));
  partial_.speed_mps += h * (a + h * (b / 2 + h * g.c2 / 3));
}

void PathIntegrator::accept(std::int64_t utime, double a_mps2, const Segment& g) {
  last_slope_ = (a_mps2 - last_a_mps2_) / g.length_s;
  last_length_s_ = g.length_s;
  last_a_mps2_ = a_mps2;
  last_utime_ = utime;
}

}  // namespace waverig::estimator
