#include "rig/cli/estimator_bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "rig/campaign/settings.h"
#include "rig/campaign/sweep.h"

namespace waverig::cli {
namespace {

TEST(EstimatorBench, JudgesTheWavesAloneWhereATraceIsNotMeantToBeHeave) {
  const rig::CampaignUnit unit = rig::calibrate(rig::read_campaign("").settings).unit;
  const BenchRecord record = bench_record(
      {.motion = BenchMotion::kRegular, .period_s = 4, .height_m = 0.6, .duration_s = 400}, unit, 1);
  const BenchFigures waves = judge_method({.name = "lee2014", .tells_heave = false}, record, unit),
                     all = judge_method({.name = "lee2014"}, record, unit),
                     heave = judge_method({.name = "realtime"}, record, unit);
  EXPECT_GT(all.rms, 100) << "eq. (10), drift and all";
  for (const double figure : {waves.rms, waves.settled_rms, waves.gain, waves.lag_s, waves.hm0_error})
    EXPECT_TRUE(std::isnan(figure)) << figure;
  EXPECT_TRUE(waves.transfer.empty());
  EXPECT_LT(std::abs(waves.mean_height_error), 10);
  EXPECT_LT(heave.settled_rms, 1);
  EXPECT_TRUE(std::isnan(pooled({waves, waves}).rms));
}

}  // namespace
}  // namespace waverig::cli
