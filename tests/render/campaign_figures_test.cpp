#include "render/campaign_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lcmtypes/error.h"
#include "render/figures/accuracy.h"
#include "render/figures/calibration.h"
#include "render/figures/methods.h"
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
  for (const char* word : {"published", "Lee"})
    EXPECT_EQ((alone.title + alone.subtitle).find(word), std::string::npos);
  EXPECT_TRUE(holds(result_figures(test::example_campaign()), "paper-table-2"));
  EXPECT_FALSE(holds(result_figures(elsewhere()), "paper-table-2"));
  EXPECT_TRUE(holds(result_figures(elsewhere()), "mean-heights"));
}

TEST(CampaignFigures, OfManySettingsChartThePublishedOnesAlone) {
  const auto grown = [](evaluation::CampaignResults results) {
    const std::vector<evaluation::CellResult> cells = results.cells;
    for (int i = 1; i <= 5; ++i)
      for (evaluation::CellResult cell : cells) {
        cell.period_s += 0.01 * i;
        results.cells.push_back(cell);
      }
    return results;
  };
  EXPECT_EQ(table2_figure(grown(test::example_campaign())).panels.at(0).x.categories.size(), 6U);
  EXPECT_TRUE(table2_figure(grown(elsewhere())).panels.empty()) << "the maps show them";
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

TEST(CampaignFigures, HaveNothingToShowWhereNoWaveWasFound) {
  for (evaluation::CampaignResults results : {test::example_campaign(), test::example_sea_campaign()}) {
    for (evaluation::CellResult& cell : results.cells) {
      cell.statistics = {};
      cell.statistics.bound_std_m = 0.01;
      cell.heave_rmse_m = estimator::kUnknown;
      cell.sea = {};
    }
    for (evaluation::RunResult& run : results.runs) {
      run.waves.clear();
      run.seas.clear();
      run.statistics = {};
      run.heave_rmse_m = run.heave_gain = estimator::kUnknown;
    }
    results.calibration_json.clear();
    for (const NamedFigure& f : result_figures(results)) ADD_FAILURE() << f.stem << " is empty";
  }
}

TEST(CalibrationFigure, SaysWhereTheReportIsNoCalibration) {
  EXPECT_THROW(calibration_figure("{"), UserError);
  EXPECT_THROW(calibration_figure("{\"positions\": [{\"name\": 3}]}"), UserError);
  EXPECT_FALSE(calibration_figure("").has_value());
}

TEST(Methods, BaselineComesFirst) {
  EXPECT_EQ(in_order({"a", "lee2014", "b"}), (std::vector<std::string>{"lee2014", "a", "b"}));
}

// A program judged beside the campaign's methods has no heave in the recordings: the others keep their colours.
TEST(CampaignFigures, GiveAMethodOneColour) {
  evaluation::CampaignResults results = test::example_sea_campaign();
  const auto add_other = [](auto& list) {
    auto others = list;
    for (auto& other : others) other.method = "another";
    others.insert(others.end(), list.begin(), list.end());
    list = others;
  };
  add_other(results.cells);
  add_other(results.runs);
  std::map<std::string, std::set<int>> colors;
  for (const NamedFigure& f : figures_of(results, test::example_sea_run()))
    for (const Panel& panel : f.figure.panels)
      for (const Mark& mark : panel.marks) {
        if (const auto* line = std::get_if<Line>(&mark)) colors[line->name].insert(line->look.color);
        if (const auto* points = std::get_if<Points>(&mark)) colors[points->name].insert(points->look.color);
      }
  EXPECT_EQ(colors["lee2014"], (std::set<int>{0}));
  EXPECT_EQ(colors["another"], (std::set<int>{1}));
  EXPECT_EQ(colors["harmonic"], (std::set<int>{2}));
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
  EXPECT_EQ(rows_of(test::example_campaign()),
            (std::vector<std::string>{"combined", "calibration (B)", "noise (A)"}))
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
  int unknown = 0;
  for (const Mark& mark : figure.panels[0].marks) {
    if (const auto* note = std::get_if<Note>(&mark)) {  // not a bar of no uncertainty
      EXPECT_EQ(note->text, "\u2013");
      ++unknown;
      continue;
    }
    EXPECT_TRUE(extents_of(mark, Scale::kLinear, Scale::kLinear).has_data) << "or the legend leaves it out";
    named.push_back(name_of(mark));
  }
  EXPECT_EQ(unknown, 9) << "three contributions of three settings";
  EXPECT_NE(figure.subtitle.find("\u2013 not known"), std::string::npos);
  EXPECT_EQ(named, (std::vector<std::string>{"6 s, 60 cm", "6 s, 100 cm", "12 s, 60 cm", "12 s, 100 cm"}));
}

}  // namespace
}  // namespace waverig::render
