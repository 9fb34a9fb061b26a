#include "estimator/evaluation/results_io.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "lcmtypes/atomic_file.h"
#include "estimator/evaluation/height_statistics.h"
#include "estimator/evaluation/summary.h"
#include "estimator/evaluation/waves_csv.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

RunResult run(double period_s, double height_m, const std::string& method, int repeat, double first_m) {
  RunResult r;
  r.run = "run" + std::to_string(repeat);
  r.method = method;
  r.repeat = repeat;
  r.period_s = period_s;
  r.height_m = height_m;
  HeightAccumulator a;
  for (int i = 0; i < 5; ++i) {
    JudgedWave w;
    w.wave.start_utime = i * 6'000'000;
    w.wave.period_s = period_s;
    w.wave.height_m = first_m + 0.001 * i;
    w.wave.noise_sigma_m = 0.001;
    w.true_height_m = height_m;
    a.add(w);
    r.waves.push_back(w);
  }
  a.close_record();
  r.statistics = a.statistics(height_m, 0.0026);
  r.motion = Motion::kRegular;
  r.heave_rmse_m = 0.002;
  r.seas.push_back({.sea = {.hm0_m = 1.5}, .true_hm0_m = 1.49});
  return r;
}

CampaignResults campaign() {
  CampaignResults c;
  c.name = "table 2";
  c.version = "0.1.0";
  c.command = "waverig sweep";
  c.seed = 18446744073709551615u;
  c.complete = true;
  c.calibration_json = R"({"bias":[1,2,3]})";
  c.runs = {run(12, 0.6, "harmonic", 1, 0.601), run(6, 0.6, "lee2014", 0, 0.62),
            run(6, 0.6, "harmonic", 1, 0.599), run(6, 0.6, "harmonic", 0, 0.598)};
  c.cells = cells_of(c.runs);
  return c;
}

TEST(Results, CellsPoolTheWavesOfTheRepeatsInOrder) {
  const auto cells = campaign().cells;
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].method, "harmonic");
  EXPECT_EQ(cells[0].statistics.waves, 10);
  EXPECT_NEAR(cells[0].statistics.mean_height_m, 0.6005, 1e-12);
  EXPECT_EQ(cells[1].method, "lee2014");
  EXPECT_EQ(cells[2].period_s, 12);
  EXPECT_NEAR(cells[0].heave_rmse_m, 0.002, 1e-12);
}

TEST(Results, DoNotDependOnTheOrderInWhichRunsFinish) {
  CampaignResults c = campaign();
  const std::string text = results_csv(cells_of(c.runs));
  std::reverse(c.runs.begin(), c.runs.end());
  EXPECT_EQ(results_csv(cells_of(c.runs)), text);
}

TEST(Results, CsvBeginsWithTheAgreedColumns) {
  const std::string text = results_csv(campaign().cells);
  EXPECT_TRUE(
      text.starts_with("period_s,height_cm,method,waves,mean_height_cm,error_rate_percent,std_cm,"
                       "expanded_uncertainty_cm,rmse_cm,"))
      << text;
  EXPECT_NE(text.find("\n6,60,harmonic,10,60.0500,0.0833,"), std::string::npos) << text;
  EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(Results, ComeBackFromTheDiskWhole) {
  const Scratch scratch;
  CampaignResults c = campaign();
  c.judged_command = "waverig evaluate";
  write_results(scratch.path(), c);
  const CampaignResults back = read_results(scratch.path());
  EXPECT_EQ(back.seed, c.seed);
  EXPECT_EQ(back.command, c.command);
  EXPECT_EQ(back.judged_command, "waverig evaluate");
  EXPECT_EQ(back.judged_version, "");
  EXPECT_EQ(nlohmann::json::parse(back.calibration_json), nlohmann::json::parse(c.calibration_json));
  ASSERT_EQ(back.runs.size(), 4u);
  EXPECT_EQ(back.runs[0].waves.size(), 5u);
  EXPECT_EQ(back.runs[0].waves[3].wave.height_m, c.runs[0].waves[3].wave.height_m);
  EXPECT_TRUE(std::isnan(back.runs[0].waves[3].wave.tilt_sigma_m));
  EXPECT_EQ(back.runs[0].seas.at(0).sea.hm0_m, 1.5);
  ASSERT_EQ(back.cells.size(), 3u);
  EXPECT_EQ(back.cells[0].motion, Motion::kRegular);
  EXPECT_EQ(back.runs[0].motion, Motion::kRegular);
  EXPECT_EQ(back.cells[0].statistics.budget.size(), c.cells[0].statistics.budget.size());
  EXPECT_EQ(back.cells[0].statistics.budget[0].name, "noise");
  EXPECT_EQ(results_csv(back.cells), Scratch::read(scratch.path() / "results.csv"));
}

// The writer that keeps runs on disk gives the same bytes as all runs at hand, whoever finished first.
TEST(Results, WrittenRunByRunAreTheSameBytes) {
  const Scratch scratch;
  CampaignResults c = campaign();
  std::sort(c.runs.begin(), c.runs.end(), earlier);
  write_results(scratch.path(), c);
  const std::string json = Scratch::read(scratch.path() / "results.json"),
                    csv = Scratch::read(scratch.path() / "results.csv");
  CampaignResults head = c;
  head.runs.clear();
  head.cells.clear();
  {
    ResultsWriter writer(scratch.path());
    EXPECT_THROW(read_results(scratch.path()), UserError);  // what an earlier campaign left is gone
    for (const std::size_t i : {2u, 0u, 3u, 1u}) writer.add(c.runs[i]);
    const CampaignResults finished = writer.finish(head, 11);
    EXPECT_EQ(results_csv(finished.cells), csv);
    ASSERT_EQ(finished.runs.size(), 4u);
    EXPECT_EQ(finished.runs[1].waves.size(), 5u);
    EXPECT_EQ(finished.runs[2].waves.size(), 0u);  // above the limit
    EXPECT_EQ(finished.runs[3].statistics.waves, 5);
  }
  EXPECT_EQ(Scratch::read(scratch.path() / "results.json"), json);
  EXPECT_EQ(Scratch::read(scratch.path() / "results.csv"), csv);
  EXPECT_FALSE(std::filesystem::exists(scratch.path() / "results.journal.partial"));
}

TEST(Results, SeaStateAndDirectionStandToTheRightOnlyWhereKnown) {
  CampaignResults c = campaign();
  for (auto& r : c.runs) r.seas.clear();
  EXPECT_EQ(results_csv(cells_of(c.runs)).find("hm0_cm"), std::string::npos);
  EXPECT_EQ(results_csv(cells_of(c.runs)).find("heave_bound"), std::string::npos);
  c.runs[0].heave_bound_m = 0.003;
  c.runs[0].true_hm0_m = 1.5;
  c.runs[0].seas.push_back({.sea = {.hm0_m = 1.5, .mean_direction_rad = 350 * kDegree}, .true_hm0_m = 1.5});
  c.runs[0].seas.push_back({.sea = {.hm0_m = 1.5, .mean_direction_rad = 20 * kDegree}, .true_hm0_m = 1.5});
  const auto cells = cells_of(c.runs);
  EXPECT_NEAR(cells[2].heave_bound_m, 0.003, 1e-12);
  EXPECT_TRUE(std::isnan(cells[0].heave_bound_m));
  EXPECT_NEAR(cells[2].sea.sea.mean_direction_rad / kDegree, 5, 1e-9);
  const std::string text = results_csv(cells);
  EXPECT_NE(text.find(",hm0_cm,true_hm0_cm,hm0_error_percent,"), std::string::npos) << text;
  EXPECT_NE(text.find(",heave_bound_percent"), std::string::npos) << text;
  EXPECT_NE(text.find(",0.2000"), std::string::npos) << text;  // 0.003 of 1.5 m
  EXPECT_NE(text.find(",mean_direction_deg,spread_deg,"), std::string::npos) << text;
}

TEST(Results, LeaveNoTemporaryFiles) {
  const Scratch scratch;
  write_results(scratch.path(), campaign());
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch.path())) {
    ++files;
    EXPECT_TRUE(entry.path().filename() == "results.csv" || entry.path().filename() == "results.json")
        << entry.path();
  }
  EXPECT_EQ(files, 2);
}

TEST(Results, APartialFolderIsNotTakenForAFinishedOne) {
  const Scratch scratch;
  EXPECT_THROW(read_results(scratch.path()), UserError);
  CampaignResults c = campaign();
  write_results(scratch.path(), c);
  c.complete = false;
  write_results(scratch.path(), c);
  EXPECT_THROW(read_results(scratch.path()), UserError);
  c.complete = true;
  write_results(scratch.path(), c);
  EXPECT_NO_THROW(read_results(scratch.path()));
  invalidate_results(scratch.path());
  EXPECT_THROW(read_results(scratch.path()), UserError);
}

TEST(Results, NameTheKeyThatIsWrong) {
  const Scratch scratch;
  write_results(scratch.path(), campaign());
  const auto good = nlohmann::ordered_json::parse(Scratch::read(scratch.path() / "results.json"));
  const auto complaint = [&](const nlohmann::ordered_json& json) -> std::string {
    scratch.write("results.json", json.dump());
    try {
      read_results(scratch.path());
    } catch (const UserError& error) {
      return error.what();
    }
    return "no complaint";
  };
  auto bad = good;
  bad["runs"][1]["std_m"] = "wide";
  EXPECT_NE(complaint(bad).find("results.json, runs[1]: key 'std_m' is \"wide\"; expected a number"),
            std::string::npos)
      << complaint(bad);
  bad = good;
  bad["cells"][0].erase("method");
  EXPECT_NE(complaint(bad).find("cells[0]: key 'method' is missing; expected a string"), std::string::npos) << complaint(bad);
  bad = good;
  bad["runs"][0]["motion"] = "tide";
  EXPECT_NE(complaint(bad).find("runs[0]: key 'motion' is \"tide\"; expected \"regular\" or \"sea\""), std::string::npos)
      << complaint(bad);
  bad["runs"][0].erase("motion");  // as of an older version
  bad["cells"][0].erase("motion");
  EXPECT_EQ(complaint(bad), "no complaint");
  bad = good;
  bad["runs"] = 7;
  EXPECT_NE(complaint(bad).find("expected an array"), std::string::npos) << complaint(bad);
  scratch.write("results.json", "{\n\"a\": [1,\n");
  EXPECT_THROW(read_results(scratch.path()), UserError);
  scratch.write("results.json", "[]");
  EXPECT_THROW(read_results(scratch.path()), UserError);
}

TEST(AtomicFile, ShowsNothingBeforeTheCommitAndKeepsTheOldFileOnFailure) {
  const Scratch scratch;
  const auto path = scratch.write("file", "old");
  {
    AtomicFile file(path);
    file.write("half of the new");
    EXPECT_EQ(Scratch::read(path), "old");
  }
  EXPECT_EQ(Scratch::read(path), "old");
  write_atomically(path, "new");
  EXPECT_EQ(Scratch::read(path), "new");
  EXPECT_THROW(write_atomically(scratch.path() / "no" / "such" / "folder", "x"), UserError);
}

TEST(AtomicFile, OfALinkIsWhatItLeadsTo) {
  const Scratch scratch;
  const auto file = scratch.write("file", "before"), link = scratch.path() / "link";
  std::filesystem::create_symlink("file", link);
  write_atomically(link, "after");
  EXPECT_TRUE(std::filesystem::is_symlink(link));
  EXPECT_EQ(Scratch::read(file), "after");
}

// What is no file stays what it is: a pipe here, /dev/null where the program is root.
TEST(AtomicFile, TakesNoPlaceOfAPipe) {
  const Scratch scratch;
  const auto pipe = scratch.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
  write_atomically(pipe, "told");
  std::array<char, 8> got{};
  EXPECT_EQ(::read(reader, got.data(), got.size()), 4);
  EXPECT_STREQ(got.data(), "told");
  ::close(reader);
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

// As on a full disk: the system takes no more than so many bytes of a file.
class LimitedFiles {
 public:
  explicit LimitedFiles(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~LimitedFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  LimitedFiles(const LimitedFiles&) = delete;
  LimitedFiles& operator=(const LimitedFiles&) = delete;

 private:
  void (*handler_)(int);
  rlimit before_{};
};

TEST(Results, ThatStandAreKeptWhereTheDiskTakesNoMore) {
  const Scratch scratch;
  CampaignResults c = campaign();
  write_results(scratch.path(), c);
  const std::string json = Scratch::read(scratch.path() / "results.json"),
                    csv = Scratch::read(scratch.path() / "results.csv");
  c.cells[0].method = "another";
  for (const std::size_t bytes : {csv.size() / 2, csv.size() + 100}) {  // not even the table; the table alone
    {
      const LimitedFiles full(bytes);
      EXPECT_THROW(write_results(scratch.path(), c), std::runtime_error);
    }
    EXPECT_EQ(Scratch::read(scratch.path() / "results.json"), json);
    EXPECT_EQ(Scratch::read(scratch.path() / "results.csv"), csv);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(scratch.path()), {}), 2) << "and no temporaries";
}

// A folder that is there but not ours: one sentence, not what the library says of it.
TEST(Results, OfAFolderThatMayNotBeWrittenAreRefused) {
  const Scratch scratch;
  write_results(scratch.path(), campaign());
  std::filesystem::permissions(scratch.path(), std::filesystem::perms{0555});
  const bool root = ::geteuid() == 0;
  const auto become = [root](uid_t user) { return !root || ::seteuid(user) == 0; };
  ASSERT_TRUE(become(65534));  // nobody
  EXPECT_THROW(write_results(scratch.path(), campaign()), UserError);
  EXPECT_THROW(invalidate_results(scratch.path()), UserError);
  EXPECT_THROW(ResultsWriter(scratch.path()), UserError);
  ASSERT_TRUE(become(0));
  std::filesystem::permissions(scratch.path(), std::filesystem::perms{0755});
  EXPECT_NO_THROW(read_results(scratch.path()));
}

TEST(Summary, HoldsTheAgreedKeysAndLeavesOutWhatIsUnknown) {
  std::vector<estimator::Wave> waves(4);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    waves[i].period_s = 6;
    waves[i].height_m = 0.6 + 0.01 * static_cast<double>(i);
    waves[i].noise_sigma_m = 0.02;
    waves[i].flags = flag::kSaturation;
  }
  waves.push_back(waves[0]);
  waves.back().flags = flag::kIncomplete;
  const auto json = nlohmann::json::parse(to_json(summary_of("harmonic", waves)));
  EXPECT_EQ(json.at("method"), "harmonic");
  EXPECT_EQ(json.at("waves"), 4);
  EXPECT_NEAR(json.at("mean_height_m").get<double>(), 0.615, 1e-12);
  EXPECT_NEAR(json.at("hmax_m").get<double>(), 0.63, 1e-12);
  EXPECT_NEAR(json.at("mean_period_s").get<double>(), 6, 1e-12);
  EXPECT_NEAR(json.at("expanded_uncertainty_m").get<double>(), 0.02, 1e-12);
  EXPECT_FALSE(json.contains("hm0_m"));
  EXPECT_EQ(json.at("flags"), nlohmann::json::array({"saturation"}));
  EXPECT_NEAR(json.at("uncertainty_budget_m").at("noise").get<double>(), 0.01, 1e-12);

  for (estimator::Wave& wave : waves) wave.noise_sigma_m = estimator::kUnknown;
  const auto unstated = nlohmann::json::parse(to_json(summary_of("theirs", waves)));
  const double scatter_m = 0.01 * std::sqrt(5.0 / 3) / 2;   // of four heights a centimetre apart
  EXPECT_EQ(unstated.at("uncertainty_budget_m").size(), 1u);
  EXPECT_NEAR(unstated.at("uncertainty_budget_m").at("scatter").get<double>(), scatter_m, 1e-12);
  EXPECT_FALSE(unstated.contains("expanded_uncertainty_m")) << "as in a campaign";
}

TEST(Summary, TakesSeaStateAndDirectionFromTheLongestBlocksThatKnowThem) {
  Summary summary;
  std::vector<estimator::SeaState> seas(3);
  seas[0].duration_s = 100;
  seas[0].hm0_m = 1;
  seas[1].duration_s = 200;
  seas[1].hm0_m = 2;
  seas[1].flags = flag::kTooFewWaves;
  seas[2].duration_s = 50;
  seas[2].mean_direction_rad = 90 * kDegree;
  take_sea(summary, seas);
  EXPECT_EQ(summary.hm0_m, 2);
  EXPECT_NEAR(summary.mean_direction_deg, 90, 1e-12);
  EXPECT_EQ(summary.flags, flag::kTooFewWaves);
  EXPECT_EQ(to_json(Summary{}).find("direction"), std::string::npos);
}

}  // namespace
}  // namespace waverig::evaluation
