#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "estimator/evaluation/bound.h"
#include "estimator/evaluation/flag_names.h"
#include "estimator/evaluation/height_statistics.h"
#include "estimator/evaluation/results_io.h"

namespace waverig::evaluation {
namespace {

// Mean over the repeats of a value that some of them may not know.
class MeanSquare {
 public:
  void add(double value) {
    if (!std::isfinite(value)) return;
    ++count_;
    sum_ += value * value;
  }
  double root() const { return count_ > 0 ? std::sqrt(sum_ / count_) : estimator::kUnknown; }

 private:
  int count_ = 0;
  double sum_ = 0;
};

void append(fmt::memory_buffer& out, double value) {
  out.push_back(',');
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(out), "{:.4f}", value);
}

}  // namespace

std::vector<CellResult> cells_of(std::span<const RunResult> runs) {
  std::vector<const RunResult*> sorted;
  for (const RunResult& run : runs) sorted.push_back(&run);
  const auto setting = [](const RunResult& r) { return std::tie(r.period_s, r.height_m, r.method); };
  std::stable_sort(sorted.begin(), sorted.end(), [&](const RunResult* a, const RunResult* b) {
    return std::tuple_cat(setting(*a), std::tie(a->repeat, a->run)) <
           std::tuple_cat(setting(*b), std::tie(b->repeat, b->run));
  });
  std::vector<CellResult> cells;
  for (auto first = sorted.begin(); first != sorted.end();) {
    HeightAccumulator heights;
    MeanSquare bound, heave_rmse;
    auto run = first;
    for (; run != sorted.end() && setting(**run) == setting(**first); ++run) {
      for (const JudgedWave& wave : (*run)->waves) heights.add(wave);
      heights.close_record();
      bound.add((*run)->statistics.bound_std_m);
      heave_rmse.add((*run)->heave_rmse_m);
    }
    cells.push_back({(*first)->period_s, (*first)->height_m, (*first)->method,
                     heights.statistics((*first)->height_m, bound.root()), heave_rmse.root()});
    first = run;
  }
  return cells;
}

std::string results_csv(std::span<const CellResult> cells) {
  fmt::memory_buffer out;
  const auto text = std::back_inserter(out);
  fmt::format_to(text,
                 "period_s,height_cm,method,waves,mean_height_cm,error_rate_percent,std_cm,expanded_"
                 "uncertainty_cm,rmse_cm,"
                 "true_height_cm,mean_error_percent,bound_std_cm,heave_rmse_cm,mean_period_s,flags\n");
  for (const CellResult& cell : cells) {
    const HeightStatistics& s = cell.statistics;
    fmt::format_to(text, "{:g},{:g},{},{}", cell.period_s, cell.height_m / kCentimetre, cell.method, s.waves);
    append(out, s.mean_height_m / kCentimetre);
    append(out, s.error_rate_percent);
    append(out, s.std_m / kCentimetre);
    append(out, s.expanded_uncertainty_m / kCentimetre);
    append(out, s.rmse_m / kCentimetre);
    append(out, s.mean_true_height_m / kCentimetre);
    append(out, s.mean_error_percent);
    append(out, s.bound_std_m / kCentimetre);
    append(out, cell.heave_rmse_m / kCentimetre);
    append(out, s.mean_period_s);
    fmt::format_to(text, ",{}\n", fmt::join(flag_names(s.flags), " "));
  }
  return fmt::to_string(out);
}

}  // namespace waverig::evaluation
