#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/accuracy.h"
#include "render/figures/settings.h"
#include "render/marks.h"

namespace waverig::render {

using evaluation::CampaignResults;
using evaluation::RunResult;

Figure single_waves_figure(const CampaignResults& results) {
  constexpr std::size_t kMostSlots = 60;  // settings side by side
  const std::vector<Setting> settings = settings_of(results);
  const std::vector<std::string> methods = methods_of(results);
  const std::vector<double> heights_m = Grid(settings).heights_m;
  // Of regular waves all heights of a setting are one: its waves stand side by side in their order instead.
  // Of many settings those of one height share a slot.
  const bool each = settings.size() <= kMostSlots;
  const bool slots = !are_seas(results) && (each || heights_m.size() <= kMostSlots);
  Figure figure{.title = "Single waves, estimated against true", .columns = 3, .height_mm = 95};
  Panel against{.title = "(a) Against true height",
                .x = {.label = "True height", .unit = "cm"},
                .y = {.label = "Estimated height", .unit = "cm"}};
  Panel residual{.title = slots ? "(b) Estimated less true, wave after wave" : "(b) Estimated less true",
                 .y = {.label = "Estimated \u2212 true", .unit = "cm"},
                 .legend = Legend::kNone,
                 .column_span = 2};
  residual.x = slots && each ? settings_axis(settings, false) : Axis{.label = "True height", .unit = "cm"};
  if (slots && !each) {
    residual.x.label = "Set height";
    for (const double height_m : heights_m)
      residual.x.categories.push_back(fmt::format("{:g}", cm(height_m)));
  }
  residual.marks.emplace_back(
      Rule{.at = 0, .look = {.color = kFaintInk, .width_pt = 0.7, .dash = Dash::kSolid}});
  Extent heights;
  Extent counts;  // of the methods
  const double slot = 0.84 / static_cast<double>(std::max<std::size_t>(1, methods.size()));
  for (std::size_t m = 0; m < methods.size(); ++m) {
    Points points{
        .name = methods[m],
        .look = {.color = static_cast<int>(m), .marker = Marker::kCircle, .marker_pt = 2.4, .alpha = 0.55}};
    Points errors{.look = points.look};
    std::vector<double> counted(settings.size(), 0.0), placed(settings.size(), 0.0);
    const auto place_of = [&](const RunResult& run) {
      const auto place_in = [](const auto& all, const auto& one) {
        return static_cast<std::size_t>(std::ranges::find(all, one) - all.begin());
      };
      return each ? place_in(settings, Setting{run.period_s, run.height_m})
                  : place_in(heights_m, run.height_m);
    };
    for (const RunResult& run : results.runs)
      if (run.method == methods[m] && place_of(run) < settings.size())
        counted[place_of(run)] += static_cast<double>(run.waves.size());
    for (const RunResult& run : results.runs) {
      const std::size_t place = place_of(run);
      if (run.method != methods[m] || place >= settings.size()) continue;
      for (const evaluation::JudgedWave& wave : run.waves) {
        const double along = (placed[place]++ + 0.5) / counted[place];  // the waves of a setting fill its
                                                                        // slot in their order
        const double true_cm = cm(wave.true_height_m), estimated_cm = cm(wave.wave.height_m);
        if (!std::isfinite(true_cm + estimated_cm)) continue;
        heights.add(true_cm);
        points.x.push_back(true_cm);
        points.y.push_back(estimated_cm);
        errors.x.push_back(slots ? static_cast<double>(place) - 0.42 +
                                       slot * (static_cast<double>(m) + 0.05 + 0.9 * along)
                                 : true_cm);
        errors.y.push_back(estimated_cm - true_cm);
      }
    }
    if (points.x.empty()) continue;
    counts.add(static_cast<double>(points.x.size()));
    const auto same = std::ranges::find_if(against.marks, [&](const Mark& mark) {
      const auto& other = std::get<Points>(mark);
      return other.x == points.x && other.y == points.y;
    });
    if (same != against.marks.end()) {  // one legend is of both panels
      std::get<Points>(*same).name += ", " + methods[m];
      continue;
    }
    against.marks.emplace_back(std::move(points));
    residual.marks.emplace_back(std::move(errors));
  }
  if (counts.empty()) return figure;
  const double room = 0.08 * (heights.high - heights.low) + 1;
  const double low = std::max(0.0, heights.low - room), high = heights.high + room;
  if (low == 0) {  // no wave is lower
    against.x.include_zero = against.y.include_zero = true;
    if (!slots) residual.x.include_zero = true;
  }
  against.marks.emplace_back(Line{.x = {low, high},
                                  .y = {low, high},
                                  .name = "equal",
                                  .look = {.color = kInk, .width_pt = 0.8, .dash = Dash::kDashed}});
  figure.subtitle = fmt::format("{}{:.0f} wave{} of each method in all runs, ramps left out",
                                counts.low < counts.high ? fmt::format("{:.0f} to ", counts.low) : "",
                                counts.high, counts.high > 1 ? "s" : "");
  figure.panels = {std::move(against), std::move(residual)};
  return figure;
}

}  // namespace waverig::render
