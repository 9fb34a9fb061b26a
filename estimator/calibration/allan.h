// Allan deviation of a static record, and the noise terms fitted to it (IEEE Std 952-1997, annex C).
#pragma once
#include <span>
#include <vector>

namespace waverig::estimator {

struct AllanPoint {
  double tau_s = 0;
  double deviation = 0;  // in the record's unit
  double degrees = 0;    // effective number of independent differences
};

// Overlapping Allan deviation at about `per_octave` points an octave, from one sample to a quarter of the
// record. record: rate-like (m/s^2, rad/s), evenly sampled.
std::vector<AllanPoint> allan_deviation(std::span<const double> record, double interval_s,
                                        int per_octave = 2);

// sigma^2(tau) = 3 Q^2/tau^2 + N^2/tau + (2 ln2/pi) B^2 + K^2 tau/3, each term at least zero.
// Units for a record in u: Q u s, N u s^1/2, B u, K u s^-1/2.
struct AllanTerms {
  double quantisation = 0;
  double random_walk = 0;  // N: velocity or angle random walk; white noise of one-sided density N sqrt(2)
  double bias_instability = 0;  // B
  double rate_random_walk = 0;  // K
  double one_sided_density() const;
};

// Weighted least squares with coefficients kept at or above zero. Points in any order; at least 4 are needed
// for all four terms (fewer points give zero terms).
AllanTerms fit_allan(std::span<const AllanPoint> points);

}  // namespace waverig::estimator
