// The whole way of the data, from the campaign file to the results, in embedded mode.
#include "rig/campaign/sweep.h"

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "estimator/evaluation/results_io.h"
#include "estimator/evaluation/run_record.h"
#include "lcmtypes/error.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig {
namespace {

constexpr const char* kShort =
    "name = \"short\"\nseed = 7\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 40.0\nrepeats = 3\n"
    "ramp_periods = 1\nrest_before_s = 5.0\n";

struct Outcome {
  evaluation::CampaignResults results;
  std::vector<RunPlan> runs;
};

Outcome sweep(const Campaign& campaign, const std::filesystem::path& out, int jobs,
              ResultsDirectory::Mode mode = ResultsDirectory::Mode::kFresh) {
  Outcome outcome;
  outcome.runs = plan_campaign(campaign.settings).runs;
  ResultsDirectory directory(out, mode);
  directory.claim(campaign.resolved, "test");
  const CalibratedUnit calibrated = calibrate(campaign.settings);
  SweepOptions options;
  options.jobs = jobs;
  outcome.results = run_campaign(campaign, calibrated, outcome.runs, directory, options);
  directory.finish();
  return outcome;
}

TEST(TableTwo, HarmonicStaysWithinOnePercentAndNearTheBoundInEveryCell) {
  const TemporaryDirectory temporary;
  const Campaign campaign = read_campaign(std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig/default.toml");
  const Outcome outcome = sweep(campaign, temporary / "out", 2);
  int harmonic_cells = 0;
  for (const auto& cell : outcome.results.cells) {
    EXPECT_GT(cell.statistics.waves, 20) << cell.method;
    if (cell.method != "harmonic") continue;
    ++harmonic_cells;
    EXPECT_LE(cell.statistics.error_rate_percent, 1.0) << cell.period_s << " s " << cell.height_m << " m";
    EXPECT_LE(cell.statistics.std_m, 1.5 * cell.statistics.bound_std_m) << cell.period_s << " s " << cell.height_m << " m";
    EXPECT_GE(cell.statistics.std_m, 0.7 * cell.statistics.bound_std_m) << "too good: look for the leak";
  }
  EXPECT_EQ(harmonic_cells, 6);
}

TEST(Sweep, SameSeedGivesSameResultsAndSameLogBytesForAnyNumberOfJobs) {
  const TemporaryDirectory temporary;
  const Campaign campaign = read_campaign(TomlFile(kShort, "short.toml"));
  const Outcome one = sweep(campaign, temporary / "one", 1), three = sweep(campaign, temporary / "three", 3);
  ASSERT_EQ(one.runs.size(), 3u);
  for (const RunPlan& run : one.runs) {
    const std::string log = "/runs/" + run.name + ".lcm";
    EXPECT_EQ(bytes_of(temporary / ("one" + log)), bytes_of(temporary / ("three" + log)));
  }
  EXPECT_EQ(bytes_of(temporary / "one/results.csv"), bytes_of(temporary / "three/results.csv"));
  EXPECT_EQ(bytes_of(temporary / "one/results.json"), bytes_of(temporary / "three/results.json"));
}

TEST(Sweep, AnotherSeedGivesAnotherNoise) {
  const TemporaryDirectory temporary;
  const std::uint64_t other = 8;
  const Outcome a = sweep(read_campaign(TomlFile(kShort, "short.toml")), temporary / "a", 2);
  const Outcome b = sweep(read_campaign(TomlFile(kShort, "short.toml"), &other), temporary / "b", 2);
  EXPECT_NE(bytes_of(temporary / "a/results.csv"), bytes_of(temporary / "b/results.csv"));
}

TEST(Sweep, ResumesToTheSameResultAsAnUninterruptedOne) {
  const TemporaryDirectory temporary;
  const Campaign campaign = read_campaign(TomlFile(kShort, "short.toml"));
  const Outcome whole = sweep(campaign, temporary / "whole", 2);

  const std::filesystem::path partial = temporary / "resumed.partial";
  std::filesystem::create_directories(partial / "runs");
  const std::string done = whole.runs.front().name + ".lcm", torn = whole.runs.back().name + ".lcm.part";
  std::filesystem::copy_file(temporary / ("whole/runs/" + done), partial / "runs" / done);
  std::ofstream(partial / "runs" / torn) << "what a killed run leaves";
  sweep(campaign, temporary / "resumed", 2, ResultsDirectory::Mode::kResume);
  EXPECT_EQ(bytes_of(temporary / "resumed/results.json"), bytes_of(temporary / "whole/results.json"));
}

TEST(Sweep, LogIsReadByTheStockLibraryAndHoldsEveryChannel) {
  const TemporaryDirectory temporary;
  const Outcome outcome = sweep(read_campaign(TomlFile(kShort, "short.toml")), temporary / "out", 1);
  const auto path = temporary / ("out/runs/" + outcome.runs.front().name + ".lcm");
  lcm::LogFile log(path.string(), "r");
  ASSERT_TRUE(log.good());
  std::map<std::string, std::int64_t> events;
  std::int64_t last_utime = 0;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    ++events[event->channel];
    EXPECT_GE(event->timestamp, last_utime) << "virtual time runs on";
    last_utime = event->timestamp;
  }
  for (const char* channel : {"WAVERIG_IMU", "WAVERIG_COUNTS", "WAVERIG_TRUTH", "WAVERIG_AXIS", "WAVERIG_RUN", "WAVERIG_RECORD",
                              "WAVERIG_HEAVE_lee2014", "WAVERIG_WAVE_lee2014", "WAVERIG_WAVE_harmonic"})
    EXPECT_GT(events[channel], 0) << channel;
  EXPECT_EQ(events["WAVERIG_IMU"], events["WAVERIG_COUNTS"]);
}

TEST(Sweep, RefusesATruncatedLogOnResume) {
  const TemporaryDirectory temporary;
  const Campaign campaign = read_campaign(TomlFile(kShort, "short.toml"));
  const Outcome whole = sweep(campaign, temporary / "whole", 2);
  const std::filesystem::path partial = temporary / "resumed.partial";
  std::filesystem::create_directories(partial / "runs");
  const auto log = partial / "runs" / (whole.runs.front().name + ".lcm");
  std::filesystem::copy_file(temporary / ("whole/runs/" + whole.runs.front().name + ".lcm"), log);
  std::filesystem::resize_file(log, std::filesystem::file_size(log) - 5);
  EXPECT_THROW(sweep(campaign, temporary / "resumed", 1, ResultsDirectory::Mode::kResume), UserError);
  EXPECT_FALSE(std::filesystem::exists(temporary / "resumed"));
}

TEST(Calibration, FindsTheSimulatedSensorWithinItsStatedUncertainty) {
  const Campaign campaign = read_campaign(TomlFile(kShort, "short.toml"));
  const CalibratedUnit calibrated = calibrate(campaign.settings);
  const auto truth = true_calibration(calibrated.unit.settings, calibrated.unit.tested, calibrated.unit.sensitivities,
                                      calibrated.unit.calibration.temperature_degC);
  const auto& found = calibrated.unit.calibration.accelerometer;
  EXPECT_LT(((found.M - truth.M).array() / found.sigma_M().array()).abs().maxCoeff(), 4);
  EXPECT_LT(((found.b_mps2 - truth.b_mps2).array() / found.sigma_b_mps2().array()).abs().maxCoeff(), 4);
  EXPECT_GT((truth.M - Matrix3d::Identity()).cwiseAbs().maxCoeff(), 1e-3) << "there was something to find";
}

TEST(ResultsTable, ShowsSettingsInFullAndWhatIsNotKnownAsADash) {
  evaluation::CampaignResults results;
  evaluation::CellResult cell;
  cell.period_s = 6;
  cell.height_m = 1;
  cell.method = "harmonic";
  results.cells.push_back(cell);
  cell.statistics.waves = 1;
  cell.statistics.mean_height_m = 0.9907;
  cell.statistics.mean_true_height_m = 1;
  cell.statistics.mean_error_percent = -0.93;
  results.cells.push_back(cell);
  for (const Mover mover : {Mover::kArm, Mover::kSea}) {
    const std::string table = results_table(results, mover);
    EXPECT_EQ(table.find("nan"), std::string::npos) << table;
    EXPECT_NE(table.find(" -\n"), std::string::npos) << table;
  }
  results.cells[1].period_s = 6.25;
  EXPECT_NE(results_table(results, Mover::kArm).find("\n    6.25       100  harmonic"), std::string::npos);
  EXPECT_NE(results_table(results, Mover::kArm).find("    99.07    100.00    -0.93        -"), std::string::npos)
      << results_table(results, Mover::kArm);
}

}  // namespace
}  // namespace waverig::rig
