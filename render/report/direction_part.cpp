// What a campaign with a compass says of where the waves came from.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/figures/settings.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"

namespace waverig::render {
namespace {

bool tells_direction(const evaluation::CellResult& cell) { return std::isfinite(cell.sea.sea.spread_rad); }

}  // namespace

std::string direction_answer(const evaluation::CampaignResults& results) {
  struct Answer {
    double worst_rmse_rad = kAuto, least_check = kAuto, largest_check = kAuto;
    std::size_t settings = 0, told = 0;
  };
  std::map<std::string, Answer> answers;
  for (const evaluation::CellResult& cell : results.cells) {
    Answer& answer = answers[cell.method];
    ++answer.settings;
    if (!tells_direction(cell) || !std::isfinite(cell.direction_rmse_rad)) continue;
    ++answer.told;
    answer.worst_rmse_rad = std::fmax(answer.worst_rmse_rad, cell.direction_rmse_rad);
    answer.least_check = std::fmin(answer.least_check, cell.sea.sea.check_factor);
    answer.largest_check = std::fmax(answer.largest_check, cell.sea.sea.check_factor);
  }
  std::string out;
  for (const auto& [method, answer] : answers) {
    if (answer.told == 0) continue;
    out += fmt::format(
        "<li><strong>{}</strong>: where the waves came from is within {:.2f}\u00B0 of the true direction "
        "(rms over "
        "the runs of a setting) in {}",
        html_text(method), answer.worst_rmse_rad / kDegree,
        answer.told == answer.settings ? "every setting"
                                       : fmt::format("{} of {} settings", answer.told, answer.settings));
    if (std::isfinite(answer.least_check))
      out += fmt::format("; the check factor is {}", range_text(answer.least_check, answer.largest_check, 3));
    out += ".</li>\n";
  }
  return out;
}

std::string direction_results_table(const evaluation::CampaignResults& results) {
  if (std::none_of(results.cells.begin(), results.cells.end(), tells_direction)) return "";
  HtmlTable table(
      "Direction the waves came from, clockwise from true north, in degrees; a dash where repeats were "
      "turned all round. "
      "Error: told minus the true direction of the same record, mean and root mean square over the runs. "
      "Check factor: "
      "horizontal over vertical motion.",
      SettingColumns::heads(are_seas(results), {"Method", "From", "Error", "Rms error", "Spread",
                                                "True spread", "Check factor", "True check factor"}));
  const SettingColumns set(results.cells);
  for (const evaluation::CellResult& cell : results.cells) {
    if (!tells_direction(cell)) continue;
    const std::string link = fmt::format("#{}", cell_id(cell));
    const auto degrees = [&](double angle_rad) { return number_cell(angle_rad / kDegree, 2, link); };
    table.add_row({set.period(cell), set.height(cell), text_cell(cell.method),
                   degrees(cell.sea.sea.mean_direction_rad), degrees(cell.direction_error_rad),
                   degrees(cell.direction_rmse_rad), degrees(cell.sea.sea.spread_rad),
                   degrees(cell.sea.direction.spread_rad), number_cell(cell.sea.sea.check_factor, 3, link),
                   number_cell(cell.sea.direction.check_factor, 3, link)});
  }
  return table.html();
}

}  // namespace waverig::render
