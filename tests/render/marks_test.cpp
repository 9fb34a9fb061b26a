#include "render/marks.h"

#include <gtest/gtest.h>

#include <numeric>

#include "motion/kinematics/random.h"

namespace waverig::render {
namespace {

TEST(Histogram, CountsEveryFiniteValueOnce) {
  RandomStream random(2, "histogram");
  Histogram histogram;
  for (int i = 0; i < 5000; ++i) histogram.values.push_back(random.gaussian());
  histogram.values.push_back(kAuto);
  const Bars bars = bars_of(histogram);
  EXPECT_EQ(std::accumulate(bars.value.begin(), bars.value.end(), 0.0), 5000);
  EXPECT_GT(bars.value.size(), 20U);
}

TEST(Histogram, DensityHasAreaOne) {
  const Bars bars = bars_of({.values = {1, 2, 2, 3, 3, 3, 7}, .bins = 6, .density = true});
  EXPECT_NEAR(std::accumulate(bars.value.begin(), bars.value.end(), 0.0) * bars.width, 1, 1e-12);
}

TEST(Extents, LeaveOutWhatALogarithmCannotShow) {
  const MarkExtents e = extents_of(Line{.x = {1, 10, 100}, .y = {-5, 0, 3}}, Scale::kLog, Scale::kLog);
  EXPECT_EQ(e.x.low, 100);
  EXPECT_EQ(e.y.low, 3);
  EXPECT_TRUE(e.has_data);
}

TEST(Extents, ErrorBarsCountToTheirEnds) {
  const MarkExtents e =
      extents_of(ErrorBars{.x = {1}, .y = {10}, .minus = {2}, .plus = {5}}, Scale::kLinear, Scale::kLinear);
  EXPECT_EQ(e.y.low, 8);
  EXPECT_EQ(e.y.high, 15);
}

TEST(ColorScale, DivergingIsSymmetricAboutZero) {
  const ColorScale scale = color_scale_of({.values = {-1, 4, kAuto}, .map = ColorMap::kDiverging});
  EXPECT_EQ(scale.mapping.low, -4);
  EXPECT_EQ(scale.mapping.high, 4);
  EXPECT_EQ(scale.at(0), color_of(ColorMap::kDiverging, 0.5));
}

TEST(ColorMaps, GrowLighterAllTheWay) {
  float before = -1;
  for (int i = 0; i <= 100; ++i) {
    const float now = luminance(color_of(ColorMap::kSequential, i / 100.0));
    EXPECT_GT(now, before);
    before = now;
  }
}

// Machado, Oliveira, Fernandes (2009), severity 1: what a reader without one kind of cone sees.
Color seen(Color c, const std::array<float, 9>& m) {
  return {m[0] * c.r + m[1] * c.g + m[2] * c.b, m[3] * c.r + m[4] * c.g + m[5] * c.b,
          m[6] * c.r + m[7] * c.g + m[8] * c.b, 1};
}

TEST(Palette, FirstFourColoursStayApartForColourBlindReaders) {
  const std::array<float, 9> protan = {0.152286F, 1.052583F,  -0.204868F, 0.114503F, 0.786281F,
                                       0.099216F, -0.003882F, -0.048116F, 1.051998F};
  const std::array<float, 9> deutan = {0.367322F, 0.860646F,  -0.227968F, 0.280085F, 0.672501F,
                                       0.047413F, -0.011820F, 0.042940F,  0.968881F};
  const std::array<float, 9> tritan = {1.255528F, -0.076749F, -0.178779F, -0.078411F, 0.930809F,
                                       0.147602F, 0.004733F,  0.691367F,  0.303900F};
  for (const Theme theme : {Theme::kPrint, Theme::kDark}) {
    for (const auto& eye : {protan, deutan, tritan}) {
      for (int i = 0; i < 4; ++i) {
        for (int k = 0; k < i; ++k) {
          const Color a = seen(palette(theme, i), eye), b = seen(palette(theme, k), eye);
          const float apart = std::hypot(a.r - b.r, a.g - b.g, a.b - b.b);
          EXPECT_GT(apart, 0.12F) << "colours " << k << " and " << i;
        }
      }
    }
  }
}

TEST(ColorScale, OneOutlierLeavesSmallErrorsTheirColours) {
  HeatMap map{.values = {-53, 2, 0.1}, .map = ColorMap::kDiverging};
  EXPECT_NEAR(color_scale_of(map).mapping.share(2), 0.519, 0.001);
  map.knee = 1;
  const Mapping scale = color_scale_of(map).mapping;
  EXPECT_NEAR(scale.share(0), 0.5, 1e-12);
  EXPECT_NEAR(scale.share(53), 1, 1e-12);
  EXPECT_GT(scale.share(2), 0.64);
}

}  // namespace
}  // namespace waverig::render
