#include "rig/bench/report/report.h"

#include <fmt/format.h>

#include "motion/kinematics/frames.h"
#include "render/figure_writer.h"
#include "render/report/html.h"

namespace waverig::rig::bench {
namespace {

namespace fs = std::filesystem;
using render::html_text;
using render::HtmlTable;
using render::inner_cell;
using render::number_cell;
using render::text_cell;

std::string intro(const Sequence& sequence, const Store& store, const std::vector<Verdict>& verdicts) {
  const RunInfo info = store.info();
  std::int64_t ended = info.started_utime;
  int attempts = 0, failed = 0;
  for (const StepRow& s : store.steps()) {
    ended = std::max(ended, s.ended_utime);
    ++attempts;
    failed += s.outcome == StepOutcome::kFailed || s.outcome == StepOutcome::kAccepted;
  }
  std::string out = fmt::format(
      "<header>\n<h1>{}</h1>\n<p class=\"question\">{}, serial number {}; {}{}, {}</p>\n<ul "
      "class=\"answer\">\n",
      html_text(sequence.title), html_text(sequence.laboratory.unit.name),
      html_text(sequence.laboratory.unit.serial), iso_time(info.started_utime),
      info.simulated ? ", simulated laboratory" : "",
      show_duration(static_cast<double>(ended - info.started_utime) * kMicrosecond));
  out += fmt::format(
      "<li>Outcome: <strong class=\"{}\">{}</strong>; {} attempts at {} planned steps, {} of them "
      "failed.</li>\n",
      info.outcome == "done" ? "better" : "worse", html_text(info.outcome), attempts, sequence.plan.size(),
      failed);
  int exceeded = 0;
  for (const Verdict& v : verdicts) exceeded += !v.passed();
  if (!verdicts.empty())
    out += fmt::format("<li>{} of {} results keep their specification.</li>\n",
                       verdicts.size() - static_cast<std::size_t>(exceeded), verdicts.size());
  return out + "</ul>\n</header>\n";
}

std::string verdict_section(const std::vector<Verdict>& verdicts) {
  HtmlTable table(
      "Largest expanded uncertainty (k = 2) over the calibrated temperatures, against the specification",
      {"Channel", "Quantity", "U (k = 2)", "Limit", "Kept"});
  for (const Verdict& v : verdicts)
    table.add_row(
        {text_cell(v.channel), text_cell(v.quantity), text_cell(shown(v.value, v.base)),
         text_cell(shown(v.limit, v.base)),
         inner_cell(v.passed() ? "<span class=\"better\">yes</span>" : "<span class=\"worse\">no</span>")});
  return table.empty()
             ? ""
             : "<section id=\"limits\"><h2>Against the specification</h2>\n" + table.html() + "</section>\n";
}

std::string channel_section(const Analysis& analysis) {
  HtmlTable scale(
      "Scale factors at 20 °C: departure from design, its expanded uncertainty (k = 2), slope, order that "
      "the data asked for",
      {"Channel", "Reset current", "Design nC", "ΔSF ppm", "U ppm", "Slope ppm/°C", "Order"});
  HtmlTable bias("Bias at 20 °C, middle of the loop", {"Channel", "Bias nA", "U nA", "Slope nA/°C", "Order",
                                                       "Hysteresis nA", "Noise of 100 s nA"});
  const auto slope = [](const estimator::TemperatureLaw& law) {
    return law.order() > 0 ? law.coefficients[1] : 0.0;
  };
  for (const ChannelAnalysis& measured : analysis.channels) {
    const estimator::FrontEndChannel& c = analysis.calibration.channel(measured.channel);
    if (!measured.scale_factors.empty())
      for (const bool negative : {true, false}) {
        const estimator::TemperatureLaw& law = negative ? c.dsf_N : c.dsf_P;
        scale.add_row({text_cell(c.name), text_cell(negative ? "negative" : "positive"),
                       number_cell(1e9 * (negative ? c.K_N0_C : c.K_P0_C), 3),
                       number_cell(1e6 * law.at(law.reference_degC), 2),
                       number_cell(2e6 * law.sigma_at(law.reference_degC), 2),
                       number_cell(1e6 * slope(law), 3), number_cell(law.order(), 0)});
      }
    if (measured.bias)
      bias.add_row({text_cell(c.name), number_cell(1e9 * c.bias_A.at(c.bias_A.reference_degC), 2),
                    number_cell(1e9 * c.bias_expanded_A(c.bias_A.reference_degC), 2),
                    number_cell(1e9 * slope(c.bias_A), 3), number_cell(c.bias_A.order(), 0),
                    number_cell(1e9 * measured.bias->hysteresis_A, 2),
                    number_cell(1e9 * measured.bias->noise_A, 3)});
  }
  std::string out = "<section id=\"channels\"><h2>Results per channel</h2>\n";
  if (!scale.empty()) out += scale.html();
  if (!bias.empty()) out += bias.html();
  if (!analysis.oscillator.points.empty()) {
    const estimator::TemperatureLaw& law = analysis.oscillator.law;
    out += fmt::format("<p>Master oscillator at 20 °C: {:+.2f} ppm, U = {:.2f} ppm (k = 2).</p>\n",
                       1e6 * law.at(20), 2e6 * law.sigma_at(20));
  }
  return out + "</section>\n";
}

std::string budget_section(const Analysis& analysis) {
  HtmlTable table(
      "Standard uncertainties (k = 1) at 20 °C. Type A: from the readings; B: from what is known beforehand.",
      {"Channel", "Quantity", "Contribution", "Type", "Value", "Unit"});
  const auto add = [&](const std::string& channel, const char* quantity,
                       const std::vector<estimator::BudgetTerm>& budget, double factor, const char* unit) {
    for (const estimator::BudgetTerm& t : budget)
      table.add_row({text_cell(channel), text_cell(quantity), text_cell(t.name),
                     text_cell(std::string(1, t.type)), number_cell(factor * t.sigma, 3), text_cell(unit)});
  };
  for (const ChannelAnalysis& measured : analysis.channels) {
    const estimator::FrontEndChannel& c = analysis.calibration.channel(measured.channel);
    if (!measured.scale_factors.empty()) {
      add(c.name, "scale factor N", c.dsf_N_budget, 1e6, "ppm");
      add(c.name, "scale factor P", c.dsf_P_budget, 1e6, "ppm");
    }
    if (measured.bias) add(c.name, "bias", c.bias_budget, 1e9, "nA");
  }
  add("", "master oscillator", analysis.oscillator.budget, 1e6, "ppm");
  return "<section id=\"budget\"><h2>Uncertainty budgets</h2>\n<details><summary>All "
         "contributions</summary><div>" +
         table.html() + "</div></details></section>\n";
}

std::string figures_section(const std::vector<BenchFigure>& figures, const fs::path& out) {
  std::string html = "<section id=\"figures\"><h2>Figures</h2>\n<div class=\"figures\">\n";
  for (const BenchFigure& f : figures)
    html += render::html_figure(out / "figures" / (f.stem + ".png"), f.caption);
  return html + "</div>\n</section>\n";
}

std::string failures_section(const Store& store) {
  HtmlTable table("Attempts that did not succeed", {"Step", "Attempt", "At", "What", "Where", "Then", "Why"});
  for (const StepRow& s : store.steps()) {
    if (s.outcome != StepOutcome::kFailed && s.outcome != StepOutcome::kAccepted) continue;
    table.add_row({number_cell(s.index, 0), number_cell(s.attempt, 0), text_cell(iso_time(s.started_utime)),
                   inner_cell(html_text(s.path + " " + s.what), true), text_cell(s.where),
                   text_cell(name_of(s.outcome)), inner_cell(html_text(s.message), true)});
  }
  return "<section id=\"failures\"><h2>Alarms</h2>\n" +
         (table.empty() ? "<p>Every step succeeded at its first attempt.</p>\n" : table.html()) +
         "</section>\n";
}

std::string provenance_section(const Store& store, const std::string& command) {
  const RunInfo info = store.info();
  HtmlTable instruments("Instruments, as each answered", {"Name", "Identity"}),
      files("Files behind the run", {"File", "Fingerprint"});
  for (const auto& [name, identity] : info.instruments)
    instruments.add_row({text_cell(name), text_cell(identity)});
  for (const auto& [name, print] : info.files) files.add_row({text_cell(name), text_cell(print)});
  return "<section id=\"provenance\"><h2>Instruments and files</h2>\n" +
         (instruments.empty() ? "" : instruments.html(false)) + files.html(false) +
         fmt::format("<pre>waverig {}\n{}\n</pre></section>\n", html_text(info.version), html_text(command));
}

}  // namespace

void draw_figures(const std::vector<BenchFigure>& figures, const fs::path& out, const std::string& version) {
  fs::create_directories(out / "figures");
  render::Canvas canvas;
  for (const BenchFigure& f : figures)
    render::save_png(f.figure, canvas, out / "figures" / (f.stem + ".png"), {version, "waverig bench", ""});
}

std::string bench_report_html(const Sequence& sequence, const Store& store, const Analysis* analysis,
                              const std::vector<Verdict>& verdicts, const std::vector<BenchFigure>& figures,
                              const fs::path& out, const std::string& command) {
  std::string body = intro(sequence, store, verdicts) + "<main>\n" + verdict_section(verdicts);
  if (analysis != nullptr) body += channel_section(*analysis);
  body += figures_section(figures, out);
  if (analysis != nullptr) body += budget_section(*analysis);
  return render::html_page("waverig bench: " + sequence.title,
                           body + failures_section(store) + provenance_section(store, command) + "</main>\n");
}

}  // namespace waverig::rig::bench
