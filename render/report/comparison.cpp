// The comparison of two campaigns as a page.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

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

bool known(const evaluation::Difference& d) {
  return std::isfinite(d.baseline) || std::isfinite(d.candidate);
}

// Three columns a quantity; those of seas only where there are any.
std::string cells_table(const std::vector<evaluation::CellComparison>& cells) {
  struct Quantity {
    const char* name;
    evaluation::Difference evaluation::CellComparison::*of;
  };
  std::vector<Quantity> quantities = {{"Error", &evaluation::CellComparison::mean_error_m},
                                      {"Std", &evaluation::CellComparison::std_m}};
  bool seas = false;
  for (const Quantity& q : {Quantity{"Hm0 error", &evaluation::CellComparison::hm0_error_m},
                            Quantity{"Heave rms", &evaluation::CellComparison::heave_rmse_m}})
    if (std::any_of(cells.begin(), cells.end(), [&](const auto& cell) { return known(cell.*q.of); })) {
      quantities.push_back(q);
      seas = true;
    }
  std::vector<std::string> heads = SettingColumns::heads(seas, {"Method", "Verdict"});
  for (const Quantity& q : quantities)
    for (const char* column : {", baseline", ", candidate", ": verdict"})
      heads.push_back(std::string(q.name) + column);
  HtmlTable table(
      std::string("Error: of the mean height against the true mean, cm. Std: "
                  "of single waves, cm; on irregular seas the rms of their errors. ") +
          (seas ? "Hm0 error: against the true Hm0, cm. Heave rms: of the heave\u2019s error, cm. " : "") +
          "A difference counts where it exceeds two standard uncertainties" +
          (seas ? "; of single waves and heave on a sea these come from the repeats, two at least in each "
                  "campaign, or they are shown and do not count."
                : "."),
      heads);
  const SettingColumns set(cells);
  for (const evaluation::CellComparison& cell : cells) {
    std::vector<HtmlCell> row = {set.period(cell), set.height(cell), text_cell(cell.method),
                                 verdict_cell(cell.verdict)};
    for (const Quantity& q : quantities) {
      const evaluation::Difference& d = cell.*q.of;
      row.push_back(number_cell(d.baseline / kCentimetre, 2));
      row.push_back(number_cell(d.candidate / kCentimetre, 2));
      row.push_back(known(d) ? verdict_cell(d.verdict) : text_cell("\u2013"));
    }
    table.add_row(std::move(row));
  }
  return table.html();
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
  const std::string table = cells_table(cells);
  std::string body =
      "<header>\n<h1>Two campaigns side by side</h1>\n<p "
      "class=\"question\">The question: is the candidate "
      "better, worse, or is the difference not significant?</p>\n<ul>\n" +
      who("Baseline", baseline, baseline_directory) + who("Candidate", candidate, candidate_directory) +
      "</ul>\n" + tally(cells) + "</header>\n<main>\n<section id=\"cells\"><h2>Cell by cell</h2>\n" + table +
      "</section>\n";
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
