// An estimated heave against the true one, sample by sample, in constant memory.
#pragma once
#include "estimator/types.h"

namespace waverig::evaluation {

class HeaveComparison {
 public:
  // true_rate_mps: rate of the true heave, for the lag. sigma_m: what the estimate states of itself, NaN if
  // nothing.
  void add(double heave_m, double true_heave_m, double true_rate_mps, double sigma_m = estimator::kUnknown);

  double samples() const { return n_; }
  double rmse_m() const;  // mean difference removed; NaN without samples
  double true_std_m() const;
  // Least squares of the estimate on the true heave and its rate. Of a harmonic of rate w this is exact:
  // heave = a true + b rate with a = G cos(w lag), b = -G sin(w lag) / w; in a sea w is that of Tm02.
  double gain() const;
  double lag_s() const;        // positive: the estimate comes late
  double sigma_ratio() const;  // rms of (error without its mean) over the stated sigma

 private:
  struct Regression {
    double a, b, w;  // w^2 = variance of the rate / variance of the heave
  };
  Regression regression() const;

  double n_ = 0, e_ = 0, ee_ = 0, h_ = 0, t_ = 0, r_ = 0, tt_ = 0, rr_ = 0, tr_ = 0, ht_ = 0, hr_ = 0;
  double weight_ = 0, weighted_e_ = 0, weighted_ee_ = 0, stated_ = 0;  // weighted with 1 / sigma^2
};

}  // namespace waverig::evaluation
