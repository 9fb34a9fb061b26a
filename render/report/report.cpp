#include "render/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <waverig/alarm_t.hpp>

#include "estimator/evaluation/flag_names.h"
#include "estimator/evaluation/results_files.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/event_log.h"
#include "render/campaign_figures.h"
#include "render/figures/settings.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"
#include "render/ticks.h"

namespace waverig::render {
namespace {

namespace fs = std::filesystem;
using evaluation::CampaignResults;
using evaluation::CellResult;
using evaluation::RunResult;

std::string setting_text(const CellResult& cell) {
  return fmt::format("{:g} s, {:g} cm", cell.period_s, cm(cell.height_m));
}

std::string run_id(const RunResult& run) { return html_id("run-" + run.run + "-" + run.method); }
std::string wave_id(const RunResult& run, const evaluation::JudgedWave& wave) {
  return run_id(run) + "-wave-" + std::to_string(wave.wave.seq);
}

std::string joined(const std::vector<std::string>& words, const char* between = ", ") {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : between) + word;
  return out;
}

// Some tell the sea alone, or its direction: tables of single waves have nothing of theirs.
bool gives_waves(const CampaignResults& results, const std::string& method) {
  return std::ranges::any_of(results.runs, [&](const RunResult& run) {
    return run.method == method && (!run.waves.empty() || run.excluded_waves > 0);
  });
}

// Settings without waves are no success: they are counted, and named where there are few.
std::string height_answer(const MethodSummary& s) {
  constexpr std::size_t kMostNamed = 4;
  const std::size_t without = s.without_waves.size();
  std::string out = fmt::format("<li><strong>{}</strong>: ", html_text(s.method));
  if (without == s.settings) return out + "no single wave was measured in any setting.</li>\n";
  std::string where = "every setting";
  if (without > 0) {
    where = fmt::format("{} of {} settings", s.settings - without, s.settings);
    std::vector<std::string> named = s.without_waves;
    if (without > kMostNamed) named.resize(kMostNamed);
    where += "; none were measured at " + joined(named, " or ");
    if (without > kMostNamed) where += fmt::format(" and {} more", without - kMostNamed);
  }
  out += fmt::format("the mean wave height is within {:.2f} % of the true height in {}",
                     s.worst_error_percent, where);
  if (s.beyond_uncertainty > 0)
    out += fmt::format("; in {} of {} it is further off than its expanded uncertainty U",
                       s.beyond_uncertainty, s.settings - without);
  if (std::isfinite(s.largest_std_m))  // one wave a setting has no scatter
    out +=
        fmt::format("; single waves scatter by {} cm", range_text(cm(s.least_std_m), cm(s.largest_std_m), 2));
  if (std::isfinite(s.worst_std_over_bound))
    out += fmt::format(", at most {:.2f} times the Cram\u00E9r\u2013Rao bound", s.worst_std_over_bound);
  return out + ".</li>\n";
}

// Whose methods stand here and which program judged them: where that was done anew, the command too, which
// names the programs of others.
std::string judge_line(const CampaignResults& results) {
  const bool anew = !results.judged_version.empty();
  std::string out =
      fmt::format("<p>Methods: {}. Judged{} by waverig {}", html_text(joined(all_methods_of(results))),
                  anew ? " anew" : "", html_text(anew ? results.judged_version : results.version));
  if (anew) out += fmt::format(": <code>{}</code>", html_text(results.judged_command));
  return out + ".</p>\n";
}

// sections: the page below.
std::string intro(const CampaignResults& results, const std::string& sections) {
  std::string out = fmt::format(
      "<header>\n<h1>Wave measurement campaign \u201C{}\u201D</h1>\n"
      "<p class=\"question\">The question: how well does this low-cost sensor, "
      "with this estimator, measure "
      "waves?</p>\n<ul class=\"answer\">\n",
      html_text(results.name));
  if (are_seas(results)) out += sea_answer(results);
  for (const MethodSummary& s : summaries_of(results)) out += height_answer(s);
  out += direction_answer(results);
  out += "</ul>\n";
  out += judge_line(results);
  if (!results.complete) out += "<p class=\"worse\">This campaign is not complete.</p>\n";
  out += "<nav class=\"no-print\"><ul>";
  static constexpr std::array<std::pair<const char*, const char*>, 7> kSections = {
      {{"results", "Results"},
       {"figures", "Figures"},
       {"budget", "Uncertainty"},
       {"excluded", "Excluded, flags, alarms"},
       {"runs", "Runs and waves"},
       {"rig", "Rig and sensor"},
       {"reproduce", "Reproduce"}}};
  for (const auto& [id, name] : kSections)  // some have nothing to say and are left out
    if (sections.find(fmt::format("<section id=\"{}\">", id)) != std::string::npos)
      out += fmt::format("<li><a href=\"#{}\">{}</a></li>", id, name);
  return out + "</ul></nav>\n</header>\n";
}

HtmlCell signed_cell(HtmlCell cell, const char* sign) {
  cell.inner += sign;
  return cell;
}

std::string results_table(const CampaignResults& results) {
  HtmlTable table(
      "Steady waves of all repeats; lengths in cm. U: expanded "
      "uncertainty of the mean, k = 2. Error: of the mean against the mean true height; * beyond U. Bound: "
      "Cram\u00E9r\u2013Rao, of the standard "
      "deviation of a wave by itself. A number leads to the runs behind it.",
      {"Period s", "Height cm", "Method", "Waves", "Mean", "True", "Error %", "U (k\u00A0=\u00A02)", "Std",
       "Bound", "Std / bound", "RMSE"});
  const SettingColumns set(results.cells);
  for (const CellResult& cell : results.cells) {
    const evaluation::HeightStatistics& s = cell.statistics;
    if (tells_direction_alone(cell)) continue;
    const std::string link = fmt::format("#{}", cell_id(cell));
    table.add_row(
        {set.period(cell), set.height(cell), text_cell(cell.method),
         number_cell(static_cast<double>(s.waves), 0, link), number_cell(cm(s.mean_height_m), 2, link),
         number_cell(cm(s.mean_true_height_m), 2, link),
         signed_cell(number_cell(s.mean_error_percent, 2, link), is_beyond_uncertainty(s) ? "*" : ""),
         number_cell(cm(s.expanded_uncertainty_m), 2, link), number_cell(cm(s.std_m), 2, link),
         number_cell(cm(s.bound_std_m), 2), number_cell(s.std_m / s.bound_std_m, 2),
         number_cell(cm(s.rmse_m), 2, link)});
  }
  return table.html();
}

std::string figures_section(const fs::path& directory) {
  std::string out;
  std::string group;
  for (const FigureInfo& info : kFigureOrder) {
    const fs::path path = directory / "figures" / (std::string(info.stem) + ".png");
    if (!fs::exists(path)) continue;
    if (group != info.group) {
      out += (group.empty() ? "" : "</div>\n") +
             fmt::format("<h3>{}</h3>\n<div class=\"figures\">\n", html_text(info.group));
      group = info.group;
    }
    out += html_figure(path, info.caption);
  }
  if (out.empty()) return "";
  return "<section id=\"figures\"><h2>Figures</h2>\n" + std::string(kOpensLarge) + out +
         "</div>\n</section>\n";
}

std::string budget_section(const CampaignResults& results) {
  HtmlTable table(
      std::string(
          "Contributions to the standard uncertainty of the mean height, in mm (k = 1). Type A: from the "
          "scatter of single waves") +
          (are_seas(results) ? ", which on a sea is mostly its own" : "") +
          "; B: from what is known beforehand.",
      SettingColumns::heads(are_seas(results), {"Method", "Contribution", "Type", "mm"}));
  const SettingColumns set(results.cells);
  for (const CellResult& cell : results.cells) {
    for (const evaluation::Contribution& part : cell.statistics.budget)
      table.add_row({set.period(cell), set.height(cell), text_cell(cell.method), text_cell(part.name),
                     text_cell(std::string(1, part.type)), number_cell(1000 * part.sigma_m, 3)});
  }
  if (table.empty()) return "";
  return "<section id=\"budget\"><h2>Uncertainty budget</h2>\n<p>Combined in "
         "squares, times two: the "
         "expanded uncertainty " +
         std::string(are_seas(results) ? "in <code>results.csv</code>"
                                       : "U of the table "
                                         "above") +
         ".</p>\n<details><summary>All "
         "contributions</summary><div>" +
         table.html() + "</div></details></section>\n";
}

std::string excluded_section(const CampaignResults& results, const fs::path& directory) {
  HtmlTable excluded(
      "Left out: waves in the ramps or cut by the record's "
      "edge. Counted, but flagged: named.",
      {"Run", "Method", "Waves counted", "Left out", "Flags of the run", "Flagged waves"});
  for (const RunResult& run : results.runs) {
    if (!gives_waves(results, run.method)) continue;
    std::map<std::string, int> flagged;
    for (const evaluation::JudgedWave& wave : run.waves) {
      for (const std::string& name : evaluation::flag_names(wave.wave.flags)) ++flagged[name];
    }
    std::vector<std::string> words;
    for (const auto& [name, count] : flagged) words.push_back(fmt::format("{} \u00D7 {}", count, name));
    excluded.add_row({inner_cell(html_link(fmt::format("#{}", run_id(run)), run.run)), text_cell(run.method),
                      number_cell(static_cast<double>(run.statistics.waves), 0),
                      number_cell(static_cast<double>(run.excluded_waves), 0),
                      text_cell(joined(evaluation::flag_names(run.statistics.flags))),
                      text_cell(joined(words))});
  }
  HtmlTable alarms("Alarms and notes in the recordings", {"Run", "Time s", "Code", "Severity", "Text"});
  std::map<std::string, bool> seen;
  for (const RunResult& run : results.runs) {
    const fs::path log = evaluation::log_of(directory, run.run);
    if (!seen.emplace(run.run, true).second || !fs::exists(log)) continue;
    EventLogReader reader(log);
    LogEvent event;
    std::int64_t start_utime = 0;
    while (reader.next(event)) {
      if (start_utime == 0) start_utime = event.utime;
      if (event.channel != channel::kAlarm) continue;
      alarm_t alarm{};
      if (!event.decode(alarm)) continue;
      const auto* text = reinterpret_cast<const char*>(alarm.text);
      const std::size_t length =
          static_cast<std::size_t>(std::find(text, text + sizeof(alarm.text), '\0') - text);
      static constexpr std::array<const char*, 3> kSeverities = {"note", "warning", "alarm"};
      alarms.add_row({text_cell(run.run),
                      number_cell(static_cast<double>(alarm.utime - start_utime) * kMicrosecond, 1),
                      number_cell(alarm.code, 0),
                      text_cell(kSeverities[static_cast<std::size_t>(std::clamp(alarm.severity, 0, 2))]),
                      inner_cell(html_text({text, length}), true)});
    }
  }
  std::string out =
      "<section id=\"excluded\"><h2>Excluded, flags and "
      "alarms</h2>\n<details><summary>Run by "
      "run</summary><div>" +
      excluded.html() + "</div></details>\n" + left_out_settings(results);
  out += alarms.empty() ? "<p>No run recorded an alarm.</p>\n" : alarms.html();
  return out + "</section>\n";
}

double error_m(const evaluation::JudgedWave& wave) { return wave.wave.height_m - wave.true_height_m; }

// None where no wave has a known error.
const evaluation::JudgedWave* worst_of(const RunResult& run) {
  const evaluation::JudgedWave* worst = nullptr;
  for (const evaluation::JudgedWave& wave : run.waves)
    if (std::isfinite(error_m(wave)) &&
        (worst == nullptr || std::abs(error_m(wave)) > std::abs(error_m(*worst))))
      worst = &wave;
  return worst;
}

std::string single_waves(const RunResult& run) {
  HtmlTable table(
      fmt::format("Single waves of {}, {}", run.run, run.method),
      {"Wave", "Start s", "Period s", "Height cm", "True cm", "Error cm", "Noise \u03C3 cm", "Flags"});
  const std::int64_t first_utime = run.waves.empty() ? 0 : run.waves.front().wave.start_utime;
  for (const evaluation::JudgedWave& wave : run.waves)
    table.add_row({number_cell(static_cast<double>(wave.wave.seq), 0),
                   number_cell(static_cast<double>(wave.wave.start_utime - first_utime) * kMicrosecond, 2),
                   number_cell(wave.wave.period_s, 3), number_cell(cm(wave.wave.height_m), 2),
                   number_cell(cm(wave.true_height_m), 2), number_cell(cm(error_m(wave)), 2),
                   number_cell(cm(wave.wave.noise_sigma_m), 2),
                   text_cell(joined(evaluation::flag_names(wave.wave.flags)))},
                  wave_id(run, wave));
  return fmt::format(
      "<details class=\"waves\" id=\"{}\"><summary>{}, {}: {} "
      "waves</summary><div>{}</div></details>\n",
      run_id(run), html_text(run.run), html_text(run.method), run.waves.size(),
      table.html(HtmlTable::Caption::kHeard));
}

HtmlCell recording_cell(const RunResult& run) {
  return inner_cell(html_link("runs/" + run.run + ".lcm", run.run + ".lcm"));
}

std::vector<HtmlCell> run_row(const RunResult& run) {
  const evaluation::HeightStatistics& s = run.statistics;
  const std::string here = fmt::format("#{}", run_id(run));
  const evaluation::JudgedWave* worst = worst_of(run);
  return {inner_cell(html_link(here, run.run)),
          number_cell(run.repeat + 1, 0),
          number_cell(static_cast<double>(s.waves), 0, here),
          number_cell(cm(s.mean_height_m), 2, here),
          number_cell(cm(s.mean_true_height_m), 2, here),
          number_cell(cm(s.std_m), 2, here),
          number_cell(cm(s.rmse_m), 2, here),
          worst == nullptr ? number_cell(kAuto, 2)
                           : number_cell(cm(error_m(*worst)), 2, fmt::format("#{}", wave_id(run, *worst))),
          recording_cell(run)};
}

// Of a method that tells no waves the recordings alone.
std::string runs_of_cell(const CampaignResults& results, const CellResult& cell) {
  const bool waves_told = gives_waves(results, cell.method);
  const std::vector<std::string> head =
      waves_told ? std::vector<std::string>{"Run",     "Repeat",           "Waves",
                                            "Mean cm", "True mean cm",     "Std cm",
                                            "RMSE cm", "Largest error cm", "Recording"}
                 : std::vector<std::string>{"Run", "Repeat", "Recording"};
  HtmlTable table(fmt::format("{}, {}", setting_text(cell), cell.method), head);
  std::string waves;
  for (const RunResult& run : results.runs) {
    if (run.period_s != cell.period_s || run.height_m != cell.height_m || run.method != cell.method) continue;
    if (waves_told) {
      table.add_row(run_row(run));
      waves += single_waves(run);
    } else {
      table.add_row({text_cell(run.run), number_cell(run.repeat + 1, 0), recording_cell(run)});
    }
  }
  if (table.empty()) return "";
  return fmt::format("<section id=\"{}\"><h3>{}, {}</h3>\n", cell_id(cell), html_text(setting_text(cell)),
                     html_text(cell.method)) +
         table.html(HtmlTable::Caption::kHeard) + waves + "</section>\n";
}

std::string runs_section(const CampaignResults& results) {
  constexpr std::size_t kMostOpen = 30;  // more are scrolled past in vain: a link into them unfolds them
  const bool folded = results.cells.size() > kMostOpen;
  std::string out = "<section id=\"runs\"><h2>Runs and waves</h2>\n";
  if (folded)
    out += fmt::format("<details><summary>{} settings and methods</summary><div>\n", results.cells.size());
  for (const CellResult& cell : results.cells) out += runs_of_cell(results, cell);
  if (folded) out += "</div></details>\n";
  return out + "</section>\n";
}

std::string reproduce_section(const CampaignResults& results) {
  return fmt::format(
      "<section id=\"reproduce\"><h2>Reproduce</h2>\n<p>The "
      "same version, settings and seed give the same "
      "results and the same bytes in the recordings, for any "
      "number of jobs.</p>\n"
      "<pre>waverig {}\nseed {}\n{}\n</pre>\n<p>The settings as "
      "resolved are <code>campaign.toml</code> in "
      "the results directory: <code>waverig sweep campaign.toml "
      "--out AGAIN</code>. "
      "Every recording is an LCM event log that "
      "<code>lcm-logplayer</code> and <code>lcm-spy</code> "
      "open.</p></section>\n",
      html_text(results.version), results.seed, html_text(results.command));
}

}  // namespace

std::string cell_id(const CellResult& cell) {
  return html_id(fmt::format("cell-{:g}s-{:g}cm-{}", cell.period_s, cm(cell.height_m), cell.method));
}

std::string range_text(double low, double high, int decimals) {
  const std::string from = number_text(low, decimals), to = number_text(high, decimals);
  return from == to ? to : from + " to " + to;
}

std::vector<MethodSummary> summaries_of(const CampaignResults& results) {
  std::vector<MethodSummary> all;
  if (are_seas(results)) return all;  // no single height was set that a mean could miss
  for (const std::string& method : methods_of(results)) {
    MethodSummary summary;
    summary.method = method;
    for (const CellResult& cell : results.cells) {
      const evaluation::HeightStatistics& s = cell.statistics;
      if (cell.method != method) continue;
      ++summary.settings;
      if (s.waves < 1) {
        summary.without_waves.push_back(setting_text(cell));
        continue;
      }
      summary.worst_error_percent = std::fmax(summary.worst_error_percent, std::abs(s.mean_error_percent));
      summary.beyond_uncertainty += is_beyond_uncertainty(s);
      summary.least_std_m = std::fmin(summary.least_std_m, s.std_m);  // unknown of a single wave
      summary.largest_std_m = std::fmax(summary.largest_std_m, s.std_m);
      summary.worst_std_over_bound = std::fmax(summary.worst_std_over_bound, s.std_m / s.bound_std_m);
    }
    all.push_back(std::move(summary));
  }
  return all;
}

std::string report_html(const CampaignResults& results, const fs::path& directory) {
  const std::string sections = "<section id=\"results\"><h2>Results</h2>\n" +
                               (are_seas(results) ? sea_results_table(results) : results_table(results)) +
                               direction_results_table(results) + "</section>\n" +
                               figures_section(directory) + budget_section(results) +
                               excluded_section(results, directory) + runs_section(results) +
                               rig_section(results, directory) + reproduce_section(results);
  return html_page("waverig: " + results.name,
                   intro(results, sections) + "<main>\n" + sections + "</main>\n");
}

}  // namespace waverig::render
