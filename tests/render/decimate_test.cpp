#include "render/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "motion/kinematics/random.h"

namespace waverig::render {
namespace {

TEST(Decimation, KeepsTheExtremesOfEveryPixelColumn) {
  RandomStream random(5, "decimate");
  std::vector<Vec2> points;
  for (int i = 0; i < 100000; ++i)
    points.push_back({static_cast<float>(i) * 0.01F, static_cast<float>(random.gaussian())});
  const std::vector<Vec2> kept = decimated(points);
  EXPECT_LE(kept.size(), 2 * 1001U);
  for (int column = 0; column < 1000; ++column) {
    const auto within = [&](const std::vector<Vec2>& all) {
      float low = 1e9F, high = -1e9F;
      for (const Vec2 p : all) {
        if (std::floor(p.x) != static_cast<float>(column)) continue;
        low = std::min(low, p.y);
        high = std::max(high, p.y);
      }
      return std::pair(low, high);
    };
    if (column % 97 != 0) continue;
    EXPECT_EQ(within(points), within(kept)) << column;
  }
}

TEST(Decimation, KeepsTheOrderAlongX) {
  std::vector<Vec2> points;
  for (int i = 0; i < 5000; ++i)
    points.push_back({static_cast<float>(i) * 0.1F, std::sin(static_cast<float>(i) * 0.7F)});
  const std::vector<Vec2> kept = decimated(points);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), [](Vec2 a, Vec2 b) { return a.x < b.x; }));
}

TEST(Decimation, LeavesSparseAndUnorderedSeriesAlone) {
  std::vector<Vec2> sparse, circle;
  for (int i = 0; i < 100; ++i) {
    sparse.push_back({static_cast<float>(i), 0});
    circle.push_back({std::cos(static_cast<float>(i)), std::sin(static_cast<float>(i))});
  }
  EXPECT_EQ(decimated(sparse).size(), sparse.size());
  EXPECT_EQ(decimated(circle).size(), circle.size());
}

TEST(Decimation, EndsForHugeCoordinates) {
  std::vector<Vec2> points(100, Vec2{3e9F, 1});
  EXPECT_LE(decimated(points).size(), points.size());
}

}  // namespace
}  // namespace waverig::render
