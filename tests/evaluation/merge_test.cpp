#include "estimator/evaluation/merge.h"

#include <gtest/gtest.h>

#include "estimator/evaluation/height_statistics.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/error.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

namespace fs = std::filesystem;

RunResult run(const std::string& name, double period_s, int repeat) {
  RunResult r;
  r.run = name;
  r.method = "m";
  r.repeat = repeat;
  r.period_s = period_s;
  r.height_m = 0.6;
  HeightAccumulator a;
  for (int i = 0; i < 4; ++i) {
    JudgedWave w;
    w.wave.height_m = 0.6 + 0.001 * (i + repeat);
    w.wave.period_s = period_s;
    w.true_height_m = 0.6;
    r.waves.push_back(w);
    a.add(w);
  }
  r.statistics = a.statistics(0.6, 0.001);
  return r;
}

class Merge : public ::testing::Test {
 protected:
  fs::path shard(const std::string& name, std::vector<RunResult> runs,
                 const std::string& settings = "seed = 1\n") {
    const fs::path directory = scratch.path() / name;
    fs::create_directories(directory / "runs");
    scratch.write(name + "/campaign.toml", settings);
    for (const RunResult& r : runs) scratch.write(name + "/runs/" + r.run + ".lcm", "log of " + r.run);
    CampaignResults results;
    results.name = "c";
    results.version = version;
    results.seed = seed;
    results.calibration_json = calibration_json;
    results.complete = complete;
    results.runs = std::move(runs);
    results.cells = cells_of(results.runs);
    write_results(directory, results);
    return directory;
  }

  std::string refusal(const std::vector<fs::path>& shards) {
    try {
      merge_into(scratch.path() / "out", shards, merged(shards, expected));
    } catch (const UserError& error) {
      EXPECT_FALSE(fs::exists(scratch.path() / "out" / "results.json"));
      return error.what();
    }
    return "not refused";
  }

  Scratch scratch;
  std::string version = "1", calibration_json;
  std::uint64_t seed = 1;
  bool complete = true;
  std::vector<std::string> expected;
};

TEST_F(Merge, GivesWhatOneMachineWouldHaveGiven) {
  const auto whole = shard("whole", {run("a", 6, 0), run("b", 6, 1), run("c", 12, 0)});
  const auto one = shard("one", {run("c", 12, 0), run("a", 6, 0)}), two = shard("two", {run("b", 6, 1)});
  const std::vector shards{two, one};
  merge_into(scratch.path() / "out", shards, merged(shards, std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(Scratch::read(scratch.path() / "out" / "results.csv"), Scratch::read(whole / "results.csv"));
  EXPECT_EQ(read_results(scratch.path() / "out").runs.size(), 3u);
  for (const char* log : {"a", "b", "c"})
    EXPECT_EQ(Scratch::read(scratch.path() / "out" / "runs" / (std::string(log) + ".lcm")),
              std::string("log of ") + log);
  EXPECT_EQ(Scratch::read(scratch.path() / "out" / "campaign.toml"), "seed = 1\n");
}

TEST_F(Merge, RefusesShardsOfAnotherCalibration) {
  calibration_json = "{}";
  const auto one = shard("one", {run("a", 6, 0)});
  calibration_json = "{\"unit\": 2}";
  const auto two = shard("two", {run("b", 6, 1)});
  const std::string said = refusal({one, two});
  EXPECT_NE(said.find("calibration differs"), std::string::npos) << said;
}

TEST_F(Merge, RefusesOtherSettingsNamingTheLine) {
  const auto one = shard("one", {run("a", 6, 0)}, "x = 1\ny = 2\n"),
             two = shard("two", {run("b", 6, 1)}, "x = 1\ny = 3\n");
  const std::string said = refusal({one, two});
  EXPECT_NE(said.find("line 2 differs ('y = 2' and 'y = 3')"), std::string::npos) << said;
}

TEST_F(Merge, RefusesAnotherSeedOrVersion) {
  const auto one = shard("one", {run("a", 6, 0)});
  seed = 2;
  const auto two = shard("two", {run("b", 6, 1)});
  EXPECT_NE(refusal({one, two}).find("seed differs (1 and 2)"), std::string::npos);
  seed = 1;
  version = "2";
  const auto three = shard("three", {run("b", 6, 1)});
  EXPECT_NE(refusal({one, three}).find("version differs"), std::string::npos);
}

TEST_F(Merge, RefusesARunThatTwoShardsHold) {
  const auto one = shard("one", {run("a", 6, 0)}), two = shard("two", {run("a", 6, 0)});
  const std::string said = refusal({one, two});
  EXPECT_NE(said.find("both hold run 'a'"), std::string::npos) << said;
  EXPECT_NE(said.find(one.string()), std::string::npos) << said;
  EXPECT_NE(said.find(two.string()), std::string::npos) << said;
}

TEST_F(Merge, RefusesAShardWithoutTheLogOfARunNamingIt) {
  const auto one = shard("one", {run("a", 6, 0)}), two = shard("two", {run("b", 6, 1)});
  fs::remove(two / "runs/b.lcm");
  const std::string said = refusal({one, two});
  EXPECT_NE(said.find((two / "runs/b.lcm").string()), std::string::npos) << said;
}

TEST_F(Merge, RefusesAShardWhoseFilesAreNotThoseOfItsResults) {
  calibration_json = "{\"unit\": 1}";
  const auto one = shard("one", {run("a", 6, 0)});
  const std::string file = (one / "calibration.json").string();
  EXPECT_EQ(refusal({one}).find(file + ": cannot be read: No such file"), 0u) << refusal({one});
  fs::create_directory(file);
  EXPECT_EQ(refusal({one}).find(file + ": cannot be read: Is a directory; expected the calibration"), 0u);
  fs::remove(file);
  for (const char* other : {"", "{\"unit\": 2}"}) {
    scratch.write("one/calibration.json", other);
    EXPECT_EQ(refusal({one}).find(file + ": is another one; expected the calibration"), 0u) << refusal({one});
  }
  scratch.write("one/calibration.json", "{\"unit\":1}\n");
  EXPECT_EQ(refusal({one}), "not refused");
  fs::remove_all(scratch.path() / "out");
  const fs::path log = one / "runs/a.lcm";
  fs::remove(log);
  fs::create_directory(log);
  EXPECT_EQ(refusal({one}).find(log.string() + ": is no file; expected the log"), 0u) << refusal({one});
}

TEST_F(Merge, RefusesTooFewShards) {
  expected = {"a", "b", "c"};
  const auto one = shard("one", {run("a", 6, 0)}), two = shard("two", {run("b", 6, 1)});
  const std::string said = refusal({one, two});
  EXPECT_NE(said.find("no shard holds run 'c'"), std::string::npos) << said;
}

TEST_F(Merge, RefusesAnUnfinishedShardAndAFullDirectory) {
  const auto one = shard("one", {run("a", 6, 0)});
  complete = false;
  const auto two = shard("two", {run("b", 6, 1)});
  EXPECT_NE(refusal({one, two}).find("expected a finished campaign"), std::string::npos);
  fs::create_directories(scratch.path() / "out" / "something");
  EXPECT_NE(refusal({one}).find("is not empty"), std::string::npos);
  EXPECT_NE(refusal({scratch.path() / "nowhere"}).find("nowhere"), std::string::npos);
}

}  // namespace
}  // namespace waverig::evaluation
