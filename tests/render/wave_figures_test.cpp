// Figures of single waves and of what each method makes of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "render/campaign_figures.h"
#include "render/figure_writer.h"
#include "render/figures/accuracy.h"
#include "render/figures/noise.h"
#include "render/figures/paper.h"
#include "render/layout.h"
#include "render/marks.h"
#include "tests/render/example_campaign.h"
#include "tests/render/line_of.h"

namespace waverig::render {
namespace {

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
  EXPECT_NE(subtitle_of(longer).find("shown: the first 144 of 228 s"), std::string::npos)
      << subtitle_of(longer);
}

TEST(PaperFigures, ShowHeaveInCentimetres) {
  const evaluation::RunRecord run = test::example_run(12, 1.0, 120);
  const PaperTraces traces = recorded_traces(run, "harmonic");
  const Panel before = uncorrected_trace_figure(run, traces, true).panels.at(1);
  const Panel after = corrected_trace_figure(run, traces, true).panels.at(0);
  for (const Panel& panel : {before, after}) EXPECT_EQ(panel.y.unit, "cm");
  const Line* truth = line_of(before, "true heave");
  ASSERT_NE(truth, nullptr);
  EXPECT_NEAR(*std::ranges::max_element(truth->y), 50, 0.1);
}

TEST(PaperFigures, TellTheMeanOfASingleWaveWithoutAScatter) {
  evaluation::RunRecord run = test::example_run();
  run.waves["harmonic"].resize(1);
  const std::string subtitle = corrected_trace_figure(run, recorded_traces(run, "harmonic"), true).subtitle;
  EXPECT_NE(subtitle.find("of a single wave"), std::string::npos) << subtitle;
  EXPECT_EQ(subtitle.find("no steady waves"), std::string::npos) << subtitle;
  EXPECT_EQ(subtitle.find("nan"), std::string::npos) << subtitle;
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

TEST(FrequencyResponse, ShowsWhereRunsAreMissingAndWeighsTheOthersByTheirWaves) {
  evaluation::CampaignResults results = test::example_campaign();
  const auto hollow_of = [](const Figure& figure, std::size_t panel) {
    for (const Mark& mark : figure.panels.at(panel).marks)
      if (const auto* points = std::get_if<Points>(&mark); points != nullptr) return points->x;
    return std::vector<double>{};
  };
  EXPECT_TRUE(hollow_of(frequency_response_figure(results), 0).empty());
  int left = 0;
  for (auto& run : results.runs) {
    if (run.method != "harmonic" || run.period_s != 6) continue;
    run.statistics.mean_height_m = run.statistics.mean_true_height_m;
    run.heave_lag_s = 0;
    if (++left == 1) {  // found few waves, far too high
      run.statistics.waves = 1;
      run.statistics.mean_height_m *= 1.51;
    }
    if (left == 2) {  // found none, and its heave ran away
      run.statistics = {};
      run.heave_rmse_m = 20;
    }
    if (left == 3) {  // no phase: no gain either, or the two would be of different runs
      run.statistics.mean_height_m *= 2;
      run.heave_rmse_m = 20;
    }
  }
  const Figure figure = frequency_response_figure(results);
  EXPECT_NEAR(line_of(figure.panels.at(0), "harmonic")->y.at(0), 1 + 0.51 / 31, 1e-9) << "three of ten waves, one of one";
  for (const std::size_t panel : {0U, 1U}) EXPECT_EQ(hollow_of(figure, panel), (std::vector<double>{6}));
  EXPECT_NE(figure.subtitle.find("hollow: some runs"), std::string::npos);
}

// On a sea single waves are of many heights: the gain is that of the heave, as in the table.
TEST(FrequencyResponse, OfSeasIsTheGainOfTheHeave) {
  evaluation::CampaignResults results = test::example_sea_campaign();
  for (auto& run : results.runs) run.heave_gain = 0.97;
  const Figure figure = frequency_response_figure(results);
  for (const double gain : line_of(figure.panels.at(0), "harmonic")->y) EXPECT_NEAR(gain, 0.97, 1e-9);
  EXPECT_NE(figure.panels[0].title, frequency_response_figure(test::example_campaign()).panels[0].title);
}

TEST(FrequencyResponse, SaysWhatIsThere) {
  evaluation::CampaignResults results = test::example_campaign();
  const Figure whole = frequency_response_figure(results);
  EXPECT_NE(whole.subtitle.find("bars: standard deviation between those runs, which differ in height"),
            std::string::npos);
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
  EXPECT_EQ(single.panels.at(0).x.categories, (std::vector<std::string>{"6"}))
      << "no ticks where there is nothing";
  EXPECT_EQ(line_of(single.panels.at(0), "harmonic")->x, (std::vector<double>{0}));
}

TEST(SingleWaves, AreCountedByMethodAndNoneIsLowerThanNothing) {
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_TRUE(single_waves_figure(results).subtitle.starts_with("120 waves of each method"));
  evaluation::CampaignResults one = results;
  one.runs.resize(1);
  one.runs[0].waves.resize(1);
  EXPECT_TRUE(single_waves_figure(one).subtitle.starts_with("1 wave of each method"));
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

TEST(SingleWaves, OfMethodsThatTellTheSameAreDrawnOnceInBothPanels) {
  evaluation::CampaignResults results = test::example_campaign();
  for (auto cells = results.cells; auto& cell : cells)
    if (cell.method == "harmonic") results.cells.push_back((cell.method = "spectral", cell));
  for (auto runs = results.runs; auto& run : runs)
    if (run.method == "harmonic") results.runs.push_back((run.method = "spectral", run));
  const Figure figure = single_waves_figure(results);
  const auto points_of = [&](std::size_t panel) {
    std::vector<const Points*> points;
    for (const Mark& mark : figure.panels.at(panel).marks)
      if (const auto* p = std::get_if<Points>(&mark)) points.push_back(p);
    return points;
  };
  EXPECT_EQ(points_of(0).size(), 2U);
  EXPECT_EQ(points_of(0).at(1)->name, "harmonic, spectral");
  EXPECT_EQ(points_of(1).size(), 2U) << "none without a name";
}

TEST(SingleWaves, OfManySettingsStandSideBySideByMethod) {
  evaluation::CampaignResults results = test::example_campaign();
  const evaluation::CampaignResults few = results;
  for (int i = 1; i <= 10; ++i) {
    for (auto cell : few.cells) results.cells.push_back((cell.period_s += 0.01 * i, cell));
    for (auto run : few.runs) results.runs.push_back((run.period_s += 0.01 * i, run));
  }
  const Figure figure = single_waves_figure(results);
  const Panel& panel = figure.panels.at(1);
  EXPECT_EQ(panel.x.categories, (std::vector<std::string>{"60", "80", "100"}));
  std::vector<Extent> first;  // of each method, in the first height's place
  for (const Mark& mark : panel.marks) {
    const auto* points = std::get_if<Points>(&mark);
    if (points == nullptr) continue;
    first.emplace_back();
    for (const double x : points->x)
      if (x < 0.5) first.back().add(x);
  }
  ASSERT_EQ(first.size(), 2U);
  EXPECT_LT(first[0].high, first[1].low);
}

TEST(ErrorMap, TellsWhatWasNotRunFromWhatFoundNoWaveAndNamesThinCells) {
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_EQ(error_map_figure(results).panels.front().marks.size(), 1U);
  std::erase_if(results.cells, [](const auto& c) { return c.period_s == 12 && c.height_m == 1.0; });
  for (auto& cell : results.cells) {
    if (cell.method != "harmonic" || cell.period_s != 6) continue;
    if (cell.height_m == 0.6) cell.statistics = {};
    if (cell.height_m == 0.8) cell.statistics.waves = 9;
  }
  const Figure error = error_map_figure(results), std = std_map_figure(results);
  for (const Figure* figure : {&error, &std}) {
    const Panel& panel = figure->panels.at(1);
    ASSERT_EQ(panel.title, "harmonic");
    const HeatMap& map = std::get<HeatMap>(panel.marks.at(0));  // row by row, each 6 and 12 s
    EXPECT_EQ(map.signs, (std::vector<std::string>{"\u2013", "", "\u2020", "", "", ""}));
    EXPECT_TRUE(std::isnan(map.values[0]));
    EXPECT_TRUE(std::isnan(map.values[5]));
    EXPECT_EQ(std::get<Line>(panel.marks.at(1)).x.size(), 3U) << "struck out";
    EXPECT_NE(figure->subtitle.find("\u2020 fewer than 10 waves; \u2013 "), std::string::npos) << figure->subtitle;
    EXPECT_NE(figure->subtitle.find("struck out: not run"), std::string::npos);
  }
  for (auto& cell : results.cells)
    if (cell.method == "harmonic") cell.statistics = {};
  const Figure without = error_map_figure(results);
  EXPECT_EQ(without.panels.size(), 1U);
  EXPECT_NE(without.subtitle.find("no wave measured in any setting: harmonic"), std::string::npos) << without.subtitle;
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

}  // namespace
}  // namespace waverig::render
