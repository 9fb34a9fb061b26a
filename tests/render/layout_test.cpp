#include "render/layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/axis.h"
#include "render/figure_writer.h"
#include "render/occupancy.h"
#include "render/text_fit.h"

namespace waverig::render {
namespace {

Line cosine() {
  Line line{.name = "cosine"};
  for (int i = 0; i < 200; ++i) {
    line.x.push_back(i * 0.05);
    line.y.push_back(std::cos(line.x.back()));
  }
  return line;
}

FigurePlan plan_of(const Figure& figure, FontBook& fonts) {
  prepare_fonts(figure, fonts);
  fonts.bake();
  return planned(figure, fonts);
}

TEST(Layout, AxesOfAColumnLineUpWhateverTheirLabels) {
  Figure figure{.columns = 1, .share_x = true};
  figure.panels.push_back({.y = {.label = "wide", .low = 100000, .high = 900000}, .marks = {cosine()}});
  figure.panels.push_back({.y = {.label = "narrow"}, .marks = {cosine()}});
  FontBook fonts;
  const FigurePlan plan = plan_of(figure, fonts);
  EXPECT_EQ(plan.panels[0].plot.left, plan.panels[1].plot.left);
  EXPECT_EQ(plan.panels[0].plot.right, plan.panels[1].plot.right);
  EXPECT_FALSE(plan.panels[0].shows_x_labels);
  EXPECT_TRUE(plan.panels[1].shows_x_labels);
  EXPECT_LT(plan.panels[0].plot.bottom, plan.panels[1].plot.top);
}

TEST(Layout, SharedAxesSpanTheDataOfAllTheirPanels) {
  Figure figure{.columns = 1, .share_x = true};
  figure.panels.push_back({.marks = {Line{.x = {0, 1}, .y = {0, 1}}}});
  figure.panels.push_back({.marks = {Line{.x = {5, 9}, .y = {0, 1}}}});
  FontBook fonts;
  const FigurePlan plan = plan_of(figure, fonts);
  for (const PanelPlan& p : plan.panels) {
    EXPECT_EQ(p.x.low, 0);
    EXPECT_EQ(p.x.high, 9);
  }
}

TEST(Layout, ManyCategoriesAreThinnedOutAndFewAreShortened) {
  const auto labels_of = [](std::size_t n, const std::string& name) {
    Figure figure{.width_mm = 100, .height_mm = 60};
    figure.panels.push_back({.marks = {cosine()}});
    figure.panels[0].x.categories.assign(n, name);
    FontBook fonts;
    const FigurePlan plan = plan_of(figure, fonts);
    std::vector<std::string> labels;
    for (const Tick& tick : plan.panels[0].x_ticks.major) labels.push_back(tick.label);
    return labels;
  };
  const std::vector<std::string> many = labels_of(60, "12.5");
  EXPECT_EQ(many.size(), 60U) << "every category keeps its tick";
  std::size_t named = 0;
  for (const std::string& label : many) {
    EXPECT_TRUE(label.empty() || label == "12.5") << label;
    named += !label.empty();
  }
  EXPECT_GT(named, 5U);
  EXPECT_LT(named, 31U);
  for (const std::string& label : labels_of(4, std::string(80, 'W')))
    EXPECT_NE(label.find("\u2026"), std::string::npos);
}

TEST(Layout, GroupsAreNamedInTheirMiddleAndPartedByRules) {
  Figure figure{.width_mm = 100, .height_mm = 60};
  figure.panels.push_back({.x = {.groups = {{"2", 1}, {"4", 4}, {"6", 2}}}, .marks = {cosine()}});
  FontBook fonts;
  const PanelPlan p = plan_of(figure, fonts).panels[0];
  EXPECT_EQ(p.x.low, -0.5);
  EXPECT_EQ(p.x.high, 6.5);
  ASSERT_EQ(p.x_ticks.major.size(), 3U);
  const std::vector<std::pair<double, std::string>> expected = {{0, "2"}, {2.5, "4"}, {5.5, "6"}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(p.x_ticks.major[i].value, expected[i].first);
    EXPECT_EQ(p.x_ticks.major[i].label, expected[i].second);
  }
  EXPECT_EQ(p.x_ticks.parting, (std::vector<double>{0.5, 4.5}));
}

TEST(Layout, BarsStandOnTheAxisAndCrestsAtZeroDoNotTouchIt) {
  const auto high_of = [](const Mark& mark) {
    Figure figure;
    figure.panels.push_back({.marks = {mark}});
    FontBook fonts;
    return plan_of(figure, fonts).panels[0].y.high;
  };
  EXPECT_EQ(high_of(Bars{.at = {0, 1}, .value = {-1, -2}}), 0);
  EXPECT_GT(high_of(Line{.x = {0, 1, 2}, .y = {-1, 0, -1}}), 0);
}

TEST(Layout, RowsTakeTheirShareOfTheHeight) {
  Figure figure{.columns = 1, .row_heights = {3, 1}};
  figure.panels = {{.marks = {cosine()}}, {.marks = {cosine()}}};
  FontBook fonts;
  const FigurePlan plan = plan_of(figure, fonts);
  EXPECT_NEAR(plan.panels[0].plot.height() / plan.panels[1].plot.height(), 3, 0.05);
}

TEST(Layout, TitlesStandRightAboveTheirPlotOrItsLegend) {
  Figure figure{.columns = 2};
  Panel many{.title = "many", .legend = Legend::kAbove}, one{.title = "one", .marks = {Line{.x = {0, 1}, .y = {0, 1}}}};
  for (int i = 0; i < 12; ++i)
    many.marks.emplace_back(Line{.x = {0, 1}, .y = {0, 1}, .name = "a long name of series " + std::to_string(i)});
  figure.panels = {many, one};
  FontBook fonts;
  const FigurePlan plan = plan_of(figure, fonts);
  EXPECT_GT(plan.panels[0].legend.box.height(), 30);
  EXPECT_LT(std::abs(plan.panels[0].legend.box.top - plan.panels[0].title_bottom), 10);
  EXPECT_LT(std::abs(plan.panels[1].plot.top - plan.panels[1].title_bottom), 10);
}

TEST(Layout, OneColourBarIsAsHighAsTheMapsItServes) {
  Figure figure{.columns = 2};
  for (int i = 0; i < 3; ++i)
    figure.panels.push_back(
        {.marks = {HeatMap{.x_edges = {0, 1}, .y_edges = {0, 1}, .values = {1}, .color_bar = i == 1}}});
  FontBook fonts;
  const FigurePlan plan = plan_of(figure, fonts);
  EXPECT_EQ(plan.panels[1].bar_bottom, plan.panels[2].plot.bottom);
}

TEST(Layout, EqualScalesMakeACircleRound) {
  Figure figure{.width_mm = 150, .height_mm = 60};
  figure.panels.push_back({.marks = {Line{.x = {-1, 1}, .y = {-1, 1}}}, .equal_scales = true});
  FontBook fonts;
  const PanelPlan p = plan_of(figure, fonts).panels[0];
  EXPECT_NEAR((p.x(1) - p.x(0)) / (p.y(0) - p.y(1)), 1, 1e-3);
}

TEST(Legend, HidesNoDataAndStaysInThePanel) {
  for (const double quiet_x : {1.0, 9.0}) {
    Panel panel;
    Line line{.name = "a series"};
    for (int i = 0; i <= 1000; ++i) {  // fills the panel but for one end
      line.x.push_back(i * 0.01);
      line.y.push_back(std::abs(line.x.back() - quiet_x) < 2.5 ? 0 : std::sin(40 * line.x.back()));
    }
    panel.marks = {line};
    Figure figure{.width_mm = 174, .height_mm = 80};
    figure.panels = {panel};
    FontBook fonts;
    const FigurePlan plan = plan_of(figure, fonts);
    const PanelPlan& p = plan.panels[0];
    ASSERT_FALSE(p.legend.outside);
    EXPECT_GE(p.legend.box.left, p.plot.left);
    EXPECT_LE(p.legend.box.right, p.plot.right);
    Occupancy data(p.plot, 2, fonts);
    draw_mark(p.panel.marks[0], {}, view_of(p, plan, data, fonts, Theme::kPrint));
    EXPECT_EQ(data.taken(p.legend.box), 0);
  }
}

TEST(Legend, GoesAboveWhereDataFillThePanel) {
  Line line{.name = "everywhere"};
  for (int i = 0; i <= 4000; ++i) {
    line.x.push_back(i);
    line.y.push_back(i % 2 == 0 ? -1 : 1);
  }
  Figure figure;
  figure.panels.push_back({.marks = {line}});
  FontBook fonts;
  const PanelPlan p = plan_of(figure, fonts).panels[0];
  EXPECT_TRUE(p.legend.outside);
  EXPECT_LE(p.legend.box.bottom, p.plot.top);
}

TEST(Legend, NamesEverySeriesOnce) {
  Figure figure;
  figure.panels.push_back(
      {.marks = {Band{.x = {0, 1}, .low = {0, 0}, .high = {1, 1}, .name = "m"},
                 Line{.x = {0, 1}, .y = {0, 1}, .name = "m"}, Line{.x = {}, .y = {}, .name = "empty"},
                 Line{.x = {0, 1}, .y = {1, 0}}}});
  FontBook fonts;
  const PanelPlan p = plan_of(figure, fonts).panels[0];
  ASSERT_EQ(p.legend.entries.size(), 1U);
  EXPECT_EQ(p.legend.entries[0].marks, (std::vector<std::size_t>{0, 1}));
}

TEST(Text, IsShortenedWholeCharactersAtATime) {
  FontBook fonts;
  fonts.require(20, false);
  fonts.require("파고 측정");
  fonts.bake();
  const float whole = fonts.width_px("파고 측정", 20);
  for (float most = 0; most < whole; most += 3) {
    const std::string text = fitted("파고 측정", most, fonts, 20);
    for_each_character(text, [](ImWchar c) { EXPECT_NE(c, 0xFFFD); });
  }
  EXPECT_EQ(fitted("파고 측정", whole + 1, fonts, 20), "파고 측정");
}

TEST(Text, BreaksAtSpacesIntoLinesThatFit) {
  FontBook fonts;
  fonts.require(10, false);
  fonts.bake();
  for (const std::string& line : wrapped("the quick brown fox jumps over the lazy dog", 80, 5, fonts, 10))
    EXPECT_LE(fonts.width_px(line, 10), 80);
  EXPECT_EQ(wrapped("one\ntwo", 1000, 3, fonts, 10), (std::vector<std::string>{"one", "two"}));
}

TEST(AxisText, KeepsItsUnitWhereTheLabelIsTooLong) {
  FontBook fonts;
  fonts.require(10, false);
  fonts.bake();
  const std::string text =
      axis_text_fitted({.label = "A very long label of an axis", .unit = "m/s"}, {}, 120, fonts, 10);
  EXPECT_TRUE(text.ends_with("(m/s)")) << text;
  EXPECT_LE(fonts.width_px(text, 10), 122);
}

// What differs in the names of a family stands at their ends, and every one keeps its place in the legend.
TEST(Legend, NamesThatAreTooLongStayApart) {
  Figure figure{.width_mm = 60, .height_mm = 60};
  Panel panel{.legend = Legend::kAbove};
  for (const char* name : {"my_own_estimator_with_a_long_name_v1", "my_own_estimator_with_a_long_name_v2"})
    panel.marks.emplace_back(Line{.x = {0, 1}, .y = {0, 1}, .name = name});
  figure.panels = {panel};
  FontBook fonts;
  const std::vector<LegendEntry> entries = plan_of(figure, fonts).panels[0].legend.entries;
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_TRUE(entries[0].name.starts_with("my_own") && entries[0].name.ends_with("v1")) << entries[0].name;
  EXPECT_TRUE(entries[1].name.ends_with("v2")) << entries[1].name;
  EXPECT_NE(entries[0].name.find("\u2026"), std::string::npos);
}

TEST(Layout, ALongNameOfAnAxisReachesBesideTitleAndTicks) {
  Figure figure{.width_mm = 80, .height_mm = 48};
  Panel panel{.title = "title",
              .x = {.label = "x"},
              .y = {.label = "Standard deviation", .unit = "cm"},
              .legend = Legend::kAbove};
  panel.marks.emplace_back(cosine());
  figure.panels = {panel};
  Canvas canvas;
  EXPECT_NE(svg_text(figure, canvas.fonts(), {}).find(">Standard deviation (cm)<"), std::string::npos);
}

TEST(Layout, ABrokenLabelTakesTheRoomOfItsLongestLine) {
  constexpr double kMidnight = 1120176000, kDay = 86400;  // 2005-07-01 00:00 UTC
  const auto plan_from = [](double begin, double end) {
    Figure figure;
    figure.panels = {{.x = {.scale = Scale::kTime, .padding = 0}, .marks = {Line{.x = {begin, end}, .y = {0, 1}}}}};
    FontBook fonts;
    return plan_of(figure, fonts).panels[0];
  };
  const PanelPlan one_day = plan_from(kMidnight, kMidnight + kDay),
                  longer = plan_from(kMidnight + kDay / 2, kMidnight + 2 * kDay + 1);
  EXPECT_EQ(one_day.x_ticks.major.back().label, "00:00");
  EXPECT_EQ(longer.x_ticks.major.back().label, "00:00\n07-03");
  EXPECT_NEAR(longer.margins.right, one_day.margins.right, 3);
}

}  // namespace
}  // namespace waverig::render
