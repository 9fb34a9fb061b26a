#include "rig/campaign/sea_bound.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/kinematics/frames.h"
#include "rig/campaign/run.h"
#include "rig/campaign/sweep.h"

namespace waverig::rig {
namespace {

constexpr double kNoise = 350e-6 * kStandardGravity;

// Half the peak's frequency to five times it: 0.2 % of the variance lie outside.
TEST(SeaBound, IsOfTheSeaAsItIsDrawn) {
  for (const double tp_s : {3.0, 8.0, 12.0}) {
    const motion::SeaSettings sea{.hm0_m = 0.6, .tp_s = tp_s, .exact_hm0 = false};
    const double drawn_m = std::sqrt(motion::moments_of(motion::draw_components(sea)).m0),
                 std_m = sea_bound(sea, {.noise_density_mps2 = kNoise}).heave_std_m();
    EXPECT_NEAR(std_m / drawn_m, 1, 1e-3) << tp_s;
    EXPECT_LT(std_m, sea.hm0_m / 4) << tp_s;
  }
}

TEST(SeaBound, OnlyRealTimeHasALag) {
  EXPECT_EQ(heave_lag_s("realtime", 0), 0);
  EXPECT_EQ(heave_lag_s("realtime", 2), 2);
  for (const char* name : {"smoothed", "spectral", "someone-elses"})
    EXPECT_EQ(heave_lag_s(name, 2), evaluation::kWholeRecord_s) << name;
}

// With exact sensors nothing would be left but quantisation; with data-sheet ones nobody gets below the
// bound, and a record's smoothed heave is not far above it.
TEST(SeaBound, StandsBelowWhatTheMethodsReach) {
  const CampaignSettings campaign =
      read_campaign(
          TomlFile("name = \"sea\"\nseed = 3\nmethods = [\"realtime\", \"smoothed\"]\n[sweep]\n"
                   "motion = \"jonswap\"\nperiods_s = [8.0]\nheights_cm = [100.0]\nduration_s = 600.0\n"
                   "repeats = 1\n",
                   "c.toml"))
          .settings;
  const CalibratedUnit calibrated = calibrate(campaign);
  const std::vector<evaluation::RunResult> runs =
      run_embedded(campaign, calibrated.unit, plan_campaign(campaign).runs.front(), {});
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_GT(runs[0].heave_rmse_m, 0.9 * runs[0].heave_bound_m);  // realtime; one record scatters
  EXPECT_GT(runs[1].heave_rmse_m, 0.9 * runs[1].heave_bound_m);
  EXPECT_LT(runs[1].heave_rmse_m, 2 * runs[1].heave_bound_m);
  EXPECT_GT(runs[0].heave_bound_m, 4 * runs[1].heave_bound_m);
}

}  // namespace
}  // namespace waverig::rig
