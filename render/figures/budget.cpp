#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/accuracy.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

constexpr double kReadable = 5;          // the longest bars of two methods on one scale differ by no more
constexpr double kHairline = 1.0 / 500;  // of the longest bar: a row of shorter ones is left out

// The settings that span the campaign: at most four, or the bars become hairs.
std::vector<Setting> shown_of(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  if (settings.size() <= 4) return settings;
  std::vector<Setting> shown;
  const Grid grid(settings);
  for (const double period : {grid.periods_s.front(), grid.periods_s.back()}) {
    for (const double height : {grid.heights_m.front(), grid.heights_m.back()}) {
      const Setting s{period, height};
      if (std::ranges::find(settings, s) != settings.end() && std::ranges::find(shown, s) == shown.end())
        shown.push_back(s);
    }
  }
  return shown;
}

// One bar a setting; a setting that says nothing of this contribution has none.
struct Row {
  std::string name;
  std::vector<double> sigma_mm;
  double longest_mm() const {
    double longest = 0;
    for (const double sigma : sigma_mm) longest = std::max(longest, std::isfinite(sigma) ? sigma : 0);
    return longest;
  }
  bool operator==(const Row& other) const {
    return name == other.name && std::ranges::equal(sigma_mm, other.sigma_mm, [](double a, double b) {
             return a == b || (std::isnan(a) && std::isnan(b));
           });
  }
};

// What the estimator adds, and last all together; empty where a method has no budget.
std::vector<Row> rows_of(const CampaignResults& results, const std::vector<Setting>& shown,
                         const std::string& method) {
  const bool seas = are_seas(results);
  std::vector<Row> rows;
  Row combined{"combined", std::vector<double>(shown.size(), kAuto)};
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const CellResult* c = cell_of(results, shown[i], method);
    if (c == nullptr || c->statistics.budget.empty()) continue;
    double square = 0;
    for (const evaluation::Contribution& part : c->statistics.budget) {
      if (seas && part.type == 'A')
        continue;  // how the heights of a sea differ, not how well they are measured
      const std::string name = fmt::format("{} ({})", part.name, part.type);
      auto row = std::ranges::find(rows, name, &Row::name);
      if (row == rows.end()) row = rows.insert(rows.end(), {name, std::vector<double>(shown.size(), kAuto)});
      row->sigma_mm[i] = 1000 * part.sigma_m;
      square += part.sigma_m * part.sigma_m;
    }
    combined.sigma_mm[i] = 1000 * std::sqrt(square);
  }
  std::erase_if(rows, [&](const Row& row) { return row.longest_mm() <= kHairline * combined.longest_mm(); });
  if (!rows.empty()) rows.push_back(std::move(combined));
  return rows;
}

}  // namespace

Figure uncertainty_budget_figure(const CampaignResults& results) {
  Figure figure{
      .title = "Uncertainty budget of the mean wave height",
      .subtitle = are_seas(results)
                      ? "standard uncertainties (k = 1) after the GUM, B: from knowledge beforehand; how the "
                        "sea's own waves differ is left out"
                      : "standard uncertainties (k = 1) after the GUM; A: from the scatter of single waves, "
                        "B: from knowledge beforehand",
      .columns = 1};
  const std::vector<Setting> shown = shown_of(results);
  std::vector<std::vector<Row>> budgets;  // a panel
  std::string without;
  bool any_unknown = false;
  for (const std::string& method : methods_of(results)) {
    std::vector<Row> rows = rows_of(results, shown, method);
    if (rows.empty()) {
      without += (without.empty() ? "" : ", ") + method;
      continue;
    }
    if (const auto same = std::ranges::find(budgets, rows); same != budgets.end()) {
      figure.panels[static_cast<std::size_t>(same - budgets.begin())].title += ", " + method;
      continue;
    }
    Panel panel{.title = method,
                .x = {.label = "Standard uncertainty of the mean height", .unit = "mm"},
                .legend = budgets.empty() ? Legend::kAbove : Legend::kNone};
    const double step = 0.8 / static_cast<double>(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      Bars bars{
          .name = fmt::format("{:g} s, {:g} cm", shown[i].period_s, cm(shown[i].height_m)),
          .look = {.ramp =
                       shown.size() < 2 ? 0 : static_cast<double>(i) / static_cast<double>(shown.size() - 1)},
          .width = 0.9 * step,
          .horizontal = true};
      for (std::size_t r = 0; r < rows.size(); ++r) {  // the first on top
        const double sigma_mm = rows[r].sigma_mm[i];
        bars.at.push_back(static_cast<double>(rows.size() - 1 - r) + 0.4 -
                          (static_cast<double>(i) + 0.5) * step);
        bars.value.push_back(std::isfinite(sigma_mm) ? sigma_mm : 0);  // the legend is of all panels
        if (std::isfinite(sigma_mm)) continue;
        panel.marks.emplace_back(Note{
            .x = 0, .y = bars.at.back() + 0.5 * step, .text = "\u2013", .in_data = true, .color = kFaintInk});
        any_unknown = true;
      }
      panel.marks.emplace_back(std::move(bars));
    }
    for (auto row = rows.rbegin(); row != rows.rend(); ++row) panel.y.categories.push_back(row->name);
    figure.row_heights.push_back(static_cast<double>(rows.size()));
    figure.panels.push_back(std::move(panel));
    budgets.push_back(std::move(rows));
  }
  std::vector<double> longest_mm;  // a panel
  std::size_t rows = 0;
  for (const std::vector<Row>& budget : budgets) {
    longest_mm.push_back(budget.back().longest_mm());
    rows += budget.size();
  }
  // One scale for all methods, unless that leaves the bars of one too short to read.
  if (!longest_mm.empty()) {
    const auto [least, most] = std::minmax_element(longest_mm.begin(), longest_mm.end());
    figure.share_x = *most <= kReadable * *least;
    if (!figure.share_x) figure.subtitle += "; each method on a scale of its own";
    for (std::size_t i = 0; i < figure.panels.size(); ++i) {
      figure.panels[i].x.low = 0;
      figure.panels[i].x.high = 1.05 * (figure.share_x ? *most : longest_mm[i]);
    }
  }
  if (any_unknown) figure.subtitle += "; \u2013 not known";
  if (!without.empty()) figure.subtitle += "; no budget of " + without;
  figure.height_mm = std::clamp(
      30 + 24 * static_cast<double>(figure.panels.size()) + 6.5 * static_cast<double>(rows), 60.0, 240.0);
  return figure;
}

}  // namespace waverig::render
