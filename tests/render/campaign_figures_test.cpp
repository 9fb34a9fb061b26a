#include "render/campaign_figures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lcmtypes/error.h"
#include "render/figures/calibration.h"
#include "render/figures/direction.h"
#include "render/figures/methods.h"
#include "tests/render/example_campaign.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

// Every figure of a campaign, without its logs on disk.
std::vector<NamedFigure> all_figures() {
  const evaluation::CampaignResults results = test::example_campaign();
  const evaluation::RunRecord run = test::example_run();
  FigureOptions options;
  options.uncalibrated = [](const evaluation::RunRecord& r) { return recorded_traces(r, "lee2014"); };
  std::vector<NamedFigure> figures = run_figures(results, run, options);
  for (NamedFigure& figure : result_figures(results)) figures.push_back(std::move(figure));
  return figures;
}

TEST(CampaignFigures, AreAllThoseThatTheReportNames) {
  const std::vector<NamedFigure> figures = all_figures();
  for (const FigureInfo& info : kFigureOrder) {
    if (info.stem == "rig") continue;  // not a plot
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

TEST(Methods, BaselineComesFirst) {
  EXPECT_EQ(in_order({"a", "lee2014", "b"}), (std::vector<std::string>{"lee2014", "a", "b"}));
}

}  // namespace
}  // namespace waverig::render
