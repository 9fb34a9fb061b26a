// Statistics and uncertainty budget of single waves: over a run, and over the repeats of a setting.
#pragma once
#include <cstdint>

#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// Takes judged waves one by one in constant memory; close_record() after the last wave of each record.
//
// Budget of the mean height, after the GUM (k = 1 each, combined in quadrature, expanded with k = 2):
//   noise        the waves' own noise sigma / sqrt(n): independent from wave to wave, type B
//   scatter      what the observed standard deviation has beyond that noise, / sqrt(n), type A: the finite
//   number of
//                waves. Noise is not counted twice; where it is unknown the whole scatter stands here.
//   calibration  mean of the waves' sigma: common to all records of one calibration; of a program that states
//   one
//                sigma of its heave and no parts, all of it (zero_crossing.h)
//   tilt         mean of the waves' sigma: common too, since the sensor's errors behind it are
//   frequency    mean of the waves' sigma in a record, independent from record to record
// Where the waves state nothing, the scatter stands in the budget alone and the expanded uncertainty is
// unknown: waves that are all wrong by a tenth scatter by nothing.
class HeightAccumulator {
 public:
  void add(const JudgedWave& wave);
  void close_record();
  // set_height_m: as ordered, for the error rate. bound_std_m: see bound.h.
  HeightStatistics statistics(double set_height_m, double bound_std_m) const;

 private:
  struct KnownMean {  // mean of the finite values only
    std::int64_t count = 0;
    double sum = 0;
    void add(double value);
    double mean() const;
  };

  std::int64_t waves_ = 0;
  double mean_ = 0, squares_ = 0;  // Welford 1962
  double period_sum_ = 0;
  KnownMean true_height_, squared_error_, noise_variance_, calibration_, tilt_, record_frequency_;
  std::int64_t frequency_records_ = 0;
  double frequency_variance_sum_ = 0;  // over records
  std::int32_t flags_ = 0;
};

// 100 |mean - set| / set, REFERENCE section 2.
double error_rate_percent(double mean_height_m, double set_height_m);

}  // namespace waverig::evaluation
