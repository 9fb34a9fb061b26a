// What a campaign with a compass says of where the waves came from.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/figures/settings.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"

namespace waverig::render {
namespace {

bool tells_direction(const evaluation::CellResult& cell) { return std::isfinite(cell.sea.sea.spread_rad); }

}  // namespace

std::string direction_results_table(const evaluation::CampaignResults& results) {
  if (std::none_of(results.cells.begin(), results.cells.end(), tells_direction)) return "";
  HtmlTable table(
      "Direction the waves came from, clockwise from true north, in degrees; blank where repeats were turned "
      "all round. "
      "Error: told minus the true direction of the same record, mean and root mean square over the runs. "
      "Check factor: "
      "horizontal over vertical motion.",
      {"Period s", "Height cm", "Method", "From", "Error", "Rms error", "Spread", "True spread",
       "Check factor", "True check factor"});
  for (const evaluation::CellResult& cell : results.cells) {
    if (!tells_direction(cell)) continue;
    const std::string link = fmt::format("#{}", cell_id(cell));
    const auto degrees = [&](double angle_rad) { return number_cell(angle_rad / kDegree, 2, link); };
    table.add_row({number_cell(cell.period_s, cell.period_s == std::floor(cell.period_s) ? 0 : 2),
                   number_cell(cm(cell.height_m), 0), text_cell(cell.method),
                   degrees(cell.sea.sea.mean_direction_rad), degrees(cell.direction_error_rad),
                   degrees(cell.direction_rmse_rad), degrees(cell.sea.sea.spread_rad),
                   degrees(cell.sea.direction.spread_rad), number_cell(cell.sea.sea.check_factor, 3, link),
                   number_cell(cell.sea.direction.check_factor, 3, link)});
  }
  return table.html();
}

}  // namespace waverig::render
