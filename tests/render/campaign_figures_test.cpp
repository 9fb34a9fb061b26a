#include "render/campaign_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "lcmtypes/error.h"
#include "render/figures/accuracy.h"
#include "render/figures/calibration.h"
#include "render/figures/direction.h"
#include "render/figures/methods.h"
#include "render/figures/noise.h"
#include "render/figures/sea.h"
#include "render/layout.h"
#include "render/marks.h"
#include "tests/render/example_campaign.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

// Every figure of a campaign, without its logs on disk.
std::vector<NamedFigure> figures_of(const evaluation::CampaignResults& results,
                                    const evaluation::RunRecord& run) {
  FigureOptions options;
  options.uncalibrated = [](const evaluation::RunRecord& r) { return recorded_traces(r, "lee2014"); };
  std::vector<NamedFigure> figures = run_figures(results, run, options);
  for (NamedFigure& figure : result_figures(results)) figures.push_back(std::move(figure));
  return figures;
}

std::vector<NamedFigure> all_figures() { return figures_of(test::example_campaign(), test::example_run()); }
std::vector<NamedFigure> sea_figures() {
  return figures_of(test::example_sea_campaign(), test::example_sea_run());
}

bool holds(const std::vector<NamedFigure>& figures, std::string_view stem) {
  return std::any_of(figures.begin(), figures.end(), [&](const NamedFigure& f) { return f.stem == stem; });
}

// A campaign that has no setting of the paper's.
evaluation::CampaignResults elsewhere() {
  evaluation::CampaignResults results = test::example_campaign();
  for (auto& cell : results.cells) cell.period_s += 0.5;
  for (auto& run : results.runs) run.period_s += 0.5;
  return results;
}

TEST(CampaignFigures, NameThePaperOnlyWhereASettingOfItsIsShown) {
  const Figure beside = table2_figure(test::example_campaign()), alone = table2_figure(elsewhere());
  EXPECT_NE((beside.title + beside.subtitle).find("published"), std::string::npos);
  EXPECT_NE(beside.subtitle.find("Lee"), std::string::npos);
  for (const char* word : {"published", "Lee"}) EXPECT_EQ((alone.title + alone.subtitle).find(word), std::string::npos);
  EXPECT_TRUE(holds(result_figures(test::example_campaign()), "paper-table-2"));
  EXPECT_FALSE(holds(result_figures(elsewhere()), "paper-table-2"));
  EXPECT_TRUE(holds(result_figures(elsewhere()), "mean-heights"));
}

TEST(CampaignFigures, AreAllThoseThatTheReportNames) {
  std::vector<NamedFigure> figures = all_figures();
  for (NamedFigure& figure : sea_figures()) figures.push_back(std::move(figure));
  for (NamedFigure& figure : result_figures(elsewhere())) figures.push_back(std::move(figure));
  for (const FigureInfo& info : kFigureOrder) {
    if (info.stem == "rig" || info.stem == "buoy") continue;  // no plots
    EXPECT_TRUE(std::any_of(figures.begin(), figures.end(), [&](const NamedFigure& f) {
      return f.stem == info.stem;
    })) << info.stem;
  }
  for (const NamedFigure& f : figures)
    EXPECT_TRUE(std::any_of(kFigureOrder.begin(), kFigureOrder.end(), [&](const FigureInfo& i) {
      return i.stem == f.stem;
    })) << f.stem;
}

TEST(CampaignFigures, AreTheSameBytesForAnyNumberOfThreads) {
  std::vector<NamedFigure> figures = all_figures();
  for (NamedFigure& f : figures) f.figure.dots_per_inch = 80;
  const test::TemporaryFolder one, three;
  FigureOptions options;
  options.svg = true;
  const auto single = write_figures(figures, one.path(), options);
  options.threads = 3;
  const auto triple = write_figures(figures, three.path(), options);
  ASSERT_EQ(single.size(), triple.size());
  for (std::size_t i = 0; i < single.size(); ++i) {
    EXPECT_EQ(single[i].filename(), triple[i].filename());
    EXPECT_EQ(test::bytes_of(single[i]), test::bytes_of(triple[i])) << single[i].filename();
    std::filesystem::path svg = single[i], other = triple[i];
    EXPECT_EQ(test::bytes_of(svg.replace_extension("svg")), test::bytes_of(other.replace_extension("svg")));
  }
}

// On a sea the set height is Hm0: no single wave has it, and the paper's table has no part in it.
TEST(CampaignFigures, OfSeasJudgeStatesInsteadOfSetHeights) {
  const std::vector<NamedFigure> regular = all_figures(), seas = sea_figures();
  for (const char* stem : {"paper-table-2", "error-map", "std-map"}) {
    EXPECT_TRUE(holds(regular, stem)) << stem;
    EXPECT_FALSE(holds(seas, stem)) << stem;
  }
  for (const char* stem : {"sea-states", "sea-heave-map", "sea-trace"}) {
    EXPECT_FALSE(holds(regular, stem)) << stem;
    EXPECT_TRUE(holds(seas, stem)) << stem;
  }
  for (const NamedFigure& f : seas) {
    EXPECT_EQ(f.figure.subtitle.find("error rate"), std::string::npos) << f.stem;
    EXPECT_EQ(f.figure.subtitle.find("published"), std::string::npos) << f.stem;
  }
}

TEST(SeaStates, AreTheRatiosToTheTruth) {
  const Figure figure = sea_states_figure(test::example_sea_campaign());
  ASSERT_EQ(figure.panels.size(), 3U);
  const auto values_of = [&](std::size_t panel, const std::string& method) {
    for (const Mark& mark : figure.panels[panel].marks) {
      if (const auto* points = std::get_if<Points>(&mark); points != nullptr && points->name == method)
        return points->y;
    }
    return std::vector<double>{};
  };
  ASSERT_EQ(values_of(0, "harmonic").size(), 6U);
  for (const double percent : values_of(0, "harmonic")) EXPECT_NEAR(percent, 1, 1e-9);
  for (const double percent : values_of(0, "lee2014")) EXPECT_NEAR(percent, 10, 1e-9);
  for (const double percent : values_of(1, "harmonic")) EXPECT_NEAR(percent, 0.5, 1e-9);
  for (const double percent : values_of(2, "harmonic")) EXPECT_NEAR(percent, -0.2, 1e-9);
  EXPECT_TRUE(values_of(1, "lee2014").empty()) << "it gives no sea state";
}

TEST(SeaStates, ShowTheLimitBelowEachMethodThatHasOne) {
  evaluation::CampaignResults campaign = test::example_sea_campaign();
  for (evaluation::CellResult& cell : campaign.cells)
    if (cell.method == "harmonic") cell.heave_bound_m = 0.004 * cell.true_hm0_m;
  const Figure figure = sea_states_figure(campaign);
  const Points* harmonic = nullptr;
  std::vector<const Line*> limits;
  for (const Mark& mark : figure.panels[0].marks) {
    if (const auto* line = std::get_if<Line>(&mark)) limits.push_back(line);
    if (const auto* points = std::get_if<Points>(&mark); points != nullptr && points->name == "harmonic")
      harmonic = points;
  }
  ASSERT_NE(harmonic, nullptr);
  ASSERT_EQ(limits.size(), harmonic->x.size());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    EXPECT_NEAR(limits[i]->y[0], 0.4, 1e-9);
    EXPECT_NEAR((limits[i]->x[0] + limits[i]->x[1]) / 2, harmonic->x[i], 1e-9);
    EXPECT_EQ(limits[i]->name.empty(), i > 0) << "one entry in the legend";
  }
  EXPECT_NE(figure.subtitle.find("a single record may fall below"), std::string::npos);
  EXPECT_EQ(sea_states_figure(test::example_sea_campaign()).subtitle.find("limit"), std::string::npos);
}

TEST(SeaTrace, ErrorsHaveNoMeanAndTheTruthIsTrue) {
  const Figure figure = sea_trace_figure(test::example_sea_run());
  ASSERT_EQ(figure.panels.size(), 2U);
  for (const Mark& mark : figure.panels[1].marks) {
    const Line& error = std::get<Line>(mark);
    double sum = 0;
    for (const double y : error.y) sum += y;
    EXPECT_NEAR(sum / static_cast<double>(error.y.size()), 0, 1e-9);
  }
  const Line& harmonic = std::get<Line>(figure.panels[1].marks[1]);
  for (const double y : harmonic.y) EXPECT_LT(std::abs(y), 1) << "0.4 cm of error was put in";
}

// The closed form of figure 6's note: a bias b alone gives waves of b T^2 / pi^2.
TEST(PaperFigures, NameTheBiasOfAnUncalibratedAccelerometer) {
  const evaluation::RunRecord run = test::example_run(12, 1.0, 120);
  PaperTraces traces = recorded_traces(run, "harmonic");
  constexpr double kBias = 0.2;
  for (estimator::HeaveSample& sample : traces.heave) {
    const double t = static_cast<double>(sample.utime - run.start_utime) * 1e-6;
    sample.heave_m += 0.5 * kBias * t * t;
  }
  const std::string subtitle = corrected_trace_figure(run, traces, false).subtitle;
  EXPECT_NE(subtitle.find("b = 0.200 m/s\u00B2"), std::string::npos) << subtitle;
  EXPECT_NE(subtitle.find("= 292 cm"), std::string::npos) << subtitle;
  EXPECT_EQ(corrected_trace_figure(run, traces, true).subtitle.find("b ="), std::string::npos);
  for (estimator::HeaveSample& sample : traces.heave) {
    const double t = static_cast<double>(sample.utime - run.start_utime) * 1e-6;
    sample.heave_m -= kBias * t * t;
  }
  const std::string below = corrected_trace_figure(run, traces, false).subtitle;
  EXPECT_NE(below.find("b = \u22120.200 m/s\u00B2"), std::string::npos) << below;
}

TEST(PaperFigures, SayWhereTheyDoNotShowTheWholeRecord) {
  const evaluation::RunRecord whole = test::example_run(2, 1.0, 100), longer = test::example_run(2, 1.0, 200);
  const auto subtitle_of = [](const evaluation::RunRecord& run) {
    return corrected_trace_figure(run, recorded_traces(run, "harmonic"), true).subtitle;
  };
  EXPECT_EQ(subtitle_of(whole).find("shown"), std::string::npos) << subtitle_of(whole);
  EXPECT_NE(subtitle_of(longer).find("shown: the first 144 of 228 s"), std::string::npos) << subtitle_of(longer);
}

TEST(CampaignFigures, ShowTheLongestAndHighestRun) {
  const evaluation::CampaignResults results = test::example_campaign();
  const evaluation::RunResult* run = paper_run(results);
  ASSERT_NE(run, nullptr);
  EXPECT_EQ(run->period_s, 12);
  EXPECT_EQ(run->height_m, 1.0);
  EXPECT_EQ(run->repeat, 0);
  EXPECT_EQ(paper_run({}), nullptr);
}

TEST(CampaignFigures, AreDrawnForAnEmptyCampaignToo) {
  EXPECT_TRUE(result_figures({}).empty());
  const test::TemporaryFolder folder;
  EXPECT_TRUE(draw_campaign_figures({}, folder.path(), folder.path() / "figures", {}).empty());
}

TEST(CampaignFigures, NameTheLogThatIsMissing) {
  const test::TemporaryFolder folder;
  try {
    draw_campaign_figures(test::example_campaign(), folder.path(), folder.path(), {});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find(".lcm"), std::string::npos);
  }
}

TEST(CampaignFigures, LeaveOutWhatWasNotMeasured) {
  evaluation::CampaignResults results = test::example_campaign();
  results.calibration_json.clear();
  for (evaluation::RunResult& run : results.runs) run.seas.clear();
  for (const NamedFigure& f : result_figures(results)) {
    EXPECT_NE(f.stem, "calibration");
    EXPECT_NE(f.stem, "directions");
  }
}

TEST(CalibrationFigure, SaysWhereTheReportIsNoCalibration) {
  EXPECT_THROW(calibration_figure("{"), UserError);
  EXPECT_THROW(calibration_figure("{\"positions\": [{\"name\": 3}]}"), UserError);
  EXPECT_FALSE(calibration_figure("").has_value());
}

TEST(Rose, SharesAddUpToHundredPercent) {
  const Panel panel = rose_panel("", {0.0, 6.2831, -0.1, 3.2, 1.0}, {1, 2, 3, 4, kAuto});
  double total = 0;
  for (const Mark& mark : panel.marks) {
    const auto& bars = std::get<Bars>(mark);
    for (std::size_t i = 0; i < bars.value.size(); ++i) total += bars.value[i] - bars.base[i];
  }
  EXPECT_NEAR(total, 100, 1e-9);
  EXPECT_NEAR(std::get<Bars>(panel.marks.back()).value[0], 75, 1e-9) << "north, from both sides of zero";
}

TEST(Rose, TheHighestSeaCountsWhereItIsTheUpperEdgeOfAClass) {
  for (const double highest_m : {0.5, 1.0, 2.0, 2.5, 4.0, 10.0}) {
    const Panel panel = rose_panel("", {1.0, 2.0}, {0.1 * highest_m, highest_m});
    double total = 0;
    for (const Mark& mark : panel.marks)
      for (std::size_t i = 0; i < std::get<Bars>(mark).value.size(); ++i)
        total += std::get<Bars>(mark).value[i] - std::get<Bars>(mark).base[i];
    EXPECT_NEAR(total, 100, 1e-9) << highest_m;
  }
}

// Where a text of the rose stands on the page, from its vectors.
std::pair<double, double> place_of(const std::string& svg, const std::string& text) {
  const std::regex pattern("translate\\(([0-9.]+) ([0-9.]+)\\)[^>]*>" + text + "</text>");
  std::smatch match;
  if (!std::regex_search(svg, match, pattern)) return {kAuto, kAuto};
  return {std::stod(match[1]), std::stod(match[2])};
}

TEST(Rose, RingsAreLabelledWhereNoSectorIs) {
  Canvas canvas;
  // Ring labels stand at 22.5 degrees where that is free, else at the first free one of the eight between the names.
  for (const auto& [from_deg, label_deg] : {std::pair{180.0, 22.5}, {22.5, 67.5}}) {
    Figure figure{.width_mm = 80, .height_mm = 80};
    figure.panels.push_back(rose_panel("", {from_deg * kDegree}, {1}));
    const std::string svg = svg_text(figure, canvas.fonts(), {});
    const auto [north_x, north_y] = place_of(svg, "N");
    const auto [east_x, east_y] = place_of(svg, "E");
    const auto [x, y] = place_of(svg, "[0-9]+ %");
    EXPECT_NEAR(std::atan2(x - north_x, east_y - y) / kDegree, label_deg, 1.0);
  }
}

TEST(Methods, BaselineComesFirst) {
  EXPECT_EQ(in_order({"a", "lee2014", "b"}), (std::vector<std::string>{"lee2014", "a", "b"}));
}

TEST(CampaignFigures, BudgetsShareAScaleOnlyWhereBothCanBeRead) {
  evaluation::CampaignResults results = test::example_campaign();
  const auto scale_calibration = [&](const std::string& method, double factor) {
    for (auto& cell : results.cells)
      if (cell.method == method)
        for (auto& part : cell.statistics.budget) part.sigma_m *= factor;
  };
  const Figure alike = uncertainty_budget_figure(results);
  ASSERT_GE(alike.panels.size(), 2U);
  EXPECT_TRUE(alike.share_x);
  EXPECT_EQ(alike.panels[0].x.high, alike.panels[1].x.high);
  scale_calibration("lee2014", 100);
  const Figure apart = uncertainty_budget_figure(results);
  EXPECT_FALSE(apart.share_x);
  EXPECT_GT(std::abs(std::log(apart.panels[0].x.high / apart.panels[1].x.high)), std::log(5.0));
  EXPECT_NE(apart.subtitle.find("a scale of its own"), std::string::npos);
}

TEST(CampaignFigures, BudgetsOfSeasLeaveOutHowTheSeasWavesDiffer) {
  const auto rows_of = [](evaluation::CampaignResults results) {
    for (auto& cell : results.cells) cell.statistics.budget.push_back({"frequency", 0, 'B'});
    return uncertainty_budget_figure(results).panels.at(0).y.categories;
  };
  EXPECT_EQ(rows_of(test::example_campaign()), (std::vector<std::string>{"combined", "calibration (B)", "noise (A)"}))
      << "a row of nothing stands in none";
  EXPECT_EQ(rows_of(test::example_sea_campaign()), (std::vector<std::string>{"combined", "calibration (B)"}));
}

TEST(CampaignFigures, BudgetsNameEverySettingThatAnyMethodHas) {
  evaluation::CampaignResults results = test::example_campaign();
  std::erase_if(results.cells,
                [](const auto& c) { return c.method == "lee2014" && (c.period_s > 6 || c.height_m > 0.6); });
  const Figure figure = uncertainty_budget_figure(results);
  ASSERT_EQ(figure.panels.at(0).title, "lee2014");
  std::vector<std::string> named;
  for (const Mark& mark : figure.panels[0].marks) {
    EXPECT_TRUE(extents_of(mark, Scale::kLinear, Scale::kLinear).has_data) << "or the legend leaves it out";
    named.push_back(name_of(mark));
  }
  EXPECT_EQ(named, (std::vector<std::string>{"6 s, 60 cm", "6 s, 100 cm", "12 s, 60 cm", "12 s, 100 cm"}));
}

// Of a panel's line with that name.
const Line* line_of(const Panel& panel, const std::string& name) {
  for (const Mark& mark : panel.marks) {
    if (const auto* line = std::get_if<Line>(&mark); line != nullptr && line->name == name) return line;
  }
  return nullptr;
}

TEST(FrequencyResponse, HasNoGainOfATraceThatRanAwayAndNoScatterOfOneRun) {
  evaluation::CampaignResults results = test::example_campaign();
  std::erase_if(results.runs, [](const auto& r) { return r.repeat > 0 || r.height_m != 0.6; });
  for (auto& run : results.runs) {
    if (run.method != "lee2014" || run.period_s < 12) continue;
    run.statistics.waves = 0;
    run.heave_gain = 103;
  }
  const Figure figure = frequency_response_figure(results);
  const Line* line = line_of(figure.panels.at(0), "lee2014");
  ASSERT_NE(line, nullptr);
  ASSERT_EQ(line->y.size(), 2U);
  EXPECT_NEAR(line->y[0], 1, 0.1);
  EXPECT_TRUE(std::isnan(line->y[1])) << line->y[1];
  for (const Mark& mark : figure.panels[0].marks) {
    const auto* bars = std::get_if<ErrorBars>(&mark);
    if (bars == nullptr) continue;
    for (const double length : bars->plus) EXPECT_TRUE(std::isnan(length)) << length;
  }
}

TEST(FrequencyResponse, SaysWhatIsThere) {
  evaluation::CampaignResults results = test::example_campaign();
  const Figure whole = frequency_response_figure(results);
  EXPECT_NE(whole.subtitle.find("bars: standard deviation between those runs, which differ in height"), std::string::npos);
  EXPECT_EQ(whole.panels.at(0).x.label, "Wave period");
  EXPECT_EQ(frequency_response_figure(test::example_sea_campaign()).panels.at(0).x.label, "Set peak period");
  const auto keep = [&](auto kept) {
    std::erase_if(results.cells, [&](const auto& c) { return !kept(c); });
    std::erase_if(results.runs, [&](const auto& r) { return !kept(r); });
  };
  keep([](const auto& of) { return of.height_m == 0.6; });
  const Figure one_height = frequency_response_figure(results);
  EXPECT_NE(one_height.subtitle.find("bars:"), std::string::npos);
  EXPECT_EQ(one_height.subtitle.find("height"), std::string::npos) << one_height.subtitle;
  EXPECT_TRUE(one_height.panels.at(0).x.categories.empty());
  std::erase_if(results.runs, [](const auto& r) { return r.repeat > 0; });
  EXPECT_EQ(frequency_response_figure(results).subtitle.find("bars"), std::string::npos) << "none is drawn";
  keep([](const auto& of) { return of.period_s == 6; });
  const Figure single = frequency_response_figure(results);
  EXPECT_EQ(single.panels.at(0).x.categories, (std::vector<std::string>{"6"})) << "no ticks where there is nothing";
  EXPECT_EQ(line_of(single.panels.at(0), "harmonic")->x, (std::vector<double>{0}));
}

TEST(SingleWaves, AreCountedByMethodAndNoneIsLowerThanNothing) {
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_TRUE(single_waves_figure(results).subtitle.starts_with("120 waves of each method"));
  results.runs.front().waves.pop_back();
  EXPECT_TRUE(single_waves_figure(results).subtitle.starts_with("119 to 120 waves of each method"));
  evaluation::CampaignResults seas = test::example_sea_campaign();
  for (auto& run : seas.runs)
    for (std::size_t i = 0; i < run.waves.size(); ++i)
      run.waves[i].true_height_m = run.waves[i].wave.height_m = 0.1 + static_cast<double>(i);
  Figure figure = single_waves_figure(seas);
  const Line* equal = line_of(figure.panels.at(0), "equal");
  ASSERT_NE(equal, nullptr);
  EXPECT_EQ(equal->x.front(), 0);
  FontBook fonts;
  prepare_fonts(figure, fonts);
  fonts.bake();
  for (const PanelPlan& p : planned(figure, fonts).panels) EXPECT_EQ(p.x.low, 0);
}

TEST(ErrorMap, OfASingleSettingHasRoomForTheNamesOfItsAxes) {
  evaluation::CampaignResults results = test::example_campaign();
  const auto other = [](const auto& of) {
    return of.period_s != 6 || of.height_m != 0.6 || of.method != "harmonic";
  };
  std::erase_if(results.cells, other);
  std::erase_if(results.runs, other);
  Canvas canvas;
  for (const Figure& figure : {error_map_figure(results), std_map_figure(results)}) {
    const std::string svg = svg_text(figure, canvas.fonts(), {});
    EXPECT_EQ(svg.find("\u2026"), std::string::npos) << figure.title;
    EXPECT_NE(svg.find("Set height (cm)"), std::string::npos);
  }
}

TEST(SeaTrace, MethodsThatTellTheSameHeaveAreOneLine) {
  evaluation::RunRecord run = test::example_sea_run();
  run.heave["spectral"] = run.heave["harmonic"];
  const Figure trace = sea_trace_figure(run), spectra = spectra_figure(run, kAuto);
  EXPECT_NE(line_of(trace.panels.at(0), "harmonic, spectral"), nullptr);
  EXPECT_EQ(trace.panels.at(1).marks.size(), 2U);
  EXPECT_NE(line_of(spectra.panels.at(1), "harmonic, spectral"), nullptr);
  EXPECT_NE(spectra.subtitle.find("peak period"), std::string::npos) << spectra.subtitle;
}

}  // namespace
}  // namespace waverig::render
