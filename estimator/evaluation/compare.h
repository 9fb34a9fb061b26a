// Two campaigns of the same settings, cell by cell: is the candidate better, worse, or is the difference
// within what the two state of their own uncertainty?
#pragma once
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"

namespace waverig::evaluation {

// Whether the set height is Hm0 of an irregular sea. Where the results do not say it (of an older version) it
// is guessed from the true heave: of regular waves four standard deviations are sqrt(2) heights, of a sea
// that is not all too short nearly one.
inline bool is_sea(const CellResult& cell) {
  return cell.motion == Motion::kUnknown ? cell.true_hm0_m < 1.3 * cell.height_m
                                         : cell.motion == Motion::kSea;
}

// kUnknown: they differ, and one of them does not state its uncertainty.
enum class Verdict { kBetter, kWorse, kNotSignificant, kUnknown, kOnlyInBaseline, kOnlyInCandidate };

// One quantity of a cell; smaller is better. sigma: standard uncertainty of the difference, k = 1.
struct Difference {
  double baseline = estimator::kUnknown, candidate = estimator::kUnknown, sigma = estimator::kUnknown;
  Verdict verdict = Verdict::kNotSignificant;
};

struct CellComparison {
  double period_s = 0;
  double height_m = 0;
  std::string method;
  // |mean - true mean| (set height where the truth is unknown). Its uncertainty: the expanded uncertainties
  // / 2.
  Difference mean_error_m{};
  // Standard deviation of single waves; on irregular seas, whose waves differ by nature, the rms of their
  // errors. Its uncertainty: std / sqrt(2 (n - 1)), of normal scatter; on seas as of heave_rmse_m.
  Difference std_m{};
  // |Hm0 - true Hm0| of a sea, where the method tells one of waves enough. Its uncertainty: what the method
  // states.
  Difference hm0_error_m{};
  // Rms of the heave's error on a sea. Its uncertainty: the scatter over the repeats, of which each campaign
  // needs two; where one has fewer it is shown and does not count.
  Difference heave_rmse_m{};
  Verdict verdict =
      Verdict::kNotSignificant;  // worse if any is, else unknown if any is, else better if any is
};

// A difference is significant where it exceeds two standard uncertainties (k = 2); where repeats tell them,
// which are few, as many as leave no more to chance (Student; GUM, table G.2). Cells are matched by period,
// height and method, in the order of the baseline, then what only the candidate has.
std::vector<CellComparison> compare_cells(std::span<const CellResult> baseline,
                                          std::span<const CellResult> candidate);

bool any_common(std::span<const CellComparison> cells);  // in both campaigns
bool any_worse(std::span<const CellComparison> cells);
const char* name_of(Verdict verdict);
std::string comparison_csv(std::span<const CellComparison> cells);
std::string comparison_table(std::span<const CellComparison> cells);  // for people

}  // namespace waverig::evaluation
