// Reference pictures, decoded and compared with a tolerance: other CPU features change antialiased edges by
// up to 2/255 within one Mesa version, and another version may put an edge into the next pixel. To renew them
// after a wanted change: WAVERIG_RENEW_GOLDEN=1 render_test
// --gtest_filter='Golden*'
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "render/figure_writer.h"
#include "render/figures/accuracy.h"
#include "render/figures/direction.h"
#include "tests/render/example_campaign.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

constexpr int kEachPixel = 6;          // of 255, in any channel
constexpr double kShareBeyond = 2e-4;  // of the pixels may differ by more, even from their neighbourhood

// Whether a pixel lies between the darkest and the lightest of the 3 x 3 around it in `other`, channel by
// channel.
bool is_near(const Image& image, const Image& other, int x, int y) {
  const auto at = [](const Image& i, int column, int row, std::size_t c) {
    return static_cast<int>(i.rgba[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(i.width_px) +
                                        static_cast<std::size_t>(column)) +
                                   c]);
  };
  for (std::size_t c = 0; c < 3; ++c) {
    int least = 255, most = 0;
    for (int row = std::max(0, y - 1); row <= std::min(other.height_px - 1, y + 1); ++row) {
      for (int column = std::max(0, x - 1); column <= std::min(other.width_px - 1, x + 1); ++column) {
        least = std::min(least, at(other, column, row, c));
        most = std::max(most, at(other, column, row, c));
      }
    }
    const int value = at(image, x, y, c);
    if (value < least - kEachPixel || value > most + kEachPixel) return false;
  }
  return true;
}

void compare_with_golden(Figure figure, const std::string& name) {
  figure.dots_per_inch = 90;
  Canvas canvas;
  const std::vector<std::uint8_t> bytes = png_bytes(figure, canvas, {});
  const std::filesystem::path path = std::filesystem::path(WAVERIG_GOLDEN_DIR) / (name + ".png");
  if (std::getenv("WAVERIG_RENEW_GOLDEN") != nullptr) write_file(path, bytes.data(), bytes.size());
  const Image expected = test::decode_png(test::bytes_of(path)).image, found = test::decode_png(bytes).image;
  ASSERT_EQ(found.width_px, expected.width_px);
  ASSERT_EQ(found.height_px, expected.height_px);
  std::size_t beyond = 0;
  for (int y = 0; y < found.height_px; ++y) {
    for (int x = 0; x < found.width_px; ++x)
      beyond +=
          !is_near(found, expected, x, y) || !is_near(expected, found, x, y);  // nothing new, nothing lost
  }
  EXPECT_LE(static_cast<double>(beyond), kShareBeyond * static_cast<double>(found.rgba.size()) / 4) << name;
}

TEST(Golden, EveryKindOfMark) {
  Figure figure{
      .title = "Every kind of mark: \u03B1 \u03B2 \u03B3", .columns = 3, .width_mm = 180, .height_mm = 110};
  std::vector<double> x, y, low, high;
  for (int i = 1; i <= 40; ++i) {
    x.push_back(0.1 * std::pow(1.2, i));
    y.push_back(1e-3 / std::sqrt(x.back()) + 1e-5 * x.back());
    low.push_back(0.7 * y.back());
    high.push_back(1.4 * y.back());
  }
  figure.panels.push_back({.title = "Log",
                           .x = {.label = "\u03C4", .unit = "s", .scale = Scale::kLog},
                           .y = {.label = "\u03C3", .scale = Scale::kLog},
                           .marks = {Band{.x = x, .low = low, .high = high, .name = "band"},
                                     Line{.x = x, .y = y, .name = "line", .look = {.dash = Dash::kDashed}}}});
  figure.panels.push_back(
      {.title = "Bars",
       .x = {.categories = {"6 s", "12 s"}},
       .y = {.label = "Error", .unit = "%"},
       .marks = {
           Bars{.at = {0, 1}, .value = {2, 3}, .name = "bars"},
           ErrorBars{
               .x = {0, 1}, .y = {2, 3}, .minus = {0.5, 1}, .plus = {0.5, 1}, .look = {.color = kInk}}}});
  figure.panels.push_back({.title = "Map",
                           .marks = {HeatMap{.x_edges = {0, 1, 2},
                                             .y_edges = {0, 1, 2},
                                             .values = {1, 2, 3, 4},
                                             .label = "value",
                                             .decimals = 1}}});
  figure.panels.push_back({.title = "Points",
                           .marks = {Points{.x = {1, 2, 3},
                                            .y = {1, 3, 2},
                                            .name = "a",
                                            .look = {.marker = Marker::kDiamond, .marker_pt = 6}},
                                     Points{.x = {1, 2, 3},
                                            .y = {2, 1, 3},
                                            .name = "b",
                                            .look = {.marker = Marker::kTriangle, .marker_pt = 6}}}});
  figure.panels.push_back(rose_panel("Rose", {0.1, 0.2, 1.6, 3.0, 3.1, 4.5}, {0.5, 1.2, 0.8, 1.9, 0.3, 1.1}));
  figure.panels.push_back(
      {.title = "Dashes",
       .marks = {Span{.from = 0, .to = 1}, Rule{.at = 0.5, .label = "rule"},
                 Line{.x = {0, 1, 2, 3}, .y = {0, 1, 0, 1}, .look = {.dash = Dash::kDotted}},
                 Note{.x = 0.6, .y = 0.3, .text = "two\nlines", .boxed = true}}});
  compare_with_golden(figure, "marks");
  figure.theme = Theme::kDark;
  compare_with_golden(figure, "marks-dark");
}

TEST(Golden, ChartOfTable2) { compare_with_golden(table2_figure(test::example_campaign()), "table-2"); }

}  // namespace
}  // namespace waverig::render
