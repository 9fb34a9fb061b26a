#include "rig/campaign/plan.h"

#include <gtest/gtest.h>

#include <set>

#include "lcmtypes/error.h"
#include "rig/campaign/run.h"

namespace waverig::rig {
namespace {

CampaignSettings campaign(const std::string& sweep) {
  return read_campaign(TomlFile("name = \"t\"\n[sweep]\n" + sweep, "c.toml")).settings;
}

TEST(Plan, EveryRunHasANameASeedAndATimeOfItsOwn) {
  const CampaignPlan plan = plan_campaign(campaign("periods_s = [6.0, 6.04, 12.0]\nheights_cm = [60.0, 60.4]\nrepeats = 4\n"));
  ASSERT_EQ(plan.runs.size(), 24u);
  std::set<std::string> names;
  std::set<std::uint64_t> seeds;
  std::int64_t end_utime = 0;
  for (const RunPlan& run : plan.runs) {
    names.insert(run.name);
    seeds.insert(run.seed);
    EXPECT_GE(run.start_utime, end_utime);
    end_utime = run.start_utime + static_cast<std::int64_t>(run.duration_s * 1e6);
  }
  EXPECT_EQ(names.size(), plan.runs.size());
  EXPECT_EQ(seeds.size(), plan.runs.size());
}

TEST(Plan, RunsLastUntilTheyHaveTheWavesAskedFor) {
  const CampaignSettings c = campaign(
      "periods_s = [2.0, 7.0, 20.0]\nheights_cm = [30.0]\nduration_s = 100.0\nmin_waves = 14\nramp_periods = 1\n"
      "rest_before_s = 5.0\nrest_after_s = 1.0\nrepeats = 2\n");
  const CampaignPlan plan = plan_campaign(c);
  ASSERT_EQ(plan.settings.size(), 3u);
  EXPECT_EQ(plan.settings[0].waves, 50);  // 100 s hold more
  EXPECT_EQ(plan.settings[1].waves, 15);  // 100 s, rounded up, do just so
  EXPECT_EQ(plan.settings[2].waves, 14);
  EXPECT_DOUBLE_EQ(plan.settings[2].duration_s, (14 + 2) * 20 + 6);
  EXPECT_EQ(plan.runs.back().duration_s, plan.settings[2].duration_s);
  for (const RunPlan& run : plan.runs) EXPECT_EQ(profile_of(c, run).duration_s(), run.duration_s);
  EXPECT_NE(described(c, plan).find("    20.0      30.0        2     14        326  runs\n"), std::string::npos)
      << described(c, plan);
}

TEST(Plan, RecordsOfASeaLastAsManyPeakPeriodsAsAskedFor) {
  const CampaignPlan plan = plan_campaign(
      campaign("motion = \"jonswap\"\nperiods_s = [4.0, 12.0]\nheights_cm = [50.0]\nduration_s = 600.0\nmin_waves = 100\n"));
  EXPECT_EQ(plan.settings[0].duration_s, 600);
  EXPECT_EQ(plan.settings[1].duration_s, 1200);
}

TEST(Plan, ShardsArePartsOfTheWholeWithTheSameSeeds) {
  const CampaignPlan plan = plan_campaign(campaign("periods_s = [5.0, 6.0, 7.0]\nheights_cm = [60.0, 80.0]\nrepeats = 2\n"));
  std::set<std::uint64_t> whole, parts;
  for (const RunPlan& run : plan.runs) whole.insert(run.seed);
  std::size_t runs = 0;
  for (int k = 1; k <= 4; ++k)
    for (const RunPlan& run : runs_of_shard(plan, {k, 4})) {
      parts.insert(run.seed);
      ++runs;
    }
  EXPECT_EQ(runs, plan.runs.size());
  EXPECT_EQ(parts, whole);
}

TEST(Plan, RefusesAHeightTheRigCannotMakeAndSaysWhy) {
  const CampaignSettings c = campaign("periods_s = [6.0]\nheights_cm = [60.0, 900.0]\n");
  try {
    refuse_impossible(c, plan_campaign(c));
    FAIL();
  } catch (const UserError& error) {
    const std::string what = error.what();
    EXPECT_TRUE(what.starts_with("c.toml:4: sweep.heights_cm = 900: 6 s, 9 m: beyond the rig: ")) << what;
    EXPECT_NE(what.find("expected"), std::string::npos);
  }
}

TEST(Plan, SkipsRefusedSettingsWhereTheCampaignSaysSo) {
  const CampaignSettings c =
      campaign("periods_s = [6.0]\nheights_cm = [60.0, 900.0]\nrepeats = 2\noutside_envelope = \"skip\"\n");
  const CampaignPlan plan = plan_campaign(c);
  EXPECT_NO_THROW(refuse_impossible(c, plan));
  EXPECT_EQ(plan.runs.size(), 2u);
}

TEST(Plan, RefusesAWaveThatClipsTheSensor) {
  const CampaignPlan plan = plan_campaign(campaign("periods_s = [1.0]\nheights_cm = [200.0]\n"));
  EXPECT_TRUE(plan.settings.front().refused);
}

}  // namespace
}  // namespace waverig::rig
