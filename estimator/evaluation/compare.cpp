#include "estimator/evaluation/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lcmtypes/flags.h"

namespace waverig::evaluation {
namespace {

double mean_error_m(const CellResult& cell) {
  const HeightStatistics& s = cell.statistics;
  const double reference = std::isfinite(s.mean_true_height_m) ? s.mean_true_height_m : cell.height_m;
  return std::abs(s.mean_height_m - reference);
}

double hm0_error_m(const CellResult& cell) {
  const bool told = is_sea(cell) && (cell.sea.sea.flags & flag::kTooFewWaves) == 0;
  return told ? std::abs(cell.sea.sea.hm0_m - cell.sea.true_hm0_m) : estimator::kUnknown;
}

double scatter_m(const CellResult& cell) {
  return is_sea(cell) ? cell.statistics.rmse_m : cell.statistics.std_m;
}

double std_sigma_m(const CellResult& cell) {
  const std::int64_t waves = cell.statistics.waves;
  return waves > 1 ? cell.statistics.std_m / std::sqrt(2.0 * static_cast<double>(waves - 1))
                   : estimator::kUnknown;
}

double heave_rmse_m(const CellResult& cell) { return is_sea(cell) ? cell.heave_rmse_m : estimator::kUnknown; }

// What a number's repeats tell of its standard uncertainty.
struct OfRepeats {
  double sigma_m;
  int runs;
};

// What k = 2 is of infinitely many repeats, of few: Abramowitz and Stegun, eq. (26.7.5), at a normal deviate
// of 2. Degrees of freedom after Welch and Satterthwaite (GUM, eq. G.2b).
double coverage_factor(const OfRepeats& a, const OfRepeats& b) {
  const double ua = std::pow(a.sigma_m, 2), ub = std::pow(b.sigma_m, 2);
  const double x = (ua * ua / (a.runs - 1) + ub * ub / (b.runs - 1)) / std::pow(ua + ub, 2);
  return kCoverageFactor + x * (2.5 + x * (3.0625 + x * (2.859 + x * 1.844)));
}

Difference judged(double baseline, double candidate, double sigma, double coverage_factor = kCoverageFactor) {
  Difference d{baseline, candidate, sigma, Verdict::kNotSignificant};
  const double change = candidate - baseline;
  if (std::isfinite(baseline) && !std::isfinite(candidate))
    d.verdict = Verdict::kWorse;  // it says nothing any more
  if (!std::isfinite(change) || change == 0) return d;
  if (std::isnan(sigma))
    d.verdict = Verdict::kUnknown;
  else if (std::abs(change) > coverage_factor * sigma)
    d.verdict = change < 0 ? Verdict::kBetter : Verdict::kWorse;
  return d;
}

Difference judged(double baseline, double candidate, const OfRepeats& a, const OfRepeats& b) {
  return judged(baseline, candidate, std::hypot(a.sigma_m, b.sigma_m), coverage_factor(a, b));
}

// The errors of neighbouring waves of a sea go together: so many waves say less than as many numbers would,
// and only the repeats say how much less.
Difference scatter_judged(const CellResult& a, const CellResult& b) {
  if (is_sea(a))
    return judged(scatter_m(a), scatter_m(b), OfRepeats{a.wave_rmse_sigma_m, a.wave_runs},
                  OfRepeats{b.wave_rmse_sigma_m, b.wave_runs});
  return judged(scatter_m(a), scatter_m(b), std::hypot(std_sigma_m(a), std_sigma_m(b)));
}

// Where it takes repeats and there are none, the others decide.
Verdict where_told(Verdict verdict) {
  return verdict == Verdict::kUnknown ? Verdict::kNotSignificant : verdict;
}

CellComparison compared(const CellResult& baseline, const CellResult& candidate) {
  const HeightStatistics &b = baseline.statistics, &c = candidate.statistics;
  CellComparison result{
      .period_s = baseline.period_s, .height_m = baseline.height_m, .method = baseline.method};
  result.mean_error_m =
      judged(mean_error_m(baseline), mean_error_m(candidate),
             std::hypot(b.expanded_uncertainty_m, c.expanded_uncertainty_m) / kCoverageFactor);
  result.std_m = scatter_judged(baseline, candidate);
  result.hm0_error_m = judged(hm0_error_m(baseline), hm0_error_m(candidate),
                              std::hypot(baseline.sea.sea.hm0_sigma_m, candidate.sea.sea.hm0_sigma_m));
  result.heave_rmse_m = judged(heave_rmse_m(baseline), heave_rmse_m(candidate),
                               OfRepeats{baseline.heave_rmse_sigma_m, baseline.heave_runs},
                               OfRepeats{candidate.heave_rmse_sigma_m, candidate.heave_runs});
  const Verdict of_heave = where_told(result.heave_rmse_m.verdict),
                of_scatter = is_sea(baseline) ? where_told(result.std_m.verdict) : result.std_m.verdict;
  for (const Verdict verdict : {Verdict::kWorse, Verdict::kUnknown, Verdict::kBetter})
    if (result.mean_error_m.verdict == verdict || of_scatter == verdict ||
        result.hm0_error_m.verdict == verdict || of_heave == verdict) {
      result.verdict = verdict;
      break;
    }
  return result;
}

bool same_setting(const CellResult& a, const CellResult& b) {
  return std::abs(a.period_s - b.period_s) < 1e-9 && std::abs(a.height_m - b.height_m) < 1e-9 &&
         a.method == b.method;
}

const CellResult* find(std::span<const CellResult> cells, const CellResult& like) {
  const auto at =
      std::find_if(cells.begin(), cells.end(), [&](const CellResult& c) { return same_setting(c, like); });
  return at == cells.end() ? nullptr : &*at;
}

CellComparison alone(const CellResult& cell, Verdict verdict) {
  CellComparison result{.period_s = cell.period_s, .height_m = cell.height_m, .method = cell.method};
  const auto of_one = [verdict](double value) {
    Difference d{.verdict = verdict};
    (verdict == Verdict::kOnlyInBaseline ? d.baseline : d.candidate) = value;
    return d;
  };
  result.mean_error_m = of_one(mean_error_m(cell));
  result.std_m = of_one(scatter_m(cell));
  result.hm0_error_m = of_one(hm0_error_m(cell));
  result.heave_rmse_m = of_one(heave_rmse_m(cell));
  result.verdict = verdict;
  return result;
}

std::string number(double value_m, int precision) {
  return std::isfinite(value_m) ? fmt::format("{:.{}f}", value_m / kCentimetre, precision) : std::string();
}

}  // namespace

std::vector<CellComparison> compare_cells(std::span<const CellResult> baseline,
                                          std::span<const CellResult> candidate) {
  std::vector<CellComparison> result;
  for (const CellResult& cell : baseline) {
    const CellResult* other = find(candidate, cell);
    result.push_back(other != nullptr ? compared(cell, *other) : alone(cell, Verdict::kOnlyInBaseline));
  }
  for (const CellResult& cell : candidate)
    if (find(baseline, cell) == nullptr) result.push_back(alone(cell, Verdict::kOnlyInCandidate));
  return result;
}

bool any_common(std::span<const CellComparison> cells) {
  return std::any_of(cells.begin(), cells.end(), [](const CellComparison& c) {
    return c.verdict != Verdict::kOnlyInBaseline && c.verdict != Verdict::kOnlyInCandidate;
  });
}

bool any_worse(std::span<const CellComparison> cells) {
  return std::any_of(cells.begin(), cells.end(),
                     [](const CellComparison& c) { return c.verdict == Verdict::kWorse; });
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kBetter:
      return "better";
    case Verdict::kWorse:
      return "worse";
    case Verdict::kNotSignificant:
      return "not significant";
    case Verdict::kUnknown:
      return "uncertainty unknown";
    case Verdict::kOnlyInBaseline:
      return "only in baseline";
    case Verdict::kOnlyInCandidate:
      return "new";
  }
  return "";
}

std::string comparison_csv(std::span<const CellComparison> cells) {
  std::string text =
      "period_s,height_cm,method,verdict,baseline_mean_error_cm,mean_error_cm,mean_error_sigma_cm,mean_error_"
      "verdict,"
      "baseline_std_cm,std_cm,std_sigma_cm,std_verdict,"
      "baseline_hm0_error_cm,hm0_error_cm,hm0_error_sigma_cm,hm0_error_verdict,"
      "baseline_heave_rms_cm,heave_rms_cm,heave_rms_sigma_cm,heave_rms_verdict\n";
  const auto columns = [](const Difference& d) {
    return fmt::format(",{},{},{},{}", number(d.baseline, 4), number(d.candidate, 4), number(d.sigma, 4),
                       name_of(d.verdict));
  };
  for (const CellComparison& c : cells)
    text += fmt::format("{:g},{:g},{},{}{}{}{}{}\n", c.period_s, c.height_m / kCentimetre, c.method,
                        name_of(c.verdict), columns(c.mean_error_m), columns(c.std_m), columns(c.hm0_error_m),
                        columns(c.heave_rmse_m));
  return text;
}

std::string comparison_table(std::span<const CellComparison> cells) {
  const auto known = [](const Difference& d) {
    return std::isfinite(d.baseline) || std::isfinite(d.candidate);
  };
  // Columns of seas, where there are any.
  const auto any = [&](Difference CellComparison::*of) {
    return std::any_of(cells.begin(), cells.end(), [&](const CellComparison& c) { return known(c.*of); });
  };
  const bool hm0s = any(&CellComparison::hm0_error_m), heaves = any(&CellComparison::heave_rmse_m);
  const auto column = [](bool shown, std::string_view cell) {
    return shown ? fmt::format(" {:>20}", cell) : std::string();
  };
  std::string text = fmt::format("{:>8} {:>9}  {:<14} {:>20} {:>20}{}{}  {}\n", "period s", "height cm",
                                 "method", "mean error cm", "std cm", column(hm0s, "Hm0 error cm"),
                                 column(heaves, "heave rms cm"), "verdict");
  const auto change = [&](const Difference& d) {
    return known(d) ? fmt::format("{} -> {}", number(d.baseline, 3), number(d.candidate, 3))
                    : std::string("-");
  };
  for (const CellComparison& c : cells)
    text +=
        fmt::format("{:8.1f} {:9.1f}  {:<14} {:>20} {:>20}{}{}  {}\n", c.period_s, c.height_m / kCentimetre,
                    c.method, change(c.mean_error_m), change(c.std_m), column(hm0s, change(c.hm0_error_m)),
                    column(heaves, change(c.heave_rmse_m)), name_of(c.verdict));
  return text;
}

}  // namespace waverig::evaluation
