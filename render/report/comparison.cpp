// The comparison of two campaigns as a page.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "estimator/evaluation/compare.h"
#include "lcmtypes/error.h"
#include "motion/kinematics/frames.h"
#include "render/campaign_figures.h"
#include "render/report/html.h"
#include "render/report/report.h"
#include "render/report/report_parts.h"

namespace waverig::render {
namespace {

namespace fs = std::filesystem;
using evaluation::Verdict;

HtmlCell verdict_cell(Verdict verdict) {
  const char* const name = evaluation::name_of(verdict);
  switch (verdict) {
    case Verdict::kBetter:
      return inner_cell(fmt::format("<span class=\"better\">\u25B2 {}</span>", html_text(name)));
    case Verdict::kWorse:
      return inner_cell(fmt::format("<span class=\"worse\">\u25BC {}</span>", html_text(name)));
    default:
      return text_cell(name);
  }
}

std::string who(const char* role, const evaluation::CampaignResults& results, const fs::path& directory) {
  return fmt::format(
      "<li><strong>{}</strong>: \u201C{}\u201D, version {}{}, "
      "seed {}, <code>{}</code></li>\n",
      role, html_text(results.name), html_text(results.version),
      results.judged_version.empty() ? ""
                                     : fmt::format(", judged anew by {}", html_text(results.judged_version)),
      results.seed,
      html_text(directory.filename().empty() ? directory.parent_path().filename().string()
                                             : directory.filename().string()));
}

std::string tally(const std::vector<evaluation::CellComparison>& cells) {
  std::array<int, 6> counts{};
  for (const evaluation::CellComparison& cell : cells) ++counts[static_cast<std::size_t>(cell.verdict)];
  std::string out = "<p>";
  for (const Verdict v : {Verdict::kBetter, Verdict::kWorse, Verdict::kNotSignificant, Verdict::kUnknown,
                          Verdict::kOnlyInBaseline, Verdict::kOnlyInCandidate}) {
    const int n = counts[static_cast<std::size_t>(v)];
    if (n > 0)
      out += fmt::format("{}{} of {} cells {}", out.size() > 3 ? ", " : "", n, cells.size(),
                         html_text(evaluation::name_of(v)));
  }
  return out + ".</p>\n";
}

}  // namespace

std::string comparison_html(const evaluation::CampaignResults& baseline, const fs::path& baseline_directory,
                            const evaluation::CampaignResults& candidate,
                            const fs::path& candidate_directory) {
  const std::vector<evaluation::CellComparison> cells =
      evaluation::compare_cells(baseline.cells, candidate.cells);
  if (!evaluation::any_common(cells))
    throw UserError(
        fmt::format("{} and {}: no period, height and method in common; expected two campaigns of one kind",
                    baseline_directory.string(), candidate_directory.string()));
  HtmlTable table(
      "Error: of the mean height against the true mean, cm. Std: "
      "of single waves, cm; on irregular seas the rms of their errors. A difference counts "
      "where it exceeds two standard uncertainties.",
      {"Period s", "Height cm", "Method", "Verdict", "Error, baseline", "Error, candidate", "Error: verdict",
       "Std, baseline", "Std, candidate", "Std: verdict"});
  const SettingColumns set(cells);
  for (const evaluation::CellComparison& cell : cells) {
    const auto cm = [](double m) { return number_cell(m / kCentimetre, 2); };
    table.add_row({set.period(cell), set.height(cell), text_cell(cell.method), verdict_cell(cell.verdict),
                   cm(cell.mean_error_m.baseline), cm(cell.mean_error_m.candidate),
                   verdict_cell(cell.mean_error_m.verdict), cm(cell.std_m.baseline), cm(cell.std_m.candidate),
                   verdict_cell(cell.std_m.verdict)});
  }
  std::string body =
      "<header>\n<h1>Two campaigns side by side</h1>\n<p "
      "class=\"question\">The question: is the candidate "
      "better, worse, or is the difference not significant?</p>\n<ul>\n" +
      who("Baseline", baseline, baseline_directory) + who("Candidate", candidate, candidate_directory) +
      "</ul>\n" + tally(cells) + "</header>\n<main>\n<section id=\"cells\"><h2>Cell by cell</h2>\n" +
      table.html() + "</section>\n";
  std::string figures;
  for (const FigureInfo& info : kFigureOrder) {
    const std::string file = std::string(info.stem) + ".png";
    const fs::path left = baseline_directory / "figures" / file,
                   right = candidate_directory / "figures" / file;
    if (!fs::exists(left) || !fs::exists(right)) continue;
    figures += fmt::format("<h3>{}</h3>\n<div class=\"figures pair\">\n", html_text(info.caption)) +
               html_figure(left, "Baseline") + html_figure(right, "Candidate") + "</div>\n";
  }
  if (!figures.empty())
    body +=
        "<section id=\"figures\"><h2>Figures</h2>\n" + std::string(kOpensLarge) + figures + "</section>\n";
  return html_page("waverig: " + baseline.name + " and " + candidate.name, body + "</main>\n");
}

}  // namespace waverig::render
