// Figures of seas: their states, a record's trace, where the waves come from.
#include "render/figures/sea.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "render/figure_writer.h"
#include "render/figures/direction.h"
#include "render/figures/noise.h"
#include "tests/render/example_campaign.h"
#include "tests/render/line_of.h"

namespace waverig::render {
namespace {

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

TEST(SeaStates, ShowTheBoundBelowEachMethodThatHasOne) {
  evaluation::CampaignResults campaign = test::example_sea_campaign();
  for (evaluation::CellResult& cell : campaign.cells)
    if (cell.method == "harmonic") cell.heave_bound_m = 0.004 * cell.true_hm0_m;
  const Figure figure = sea_states_figure(campaign);
  const Points* harmonic = nullptr;
  std::vector<const Line*> bounds;
  for (const Mark& mark : figure.panels[0].marks) {
    if (const auto* line = std::get_if<Line>(&mark)) bounds.push_back(line);
    if (const auto* points = std::get_if<Points>(&mark); points != nullptr && points->name == "harmonic")
      harmonic = points;
  }
  ASSERT_NE(harmonic, nullptr);
  ASSERT_EQ(bounds.size(), harmonic->x.size());
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    EXPECT_NEAR(bounds[i]->y[0], 0.4, 1e-9);
    EXPECT_NEAR((bounds[i]->x[0] + bounds[i]->x[1]) / 2, harmonic->x[i], 1e-9);
    EXPECT_EQ(bounds[i]->name.empty(), i > 0) << "one entry in the legend";
  }
  EXPECT_NE(figure.subtitle.find("a single record may fall below"), std::string::npos);
  EXPECT_EQ(sea_states_figure(test::example_sea_campaign()).subtitle.find("bound"), std::string::npos);
}

TEST(SeaStates, ShowTheStatedUncertaintyOfHm0) {
  evaluation::CampaignResults campaign = test::example_sea_campaign();
  const auto lengths_of = [&] {
    std::vector<double> lengths;
    const Figure figure = sea_states_figure(campaign);
    for (const Mark& mark : figure.panels.at(1).marks)
      if (const auto* bars = std::get_if<ErrorBars>(&mark)) lengths = bars->plus;
    return lengths;
  };
  EXPECT_TRUE(lengths_of().empty());
  for (evaluation::CellResult& cell : campaign.cells)
    if (cell.method == "harmonic") cell.sea.sea.hm0_sigma_m = 0.003 * cell.true_hm0_m;
  ASSERT_EQ(lengths_of().size(), 6U);
  for (const double percent : lengths_of()) EXPECT_NEAR(percent, 0.6, 1e-9);
}

TEST(SeaTrace, ErrorsHaveNoMeanAndTheTruthIsTrue) {
  const Figure figure = sea_trace_figure(test::example_sea_run(), {});
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

TEST(SeaTrace, MethodsThatTellTheSameHeaveAreOneLine) {
  evaluation::RunRecord run = test::example_sea_run();
  run.heave["spectral"] = run.heave["harmonic"];
  const Figure trace = sea_trace_figure(run, {}), spectra = spectra_figure(run, kAuto, {});
  EXPECT_NE(line_of(trace.panels.at(0), "harmonic, spectral"), nullptr);
  EXPECT_EQ(trace.panels.at(1).marks.size(), 2U);
  EXPECT_NE(line_of(spectra.panels.at(1), "harmonic, spectral"), nullptr);
  EXPECT_NE(spectra.subtitle.find("peak period"), std::string::npos) << spectra.subtitle;
}

TEST(Directions, ExplainTheirLimitsAndLeaveTheDataFree) {
  evaluation::CampaignResults results = test::example_campaign();
  for (auto& run : results.runs)
    for (auto& sea : run.seas) {
      sea.direction.mean_direction_rad = sea.sea.mean_direction_rad;
      sea.sea.spread_rad = sea.direction.spread_rad = 0.3;
    }
  const Figure figure = direction_figure(results).value();
  ASSERT_EQ(figure.panels.size(), 3U);
  EXPECT_EQ(figure.panels[0].title, "(a) harmonic");
  EXPECT_EQ(figure.panels[2].title, "(c) Spread");
  EXPECT_NE(figure.subtitle.find("CDIP: "), std::string::npos);
  for (const std::size_t panel : {1U, 2U}) EXPECT_EQ(figure.panels[panel].legend, Legend::kAbove);
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
  // Ring labels stand at 22.5 degrees where that is free, else at the first free one of the eight between the
  // names.
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

}  // namespace
}  // namespace waverig::render
