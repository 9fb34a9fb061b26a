// A campaign on irregular seas: there is no single set height to miss, but a true heave and a true sea state.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/kinematics/frames.h"
#include "render/figures/settings.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

double heave_percent(const CellResult& c) { return 100 * c.heave_rmse_m / c.true_hm0_m; }
double bound_percent(const CellResult& c) { return 100 * c.heave_bound_m / c.true_hm0_m; }
double hm0_percent(const CellResult& c) { return 100 * (c.sea.sea.hm0_m / c.sea.true_hm0_m - 1); }
double tm02_percent(const CellResult& c) { return 100 * (c.sea.sea.tm02_s / c.sea.true_tm02_s - 1); }

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return low > high; }
  double largest() const { return std::max(std::abs(low), std::abs(high)); }
};

}  // namespace

std::string sea_answer(const CampaignResults& results) {
  std::string out;
  for (const std::string& method : methods_of(results)) {
    Range heave, hm0, tm02;
    for (const CellResult& cell : results.cells) {
      if (cell.method != method) continue;
      heave.add(heave_percent(cell));
      hm0.add(hm0_percent(cell));
      tm02.add(tm02_percent(cell));
    }
    if (heave.empty() && hm0.empty()) continue;
    out += fmt::format("<li><strong>{}</strong>: ", html_text(method));
    if (!heave.empty())
      out += fmt::format("the heave is off by {} % of Hm0 (rms)", range_text(heave.low, heave.high, 2));
    if (!hm0.empty())
      out += fmt::format("{}Hm0 is within {:.2f} %, Tm02 within {:.2f} % of the true ones",
                         heave.empty() ? "" : "; ", hm0.largest(), tm02.largest());
    out += ".</li>\n";
  }
  return out;
}

std::string sea_results_table(const CampaignResults& results) {
  constexpr std::ptrdiff_t kUncertaintyColumn = 10;  // behind the measured Hm0
  const bool directions = std::any_of(results.cells.begin(), results.cells.end(), [](const CellResult& c) {
    return std::isfinite(c.sea.sea.mean_direction_rad);
  });
  std::vector<std::string> heads = {"Tp s",        "Hm0 cm",  "Method",      "Waves",  "Heave error cm",
                                    "% of Hm0",    "Bound %", "Gain",        "Lag ms", "Hm0 measured",
                                    "Hm0 error %", "Tm02 s",  "Tm02 error %"};
  const bool stated = std::any_of(results.cells.begin(), results.cells.end(),
                                  [](const CellResult& c) { return std::isfinite(c.sea.sea.hm0_sigma_m); });
  if (stated) heads.insert(heads.begin() + kUncertaintyColumn, "\u00B1 (k\u00A0=\u00A02)");
  if (directions) heads.emplace_back("From \u00B0");
  HtmlTable table(
      "The steady parts of all repeats; Tp and Hm0 as set. Heave error: root mean square against the true "
      "heave, also in percent of the true Hm0, and beside it the least that any method can have that tells "
      "heave when this one does, knows the spectrum and is disturbed by nothing but the accelerometer's "
      "noise "
      "and the wandering of its bias (Wiener). Hm0 and Tm02: measured against those of the true heave. A "
      "number leads to the runs behind it.",
      heads);
  const SettingColumns set(results.cells);
  for (const CellResult& cell : results.cells) {
    const std::string link = fmt::format("#{}", cell_id(cell));
    const auto number = [&](double value, int decimals) { return number_cell(value, decimals, link); };
    const estimator::SeaState& sea = cell.sea.sea;
    std::vector<HtmlCell> cells = {set.period(cell),
                                   set.height(cell),
                                   text_cell(cell.method),
                                   number(static_cast<double>(cell.statistics.waves), 0),
                                   number(cm(cell.heave_rmse_m), 2),
                                   number(heave_percent(cell), 2),
                                   number(bound_percent(cell), 2),
                                   number(cell.heave_gain, 4),
                                   number(1000 * cell.heave_lag_s, 1),
                                   number(cm(sea.hm0_m), 2),
                                   number(hm0_percent(cell), 2),
                                   number(sea.tm02_s, 3),
                                   number(tm02_percent(cell), 2)};
    if (stated)
      cells.insert(cells.begin() + kUncertaintyColumn,
                   number(cm(evaluation::kCoverageFactor * sea.hm0_sigma_m), 2));
    if (directions) cells.push_back(number(sea.mean_direction_rad / kDegree, 1));
    table.add_row(std::move(cells));
  }
  return table.html();
}

}  // namespace waverig::render
