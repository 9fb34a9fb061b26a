// Whole figures: what is drawn, that it is the same everywhere, and what becomes of bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "render/figure_writer.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInf = std::numeric_limits<double>::infinity();

Figure one_panel(std::vector<Mark> marks) {
  Figure figure{.title = "A title", .width_mm = 80, .height_mm = 60};
  figure.panels.push_back({.title = "(a)",
                           .x = {.label = "Time", .unit = "s"},
                           .y = {.label = "Heave", .unit = "m"},
                           .marks = std::move(marks)});
  return figure;
}

Line sine(std::size_t n) {
  Line line{.name = "sine"};
  for (std::size_t i = 0; i < n; ++i) {
    line.x.push_back(static_cast<double>(i) * 60.0 / static_cast<double>(n));
    line.y.push_back(std::sin(line.x.back()));
  }
  return line;
}

std::size_t blue_pixels(const Image& image) {
  return test::count_near(image, palette(Theme::kPrint, 0), 0.08F);
}

TEST(Figure, DrawsALineInItsColour) {
  Canvas canvas;
  const Image with = draw(one_panel({sine(500)}), canvas);
  const Image without = draw(one_panel({}), canvas);
  EXPECT_GT(blue_pixels(with), 1000U);
  EXPECT_EQ(blue_pixels(without), 0U);
}

TEST(Figure, SpikeOfOneSampleInAMillionIsAsHighAsItIs) {
  Line line = sine(1'000'000);
  line.name = "";
  line.y[500'000] = 10;
  Figure figure = one_panel({line});
  figure.panels[0].y.low = -2;
  figure.panels[0].y.high = 12;
  Canvas canvas;
  const Image image = draw(figure, canvas);
  // Topmost coloured row: the spike. The axis spans 14; the sine's crest at 1 lies far below.
  int top = image.height_px, bottom = 0;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const Color p = test::pixel(image, x, y), blue = palette(Theme::kPrint, 0);
      if (std::abs(p.r - blue.r) + std::abs(p.g - blue.g) + std::abs(p.b - blue.b) > 0.2F) continue;
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  EXPECT_NEAR(static_cast<double>(bottom - top) / image.height_px, 11.0 / 14 * 0.62, 0.12);
}

TEST(Figure, IsBitIdenticalForAnyNumberOfThreadsAndAnyHistory) {
  const Figure figure = one_panel({sine(3000), Points{.x = {1, 2, 3}, .y = {0, 1, 0.5}, .name = "points"}});
  Figure other = one_panel({sine(100)});
  other.title = "Other characters: \u03B6\u03BE 파고";
  other.dots_per_inch = 157;
  std::vector<Image> images(6);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < images.size(); ++i) {
    threads.emplace_back([&, i] {
      Canvas canvas;
      for (std::size_t k = 0; k < i; ++k) draw(other, canvas);
      images[i] = draw(figure, canvas);
    });
  }
  for (std::thread& t : threads) t.join();
  for (const Image& image : images) EXPECT_EQ(image.rgba, images[0].rgba);
}

TEST(Figure, DrawsSomethingSensibleForBadInput) {
  const std::vector<std::vector<Mark>> all = {
      {Line{}},
      {Line{.x = {1, 2, 3}, .y = {kNaN, kNaN, kNaN}}},
      {Line{.x = {1, 2, 3}, .y = {1, kInf, 2}}},
      {Line{.x = {1, 2, 3, 4}, .y = {1, 2}}},
      {Line{.x = {5}, .y = {5}}},
      {Line{.x = {1, 1, 1}, .y = {2, 2, 2}}},
      {Line{.x = {0, 1}, .y = {-1e308, 1e308}}},
      {Line{.x = {0, 1}, .y = {1e-320, 2e-320}}},
      {Points{.x = {kNaN, 1}, .y = {1, 1}}},
      {Bars{.at = {0, 1}, .value = {kNaN, 0}}},
      {ErrorBars{.x = {1}, .y = {1}, .minus = {kNaN}, .plus = {1}}},
      {Band{.x = {0, 1, 2}, .low = {0, kNaN, 0}, .high = {1, 1, 1}}},
      {Histogram{}},
      {Histogram{.values = {2, 2, 2, 2}}},
      {Histogram{.values = {0, 1e300, kNaN}}},
      {HeatMap{}},
      {HeatMap{.x_edges = {0, 1, 2}, .y_edges = {0, 1}, .values = {1}}},
      {HeatMap{.x_edges = {0, 1}, .y_edges = {0, 1}, .values = {5}, .label = "x"}},
      {Note{.text = ""}},
      {Rule{.at = kNaN}},
      {Span{.from = kNaN, .to = 1}}};
  Canvas canvas;
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const Scale scale : {Scale::kLinear, Scale::kLog, Scale::kTime}) {
      Figure figure = one_panel(all[i]);
      figure.panels[0].x.scale = scale;
      if (scale != Scale::kTime) figure.panels[0].y.scale = scale;
      const Image image = draw(figure, canvas);
      EXPECT_GT(test::count_near(image, rgb(0x1A1A1A), 0.1F), 100U) << "no axes for input " << i;
      figure.panels[0].polar = true;
      EXPECT_NO_THROW(draw(figure, canvas)) << i;
    }
  }
}

TEST(Figure, SaysWhereThereIsNoData) {
  Canvas canvas;
  EXPECT_NE(svg_text(one_panel({Line{.x = {1}, .y = {kNaN}, .name = "nothing"}}), canvas.fonts(), {})
                .find(">no data<"),
            std::string::npos);
  EXPECT_EQ(svg_text(one_panel({sine(10)}), canvas.fonts(), {}).find(">no data<"), std::string::npos);
}

TEST(Figure, PutsReversedEqualAndImpossibleLimitsRight) {
  Canvas canvas;
  for (const auto& [low, high] :
       {std::pair(5.0, -5.0), std::pair(3.0, 3.0), std::pair(0.0, 0.0), std::pair(-kInf, kInf)}) {
    Figure figure = one_panel({sine(100)});
    figure.panels[0].y.low = figure.panels[0].x.low = low;
    figure.panels[0].y.high = figure.panels[0].x.high = high;
    EXPECT_NO_THROW(draw(figure, canvas));
  }
  Figure log = one_panel({sine(100)});
  log.panels[0].y.scale = Scale::kLog;
  log.panels[0].y.low = -4;
  EXPECT_NO_THROW(draw(log, canvas));
}

TEST(Figure, FitsVeryLongTextIntoThePage) {
  const std::string endless(5000, 'W');
  Figure figure = one_panel({sine(100)});
  figure.title = figure.subtitle = figure.panels[0].title = figure.panels[0].x.label =
      figure.panels[0].y.label = endless;
  std::get<Line>(figure.panels[0].marks[0]).name = endless;
  figure.panels[0].marks.emplace_back(Note{.text = endless});
  Canvas canvas;
  const Image image = draw(figure, canvas);
  for (int y = 0; y < image.height_px; ++y)
    EXPECT_EQ(test::pixel(image, image.width_px - 1, y), rgb(0xFFFFFF))
        << "text runs over the edge in row " << y;
  EXPECT_GT(blue_pixels(image), 100U) << "the plot vanished";
}

// Every cell of a map shows its number or none does; on logarithmic colours with the digits that count.
TEST(Figure, WritesNumbersIntoAllCellsOfAMapOrNone) {
  HeatMap map{.x_edges = {0, 1, 2, 3}, .y_edges = {0, 1}, .values = {0.256, 21.4, 1.62}, .decimals = 2};
  Canvas canvas;
  const auto svg = [&](double width_mm) {
    Figure figure = one_panel({map});
    figure.width_mm = width_mm;
    return svg_text(figure, canvas.fonts(), {});
  };
  EXPECT_NE(svg(80).find(">21.40<"), std::string::npos);
  map.log_colors = true;
  for (const char* text : {">0.26<", ">21<", ">1.6<"})
    EXPECT_NE(svg(80).find(text), std::string::npos) << text;
  for (const char* text : {">0.26<", ">21<", ">1.6<"})
    EXPECT_EQ(svg(30).find(text), std::string::npos) << text;
}

TEST(Figure, DrawsManyPanelsInLittleRoom) {
  Figure figure{.columns = 6, .width_mm = 40, .height_mm = 30};
  for (int i = 0; i < 36; ++i)
    figure.panels.push_back(
        {.title = "panel", .x = {.label = "x"}, .y = {.label = "y"}, .marks = {sine(50)}});
  Canvas canvas;
  EXPECT_NO_THROW(draw(figure, canvas));
}

TEST(Figure, RefusesASizeThatMakesNoPicture) {
  Canvas canvas;
  for (const double width_mm : {0.0, -5.0, 1e9, kNaN}) {
    Figure figure = one_panel({});
    figure.width_mm = width_mm;
    EXPECT_THROW(draw(figure, canvas), UserError) << width_mm;
  }
}

TEST(Figure, ShowsMalformedUtf8AsReplacement) {
  Figure figure = one_panel({sine(10)});
  figure.title = std::string("bad \xC3\x28 \xFF\xFE ") + std::string("\0inside", 7) + " \xF0\x9F\x8C\x8A end";
  Canvas canvas;
  EXPECT_NO_THROW(draw(figure, canvas));
}

TEST(Svg, HoldsTheSameTextAndNoForeignMarkup) {
  Figure figure = one_panel({sine(100)});
  figure.title = "a < b & \"c\" 파고";
  Canvas canvas;
  const std::string svg = svg_text(figure, canvas.fonts(), {"1.0", "cmd", "5"});
  EXPECT_NE(svg.find("a &lt; b &amp; &quot;c&quot; 파고"), std::string::npos);
  EXPECT_NE(svg.find(">Heave (m)<"), std::string::npos);
  EXPECT_NE(svg.find("width=\"80.00mm\""), std::string::npos);
  EXPECT_NE(svg.find("seed 5"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("<g "), count("</g>"));
}

}  // namespace
}  // namespace waverig::render
