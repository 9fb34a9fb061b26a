#include "rig/campaign/settings.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "lcmtypes/error.h"

namespace waverig::rig {
namespace {

constexpr const char* kMinimal = "name = \"t\"\n[sweep]\nperiods_s = [6.0]\nheights_cm = [60.0]\n";

std::string complaint(const std::string& text) {
  try {
    read_campaign(TomlFile(text, "c.toml"));
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(CampaignSettings, DefaultCampaignIsTableTwo) {
  const CampaignSettings s = read_campaign(std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig/default.toml").settings;
  ASSERT_EQ(s.sweep.settings.size(), 6u);
  EXPECT_EQ(s.sweep.settings.front().period_s, 6);
  EXPECT_DOUBLE_EQ(s.sweep.settings.front().height_m, 0.6);
  EXPECT_EQ(s.sweep.settings.back().period_s, 12);
  EXPECT_DOUBLE_EQ(s.sweep.settings.back().height_m, 1.0);
  EXPECT_EQ(s.sweep.repeats, 3);
  EXPECT_EQ(s.sweep.profile.steady_s, 300);
}

TEST(CampaignSettings, ResolvedTextReadsBackToItself) {
  const std::string resolved = read_campaign(TomlFile(kMinimal, "c.toml")).resolved;
  EXPECT_EQ(read_campaign(TomlFile(resolved, "r.toml")).resolved, resolved);
}

TEST(CampaignSettings, SeedOfTheCommandLineStandsInTheResolvedText) {
  const std::uint64_t seed = 77;
  const Campaign campaign = read_campaign(TomlFile(kMinimal, "c.toml"), &seed);
  EXPECT_EQ(campaign.settings.seed, seed);
  EXPECT_EQ(read_campaign(TomlFile(campaign.resolved, "r.toml")).settings.seed, seed);
}

TEST(CampaignSettings, ComplaintsNameFileLineKeyValueAndWhatWasExpected) {
  EXPECT_EQ(complaint(""), "c.toml:1: name is missing: expected a text in quotes");
  EXPECT_EQ(complaint("name = \"t\"\n[sweep]\nperiods_s = [6.0]\nheights_m = [0.6]\n"),
            "c.toml:2: sweep.heights_cm is missing (line 4 has heights_m): expected a list with at least one number, each a number from 0.1 to 2000");
  EXPECT_EQ(complaint(std::string(kMinimal) + "repeats = 0\n"),
            "c.toml:5: sweep.repeats = 0: expected a whole number from 1 to 10000");
  EXPECT_EQ(complaint(std::string(kMinimal) + "min_waves = -1\n"),
            "c.toml:5: sweep.min_waves = -1: expected a whole number from 0 to 10000");
  EXPECT_EQ(complaint(std::string(kMinimal) + "speed = 1\n").substr(0, 43), "c.toml:5: sweep.speed = 1: unknown key; exp");
  EXPECT_TRUE(complaint(std::string("methods = [\"magic\"]\n") + kMinimal)
                  .starts_with("c.toml:1: methods = [ 'magic' ]: expected names among \"lee2014\", "));
}

}  // namespace
}  // namespace waverig::rig
