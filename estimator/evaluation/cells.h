// From judged runs to cells: a row of results.csv for each setting and method.
#pragma once
#include <span>
#include <vector>

#include "estimator/evaluation/height_statistics.h"
#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// Period, height, method, repeat, name: the order in which runs are pooled and written, whoever ran first.
bool earlier(const RunResult& a, const RunResult& b);

// Pools runs that come in that order, in memory that grows with the cells only.
class CellPooling {
 public:
  void add(const RunResult& run);
  std::vector<CellResult> finish();

 private:
  // Mean of the values that are known.
  struct Mean {
    double count = 0, sum = 0;
    void add(double value);
    double value() const;
  };
  // Mean of angles, as unit vectors; unknown where they are spread so far round that there is none.
  struct MeanAngle {
    Mean north, east;
    void add(double angle_rad);
    double value() const;
  };
  // Mean of the runs' responses as complex numbers: one upside down and one upright do not come to a gain of
  // one.
  struct MeanResponse {
    Mean in_phase, late, period_s;
    void add(const RunResult& run);
    double gain() const;
    double lag_s() const;
  };
  struct MeanSea {
    Mean duration, hm0, hm0_variance, hm0_systematic, tp, tm01, tm02, tm_10, h13, h110, hmax, spread, check, true_hm0,
        true_tm02, true_spread, true_check;
    MeanAngle direction, peak_direction, true_direction;
    std::int32_t flags = 0;
    void add(const JudgedSea& sea);
    JudgedSea value() const;
  };
  void close();

  bool open_ = false;
  CellResult cell_;
  HeightAccumulator heights_;
  Mean bound_square_, heave_square_, heave_bound_square_, true_hm0_, sigma_ratio_, direction_error_,
      direction_square_;
  MeanResponse response_;
  MeanSea sea_;
  std::int32_t flags_ = 0;  // of whole runs
  std::vector<CellResult> cells_;
};

// The same for runs that are all at hand, in any order.
std::vector<CellResult> cells_of(std::span<const RunResult> runs);

// How far the rms of each cell, of the heave's error and of the single waves', is left to chance: from its
// runs.
void tell_scatter(std::span<CellResult> cells, std::span<const RunResult> runs);

}  // namespace waverig::evaluation
