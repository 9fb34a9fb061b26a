// What a run leaves for people: CSV, JUnit XML, traces, live view, report.
#include "rig/bench/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <pugixml.hpp>

#include "rig/bench/bench.h"
#include "rig/bench/report/control_chart.h"
#include "rig/bench/report/figures.h"
#include "rig/bench/report/live_view.h"
#include "tests/bench/short_sequence.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

struct FinishedRun {
  ShortSequence files;
  Sequence sequence;
  std::vector<TraceRow> heard;
  BenchResult result;

  explicit FinishedRun(const ShortSequence::Changes& changes = {}, std::vector<Fault> faults = {})
      : files("scale_factor.toml", changes), sequence(load_sequence(files.file())) {
    BenchOptions options;
    options.out = files.out();
    options.simulate = true;
    options.simulation.faults = std::move(faults);
    options.version = "test";
    options.trace = [this](const TraceRow& row) { heard.push_back(row); };
    result = run_bench(sequence, options);
  }
  Store store() const { return Store::open(store_file(files.out())); }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

TEST(BenchReport, HoldsFiguresResultsInstrumentsAndFiles) {
  const FinishedRun run;
  const Store store = run.store();
  const Analysis analysis = analyse(run.sequence, store);
  const std::vector<Verdict> verdicts = hold_against_limits(run.sequence, analysis);
  const std::vector<BenchFigure> figures = bench_figures(run.sequence, store, &analysis);
  draw_figures(figures, run.files.out(), "test");
  const std::string html = bench_report_html(run.sequence, store, &analysis, verdicts, figures, run.files.out(), "waverig bench <x>");
  for (const char* stem : {"temperature", "procedure", "windows", "scale_factors", "closure"})
    EXPECT_TRUE(std::filesystem::exists(run.files.out() / "figures" / (std::string(stem) + ".png"))) << stem;
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = html.find("data:image/png", at)) != std::string::npos; ++at) ++pictures;
  EXPECT_EQ(pictures, figures.size());
  for (const char* text : {"CAL-2A", "scale_factor.toml", "converter_unit.toml", "gyro_2", "calibrator", "waverig bench &lt;x&gt;",
                           "Every step succeeded at its first attempt"})
    EXPECT_NE(html.find(text), std::string::npos) << text;

  const std::vector<std::string> settings = procedure_figure(run.sequence, store).panels.at(1).y.categories;
  EXPECT_NE(std::ranges::find(settings, "\u2212100 µA"), settings.end()) << "as people write it";
  for (const render::Panel& panel : {procedure_figure(run.sequence, store).panels.at(0), figures.front().figure.panels.at(0)}) {
    EXPECT_TRUE(panel.x.label.starts_with("Time since")) << panel.x.label;
    EXPECT_EQ(panel.x.low, 0) << "the time since the beginning has a 0";
  }
  EXPECT_TRUE(std::ranges::all_of(verdicts, &Verdict::passed));
  Analysis other_unit = analysis;
  other_unit.calibration.channels.front().dsf_P.coefficients[0] = -0.97;
  const std::vector<Verdict> other = hold_against_limits(run.sequence, other_unit);
  EXPECT_EQ(other.size(), verdicts.size() + 1);
  EXPECT_FALSE(std::ranges::all_of(other, &Verdict::passed));
  EXPECT_NE(table_of(other).find("gyro_2     off its design    9.7e+05 ppm    1e+05 ppm  exceeded\n"), std::string::npos) << table_of(other);
  EXPECT_EQ(closure_figure(analysis).panels.size(), 2U);
  Analysis gyros = analysis;
  std::erase_if(gyros.channels, [](const ChannelAnalysis& channel) { return !channel.channel.starts_with("gyro"); });
  EXPECT_EQ(closure_figure(gyros).panels.size(), 1U) << "no panel of channels that the unit has none of";

  const std::vector<std::string> csv = lines_of(channels_csv(analysis));
  ASSERT_EQ(csv.size(), 3U);   // a header and two channels
  EXPECT_TRUE(csv[1].starts_with("gyro_2,3e-08,"));
  EXPECT_EQ(std::ranges::count(csv[0], ','), std::ranges::count(csv[1], ','));
  EXPECT_EQ(lines_of(steps_csv(store)).size(), store.steps().size() + 1);
}

// Of the calibrations in a chart's panel, and the names of its limits.
std::pair<std::vector<std::string>, std::vector<std::string>> columns_and_limits(const render::Panel& panel) {
  std::vector<std::string> limits;
  for (const render::Mark& mark : panel.marks)
    if (const auto* span = std::get_if<render::Span>(&mark); span != nullptr && !span->name.empty()) limits.push_back(span->name);
  return {panel.x.categories, limits};
}

TEST(ControlChart, TakesARepeatedMeasurementOnceAndShowsLimitsOfADifferenceAlone) {
  const FinishedRun run;
  estimator::FrontEndCalibration first = analyse(run.sequence, run.store()).calibration, merged = first, later = first;
  merged.procedure += "+bias";
  later.measured = "2031" + later.measured.substr(4);
  for (estimator::FrontEndChannel& channel : later.channels) channel.dsf_N.coefficients[0] += 5e-6;
  const std::string column = first.measured.substr(0, 10) + "\n" + first.procedure;

  const render::Figure alone = control_chart({first, merged}, false), both = control_chart({first, merged, later}, false);
  EXPECT_NE(alone.title.find("scale factor N"), std::string::npos) << alone.title;
  const auto [columns, limits] = columns_and_limits(alone.panels.at(0));
  EXPECT_EQ(columns, std::vector<std::string>{column});
  EXPECT_TRUE(limits.empty());
  const auto [two_columns, two_limits] = columns_and_limits(both.panels.at(0));
  EXPECT_EQ(two_columns, (std::vector<std::string>{column, "2031" + column.substr(4)}));
  EXPECT_EQ(two_limits, (std::vector<std::string>{"k = 2", "k = 3"}));
}

TEST(BenchReport, JUnitTellsEveryLimitThatWasKeptAndEachThatWasNot) {
  ShortSequence::Changes none;
  const FinishedRun run(none, {{"counts", FaultType::kCorrupt, 0, 1e12, 0.02}});
  std::vector<Verdict> verdicts = hold_against_limits(run.sequence, analyse(run.sequence, run.store()));
  ASSERT_EQ(verdicts.size(), 2U);
  EXPECT_TRUE(verdicts[0].passed());
  verdicts[0].limit = 1e-9;
  pugi::xml_document xml;
  ASSERT_TRUE(xml.load_string(junit_xml(run.sequence, run.store(), verdicts).c_str()));
  const pugi::xml_node channels = xml.child("testsuites").find_child_by_attribute("name", "channels");
  EXPECT_EQ(channels.attribute("tests").as_int(), 2);
  EXPECT_EQ(channels.attribute("failures").as_int(), 1);
  const pugi::xml_node steps = xml.child("testsuites").find_child_by_attribute("name", "steps");
  EXPECT_EQ(steps.attribute("tests").as_int(), 1 + 3 * (21 + 17) + 1);   // the supply, the recordings, the outcome
  EXPECT_EQ(steps.attribute("failures").as_int(), 0);
}

TEST(Traces, FollowTheWholeRunAndAreTheSameFromTheStoreAsTheyCame) {
  const FinishedRun run;
  const std::vector<TraceRow> kept = run.store().trace();
  ASSERT_EQ(kept.size(), run.heard.size());
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(kept[i].raw, run.heard[i].raw);
  const Traces traces = traces_of(run.sequence, run.store());
  const auto finite_range = [](const std::vector<double>& v) {
    double low = 1e9, high = -1e9;
    for (const double x : v)
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    return std::pair(low, high);
  };
  const auto [cold, hot] = finite_range(traces.temperature_degC());
  EXPECT_NEAR(cold, 5, 1);
  EXPECT_NEAR(hot, 45, 1);
  const auto [low, high] = finite_range(traces.current_A("gyro_2"));   // 5 s of 20 s at +-200 mA
  EXPECT_GT(high, 20e-3);
  EXPECT_LT(low, -20e-3);
  for (std::size_t i = 1; i < traces.time_s().size(); ++i) EXPECT_LT(traces.time_s()[i] - traces.time_s()[i - 1], 2 * kTracePeriod_s);
}

TEST(LiveView, ReadsUnitsAsPeopleWriteThem) {
  EXPECT_EQ(as_read("temperature=5 degC/channel=gyro_2"), "temperature=5 \u00B0C/channel=gyro_2");
  EXPECT_EQ(as_read("set calibrator.current -30 uA"), "set calibrator.current -30 \u00B5A");
}

TEST(LiveView, IsReplacedWholeWhileTheBenchRuns) {
  const FinishedRun run;
  const TemporaryDirectory directory;
  LiveView live(run.sequence, directory.path(), std::chrono::milliseconds(0));
  const auto picture = [&] { return bytes_of(directory / "live.png"); };
  for (std::size_t i = 0; i < 40; ++i) live.add(run.heard[i]);
  const std::string early = picture();
  ASSERT_TRUE(early.starts_with("\x89PNG"));
  EXPECT_TRUE(early.ends_with(std::string("IEND\xAE\x42\x60\x82", 8)));
  live.take_over(run.store());
  live.draw();
  EXPECT_NE(picture(), early);
  EXPECT_NE(bytes_of(directory / "live.html").find("live.png"), std::string::npos);
  EXPECT_NE(bytes_of(directory / "live.html").find("<meta name=\"viewport\""), std::string::npos);
  for (const auto& entry : std::filesystem::directory_iterator(directory.path()))   // nothing half-written remains
    EXPECT_TRUE(entry.path().filename() == "live.png" || entry.path().filename() == "live.html") << entry.path();
}

}  // namespace
}  // namespace waverig::rig::bench
