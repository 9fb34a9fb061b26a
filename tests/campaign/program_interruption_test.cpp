// The program ended in the midst of its work: what it says, and that nothing whole is lost.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <string>

#include "tests/campaign/program.h"

namespace waverig {
namespace {

TEST(Program, NamesResumeWhereASweepIsInterrupted) {
  const TemporaryDirectory temporary;
  temporary.write("long.toml",
                  "name = \"long\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 20000.0\n");
  const Outcome outcome =
      ended_early(temporary, "sweep long.toml --jobs 2 --out out", "out.partial/calibration.json");
  EXPECT_EQ(outcome.status, 128 + SIGTERM);
  EXPECT_EQ(outcome.err,
            "waverig: interrupted; out.partial keeps the runs that are done, --resume goes on with them\n");
}

TEST(Program, LeavesNothingHalfWhereAnEstimateIsInterrupted) {
  const TemporaryDirectory temporary;
  std::ofstream record(temporary / "long.csv");
  record << "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 1000000; ++row) record << row << "0000,0,0,-9.8,0,0,0\n";
  record.close();
  for (const auto& [name, number] : {std::pair{"TERM", SIGTERM}, {"HUP", SIGHUP}}) {
    const Outcome outcome =
        ended_early(temporary, "estimate long.csv --method realtime --out out", "out/heave.csv.*", name);
    EXPECT_EQ(outcome.status, 128 + number) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(temporary / "out")) << name;
  }
}

TEST(Program, KeepsAnEarlierFilmWhereTheNextIsInterrupted) {
  const TemporaryDirectory temporary;
  temporary.write(
      "long.toml",
      "name = \"long\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 600.0\nrepeats = 1\n");
  ASSERT_EQ(run(temporary, "sweep long.toml --out done").status, 0);
  temporary.write("rig.mp4", "the film before");
  const Outcome outcome = ended_early(
      temporary, "film done/runs/T04.00s_H050.0cm_r1.lcm --seconds 600 --out rig.mp4", "rig.mp4.*.partial");
  EXPECT_EQ(outcome.status, 128 + SIGTERM) << outcome.err;
  EXPECT_EQ(bytes_of(temporary / "rig.mp4"), "the film before");
  for (const auto& file : std::filesystem::directory_iterator(temporary.path()))
    EXPECT_NE(file.path().extension(), ".partial") << file.path();
}

TEST(Program, AnUnfinishedAnalysisIsNotToldToResume) {
  const TemporaryDirectory temporary;
  std::filesystem::create_directories(temporary / "out.partial/runs");
  const Outcome refused = run(temporary, "analyse compass --runs 2 --out out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("out.partial is unfinished; expected --replace"), std::string::npos)
      << refused.err;
  EXPECT_EQ(run(temporary, "analyse compass --runs 2 --out out --replace").status, 0);
  temporary.write("c.toml", kTiny);
  std::filesystem::create_directories(temporary / "swept.partial");
  temporary.write("swept.partial/campaign.toml", "");
  const Outcome campaign = run(temporary, "sweep c.toml --out swept");
  EXPECT_NE(campaign.err.find("expected --resume to go on or --replace"), std::string::npos) << campaign.err;
}

constexpr const char* kTwoSettings =
    "name = \"shards\"\n[sweep]\nperiods_s = [4.0, 5.0]\nheights_cm = [50.0]\n"
    "duration_s = 30.0\nrepeats = 1\nramp_periods = 1\n";

TEST(Program, AnInterruptedMergeIsNoResultAndIsDoneAnew) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTwoSettings);
  for (const std::string number : {"1", "2"})
    ASSERT_EQ(run(temporary, "sweep c.toml --out part" + number + " --shard " + number + "/2").status, 0);
  const Outcome ended = ended_early(temporary, "merge part1 part2 --out all", "all*/results.csv");
  ASSERT_EQ(ended.status, 128 + SIGTERM) << ended.out << ended.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "all"));
  const Outcome told = run(temporary, "merge part1 part2 --out all");
  EXPECT_EQ(told.status, 2);
  EXPECT_NE(told.err.find("all.partial is unfinished; expected --replace to do it anew"), std::string::npos)
      << told.err;
  const Outcome anew = run(temporary, "merge part1 part2 --out all --replace");
  EXPECT_EQ(anew.status, 0) << anew.err;
  EXPECT_NE(anew.out.find("Report:  all/report.html"), std::string::npos) << anew.out;
  EXPECT_TRUE(std::filesystem::exists(temporary / "all/report.html"));
  EXPECT_FALSE(std::filesystem::exists(temporary / "all.partial"));
}

// What it holds while another program is at work in it says nothing yet.
TEST(Program, AMergeReadsNoShardThatAnotherProgramHolds) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTwoSettings);
  for (const std::string number : {"1", "2"})
    ASSERT_EQ(run(temporary, "sweep c.toml --out part" + number + " --shard " + number + "/2").status, 0);
  temporary.write("part2/results.json", "half of wh");
  const Outcome held = run(temporary, "--version >/dev/null; flock part2 " WAVERIG_PROGRAM " merge part1 part2 --out all");
  EXPECT_EQ(held.status, 2);
  EXPECT_EQ(held.err, "waverig: part2: another waverig is at work in it; expected a finished shard\n");
  const Outcome twice = run(temporary, "merge part1 ./part1 --out all");
  EXPECT_EQ(twice.status, 2);
  EXPECT_EQ(twice.err.find("at work"), std::string::npos) << twice.err;
}

TEST(Program, AMergeThatIsRefusedLeavesNothing) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTwoSettings);
  ASSERT_EQ(run(temporary, "sweep c.toml --out part1 --shard 1/2").status, 0);
  EXPECT_EQ(run(temporary, "merge part1 --out all").status, 2) << "too few";
  EXPECT_FALSE(std::filesystem::exists(temporary / "all.partial"));
  std::filesystem::rename(temporary / "part1", temporary / "all.partial");
  EXPECT_EQ(run(temporary, "merge all.partial --out all --replace").status, 2) << "too few";
  EXPECT_TRUE(std::filesystem::exists(temporary / "all.partial/results.json"));
}

}  // namespace
}  // namespace waverig
