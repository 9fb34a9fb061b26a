#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/accuracy.h"
#include "render/figures/settings.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::CellResult;

namespace {

constexpr double kReadable = 5;  // the longest bars of two methods on one scale differ by no more

}  // namespace

Figure uncertainty_budget_figure(const CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  Figure figure{.title = "Uncertainty budget of the mean wave height",
                .subtitle =
                    "standard uncertainties (k = 1) after the GUM; A: "
                    "from repeats, B: from knowledge beforehand",
                .columns = 1};
  std::size_t rows = 0;
  std::vector<double> longest_mm;  // a method
  // The settings that span the campaign: at most four, or the bars become
  // hairs.
  std::vector<Setting> shown;
  if (settings.size() <= 4)
    shown = settings;
  else {
    const Grid grid(settings);
    for (const double period : {grid.periods_s.front(), grid.periods_s.back()}) {
      for (const double height : {grid.heights_m.front(), grid.heights_m.back()}) {
        const Setting s{period, height};
        if (std::find(settings.begin(), settings.end(), s) != settings.end() &&
            std::find(shown.begin(), shown.end(), s) == shown.end())
          shown.push_back(s);
      }
    }
  }
  for (const std::string& method : methods) {
    std::vector<std::string> names;
    for (const Setting& s : shown) {
      const CellResult* c = cell_of(results, s, method);
      if (c == nullptr) continue;
      for (const evaluation::Contribution& part : c->statistics.budget) {
        const std::string name = fmt::format("{} ({})", part.name, part.type);
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
    if (names.empty()) continue;
    names.emplace_back("combined");
    Panel panel{.title = method,
                .x = {.label = "Standard uncertainty of the mean height", .unit = "mm"},
                .legend = Legend::kAbove};
    panel.y.categories.assign(names.rbegin(), names.rend());  // the first on top
    longest_mm.push_back(0);
    const double step = 0.8 / static_cast<double>(shown.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const CellResult* c = cell_of(results, shown[i], method);
      if (c == nullptr || c->statistics.budget.empty()) continue;
      Bars bars{.name = fmt::format("{:g} s, {:g} cm", shown[i].period_s, cm(shown[i].height_m)),
                .look = {.color = static_cast<int>(i)},
                .width = 0.9 * step,
                .horizontal = true};
      const auto add = [&](const std::string& name, double sigma_m) {
        const auto at =
            static_cast<double>(std::find(panel.y.categories.begin(), panel.y.categories.end(), name) -
                                panel.y.categories.begin());
        bars.at.push_back(at + 0.4 - (static_cast<double>(i) + 0.5) * step);
        bars.value.push_back(1000 * sigma_m);
        longest_mm.back() = std::max(longest_mm.back(), bars.value.back());
      };
      double square = 0;
      for (const evaluation::Contribution& part : c->statistics.budget) {
        add(fmt::format("{} ({})", part.name, part.type), part.sigma_m);
        square += part.sigma_m * part.sigma_m;
      }
      add("combined", std::sqrt(square));
      panel.marks.emplace_back(std::move(bars));
    }
    if (!figure.panels.empty()) panel.legend = Legend::kNone;
    rows += names.size();
    figure.row_heights.push_back(static_cast<double>(names.size()));
    figure.panels.push_back(std::move(panel));
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
  figure.height_mm = std::clamp(
      30 + 24 * static_cast<double>(figure.panels.size()) + 6.5 * static_cast<double>(rows), 60.0, 240.0);
  return figure;
}

}  // namespace waverig::render
