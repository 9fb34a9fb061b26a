// The program from outside: exit status, the one line on stderr, and that bad input harms nothing.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>
#include <waverig/imu_t.hpp>

#include "estimator/calibration/accelerometer_calibration.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/event_log.h"

#include "tests/campaign/temporary_directory.h"

namespace waverig {
namespace {

struct Outcome {
  int status = -1;
  std::string out, err;
};

Outcome run(const TemporaryDirectory& temporary, const std::string& arguments) {
  const std::string out = (temporary / "stdout").string(), err = (temporary / "stderr").string();
  const int status = std::system((std::string("cd ") + temporary.path().string() + " && " WAVERIG_PROGRAM " " + arguments + " >" +
                                  out + " 2>" + err)
                                     .c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(out), bytes_of(err)};
}

constexpr const char* kTiny =
    "name = \"tiny\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 30.0\nrepeats = 1\nramp_periods = 1\n";

// The names under "Subcommands:" of a help text.
std::vector<std::string> subcommands_in(const std::string& help) {
  std::vector<std::string> names;
  std::istringstream lines(help);
  std::string line;
  while (std::getline(lines, line) && line != "Subcommands:") continue;
  while (std::getline(lines, line) && line.starts_with("  "))
    if (line[2] != ' ') names.push_back(line.substr(2, line.find(' ', 2) - 2));
  return names;
}

// Every command in its turn, those of commands too: how many.
int expect_examples(const TemporaryDirectory& temporary, const std::string& command) {
  const Outcome help = run(temporary, command + "--help");
  EXPECT_EQ(help.status, 0) << command;
  const std::size_t examples = help.out.find("Example");
  EXPECT_NE(examples, std::string::npos) << command << help.out;
  const std::string shown = help.out.substr(std::min(examples, help.out.size()));
  EXPECT_NE(shown.find("\n  waverig " + command), std::string::npos) << command << help.out;
  int commands = 1;
  for (const std::string& name : subcommands_in(help.out)) commands += expect_examples(temporary, command + name + " ");
  return commands;
}

TEST(Program, HelpOfEveryCommandShowsExamplesOfItsOwn) {
  const TemporaryDirectory temporary;
  EXPECT_GT(expect_examples(temporary, ""), 28);
}

struct BadCall {
  const char* name;
  const char* arguments;
  const char* complaint;   // what the line must hold
};

class ProgramRefuses : public ::testing::TestWithParam<BadCall> {};

TEST_P(ProgramRefuses, WithExitTwoAndOneLine) {
  const TemporaryDirectory temporary;
  temporary.write("unknown_key.toml", std::string("colour = 1\n") + kTiny);
  temporary.write("wrong_type.toml", std::string(kTiny) + "rest_before_s = \"long\"\n");
  temporary.write("too_high.toml", "name = \"t\"\n[sweep]\nperiods_s = [6.0]\nheights_cm = [900.0]\n");
  temporary.write("no.toml", "name = \n");
  temporary.write("twice.toml", "name = \"t\"\n[sweep]\nperiods_s = [6.0, 6.0]\nheights_cm = [60.0]\n");
  temporary.write("methods_twice.toml",
                  "name = \"t\"\nmethods = [\"harmonic\", \"harmonic\"]\n[sweep]\nperiods_s = [6.0]\nheights_cm = [60.0]\n");
  temporary.write("broken_row.csv", "utime,ax,ay,az,gx,gy,gz\n0,0,0,-9.8,0,0,0\n10000,0,0,x,0,0,0\n");
  temporary.write("level.csv", "utime,ax,ay,az,gx,gy,gz\n0,0,0,-9.8,0,0,0\n10000,0,0,-9.8,0,0,0\n");
  temporary.write("no_header.csv", "1,2,3\n");
  temporary.write("truncated.lcm", std::string("\xED\xA1\xDA\x01", 4) + "short");
  temporary.write("heave.csv", "utime,heave_m\n0,1\n0,2\n");
  temporary.write("empty.toml", "");
  std::string milliseconds = "utime,ax,ay,az,gx,gy,gz\n", seconds = "utime,heave_m\n";
  for (int row = 0; row < 300; ++row) {
    milliseconds += std::to_string(10 * row) + ",0,0," + std::to_string(-9.8 + 0.01 * (row % 7)) + ",0,0,0\n";
    seconds += std::to_string(row) + "," + std::to_string(row % 7) + "\n";
  }
  temporary.write("milliseconds.csv", milliseconds);
  temporary.write("seconds.csv", seconds);
  const Outcome outcome = run(temporary, GetParam().arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(GetParam().complaint), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  // The last file of a finished directory is what makes it one.
  EXPECT_FALSE(std::filesystem::exists(temporary / "out/results.json"));
  EXPECT_FALSE(std::filesystem::exists(temporary / "out/summary.json"));
}

INSTANTIATE_TEST_SUITE_P(
    BadInput, ProgramRefuses,
    ::testing::Values(
        BadCall{"NoCommand", "", "subcommand"}, BadCall{"UnknownCommand", "swep x", "swep"},
        BadCall{"UnknownCommandOfACommand", "node estimater", "\"estimater\" is no command; expected one of rig-sim, motion"},
        BadCall{"NoOut", "sweep unknown_key.toml", "--out"},
        BadCall{"MissingFile", "sweep nowhere.toml --out out", "nowhere.toml"},
        BadCall{"NotToml", "sweep no.toml --out out", "no.toml:1"},
        BadCall{"UnknownKey", "sweep unknown_key.toml --out out", "unknown_key.toml:1: colour = 1: unknown key"},
        BadCall{"WrongType", "sweep wrong_type.toml --out out", "wrong_type.toml:8: sweep.rest_before_s = 'long'"},
        BadCall{"TooHigh", "sweep too_high.toml --out out", "too_high.toml:4: sweep.heights_cm = 900"},
        BadCall{"PeriodTwice", "sweep twice.toml --out out", "twice.toml:3: sweep.periods_s = [ 6.0, 6.0 ]: expected each value once, 0.01 apart at least"},
        BadCall{"MethodTwice", "sweep methods_twice.toml --out out", "methods_twice.toml:2: methods = [ 'harmonic', 'harmonic' ]: expected each name once"},
        BadCall{"BadShard", "sweep too_high.toml --out out --shard 3/2", "--shard 3/2"},
        BadCall{"BrokenRow", "estimate broken_row.csv --out out", "broken_row.csv, line 3, column az: 'x'"},
        BadCall{"TimesInMilliseconds", "estimate milliseconds.csv --out out", "milliseconds.csv: column utime: by its times a row every 1e-05 s; expected microseconds"},
        BadCall{"HeaveTimesInSeconds", "evaluate seconds.csv --out out", "seconds.csv: column utime: by its times a row every 1e-06 s; expected microseconds"},
        BadCall{"EmptyCampaign", "sweep empty.toml --out out", "empty.toml:1: name is missing"},
        BadCall{"NoHeader", "estimate no_header.csv --out out", "no_header.csv, line 1"},
        BadCall{"TruncatedLog", "estimate truncated.lcm --out out", "truncated.lcm"},
        BadCall{"UnknownMethod", "estimate broken_row.csv --method magic --out out", "magic"},
        BadCall{"RestIsNoNumber", "estimate level.csv --rest-seconds abc --out out", "--rest-seconds: abc: expected a number of 0 or more"},
        BadCall{"RestIsNaN", "estimate level.csv --rest-seconds nan --out out", "--rest-seconds: nan: expected a number of 0 or more"},
        BadCall{"GravityIsNaN", "estimate level.csv --gravity nan --out out", "--gravity: nan: expected a number from 9.7 to 9.9"},
        BadCall{"GravityIsOfTheMoon", "estimate level.csv --gravity 1.62 --out out", "--gravity: 1.62: expected a number from 9.7 to 9.9"},
        BadCall{"DeclinationIsNaN", "estimate level.csv --declination nan --out out", "--declination: nan: expected a number from -180 to 180"},
        BadCall{"ZeroLineIsInfinite", "evaluate heave.csv --zero-line-m inf --out out", "--zero-line-m: inf: expected a number"},
        BadCall{"FixtureIsNaN", "calibrate accelerometer level.csv --fixture-sigma-deg nan --out out", "--fixture-sigma-deg: nan: expected a number from 0 to 10"},
        BadCall{"BeginIsNaN", "film truncated.lcm --begin nan --out out", "--begin: nan: expected a number"},
        BadCall{"SpeedIsZero", "film truncated.lcm --speed 0 --out out", "--speed: 0: expected a number above 0"},
        BadCall{"SeedBelowZero", "sweep tiny.toml --seed -1 --out out", "--seed: -1: expected a whole number from 0"},
        BadCall{"SeedOfAnAnalysis", "analyse compass --seed -1 --out out", "--seed: -1: expected a whole number from 0"},
        BadCall{"OutIsAFile", "estimate level.csv --out level.csv", "--out level.csv: "},
        BadCall{"OutIsTheRecording", "calibrate accelerometer level.csv --out ./level.csv", "--out ./level.csv: is the recording itself"},
        BadCall{"OutIsTheLog", "film truncated.lcm --out truncated.lcm", "--out truncated.lcm: is the recording itself"},
        BadCall{"FilmIsAFolder", "film truncated.lcm --out .", "--out .: is a folder; expected an MP4 file"},
        BadCall{"NotSixPositions", "calibrate accelerometer level.csv --out out", "level.csv: six-position calibration: x up held still for 0 s"},
        BadCall{"NoMagnetometer", "calibrate compass level.csv --out out", "level.csv: no magnetic field"},
        BadCall{"NoCalibration", "estimate level.csv --calibration no.toml --out out", "no.toml"},
        BadCall{"TruthForACampaign", "evaluate . --truth heave.csv --out out", "--truth: . is a directory"},
        BadCall{"NetcdfForACampaign", "evaluate . --netcdf --out out", "--netcdf: . is a directory"},
        BadCall{"DetrendForACampaign", "evaluate . --detrend --out out", "--detrend: . is a directory"},
        BadCall{"DeadBandForACampaign", "evaluate . --dead-band-m 0.1 --out out", "--dead-band-m: . is a directory"},
        BadCall{"DeadBandIsNoNumber", "evaluate heave.csv --dead-band-m abc --out out", "--dead-band-m: abc: expected a number of 0 or more"},
        BadCall{"DeadBandIsNaN", "evaluate heave.csv --dead-band-m nan --out out", "--dead-band-m: nan: expected a number of 0 or more"},
        BadCall{"HighPassBelowZero", "evaluate heave.csv --truth heave.csv --high-pass-hz=-1 --out out", "--high-pass-hz: -1: expected a number of 0 or more"},
        BadCall{"HighPassWithoutTruth", "evaluate heave.csv --high-pass-hz 0.1 --out out", "--truth"},
        BadCall{"OthersForAHeave", "evaluate heave.csv --heave a=. --out out", "--heave: heave.csv is no directory"},
        BadCall{"OneValueToEachHeave", "evaluate --heave a=. nowhere --out out", "--heave: nowhere is no directory"},
        BadCall{"CommaInAName", "evaluate . --heave a,b=. --out out", "--heave a,b=.: name 'a,b'"},
        BadCall{"NameTwice", "evaluate . --heave a=. --heave a=. --out out", "--heave a=.: 'a' is given twice"},
        BadCall{"TimeStandsStill", "evaluate heave.csv --out out", "heave.csv, line 3, column utime"}),
    [](const auto& instance) { return instance.param.name; });

TEST(Program, SweepWritesEverythingAResultsDirectoryHolds) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  const Outcome outcome = run(temporary, "sweep tiny.toml --out out --jobs 2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "") << "no progress where stderr is no terminal";
  EXPECT_NE(outcome.out.find("harmonic"), std::string::npos);
  for (const char* file : {"results.csv", "results.json", "report.html", "campaign.toml", "calibration.json", "runs/T04.00s_H050.0cm_r1.lcm"})
    EXPECT_TRUE(std::filesystem::exists(temporary / "out" / file)) << file;
  EXPECT_FALSE(std::filesystem::is_empty(temporary / "out/figures"));
  const std::string csv = bytes_of(temporary / "out/results.csv");
  EXPECT_TRUE(csv.starts_with("period_s,height_cm,method,waves,mean_height_cm,error_rate_percent,std_cm,"
                              "expanded_uncertainty_cm,rmse_cm"))
      << csv;
  const Outcome again = run(temporary, "sweep tiny.toml --out out");
  EXPECT_EQ(again.status, 2);
  EXPECT_EQ(bytes_of(temporary / "out/results.csv"), csv);
}

TEST(Program, ReportsCampaignsOfWavesAndOfSeasAndHoldsThemSideBySide) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  temporary.write("sea.toml",
                  "name = \"sea\"\nmethods = [\"smoothed\"]\n[sweep]\nmotion = \"jonswap\"\nperiods_s = [6.0]\n"
                  "heights_cm = [100.0]\nduration_s = 120.0\nrepeats = 1\n");
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out waves").status, 0);
  const Outcome sea = run(temporary, "sweep sea.toml --out sea");
  ASSERT_EQ(sea.status, 0) << sea.err;
  EXPECT_TRUE(std::filesystem::exists(temporary / "sea/figures/sea-states.png"));
  EXPECT_NE(bytes_of(temporary / "sea/report.html").find("% of Hm0"), std::string::npos);
  EXPECT_EQ(bytes_of(temporary / "waves/report.html").find("% of Hm0"), std::string::npos);
  const std::string judged = bytes_of(temporary / "sea/results.csv");
  EXPECT_NE(judged.find("heave_bound_percent"), std::string::npos) << judged;
  ASSERT_EQ(run(temporary, "evaluate sea --out anew").status, 0);  // which has the bound from the results that stand
  EXPECT_EQ(bytes_of(temporary / "anew/results.csv"), judged);
  const std::string anew = bytes_of(temporary / "anew/results.json");
  EXPECT_NE(anew.find("\"command\": \"waverig sweep sea.toml"), std::string::npos);
  EXPECT_NE(anew.find("\"judged_command\": \"waverig evaluate sea --out anew\""), std::string::npos);
  EXPECT_NE(anew.find("\"judged_version\": \""), std::string::npos);
  EXPECT_EQ(bytes_of(temporary / "sea/results.json").find("judged_"), std::string::npos);
  for (const std::string campaign : {"waves", "sea"}) {
    const Outcome compared = run(temporary, "report " + campaign + " --compare " + campaign + " --out pair.html");
    ASSERT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(compared.out, "pair.html\n");
    EXPECT_NE(bytes_of(temporary / "pair.html").find("not significant"), std::string::npos) << campaign;
  }
  const Outcome strangers = run(temporary, "report waves --compare sea --out none.html");
  EXPECT_EQ(strangers.status, 2);
  EXPECT_NE(strangers.err.find("in common"), std::string::npos) << strangers.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "none.html"));
}

TEST(Program, JudgesIntoADirectoryThatIsWholeByItself) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out other --seed 7").status, 0);
  ASSERT_EQ(run(temporary, "evaluate done --out anew").status, 0);
  ASSERT_EQ(run(temporary, "evaluate done --out anew").status, 0) << "again";
  std::filesystem::remove_all(temporary / "done");
  const Outcome figures = run(temporary, "figures anew");
  EXPECT_EQ(figures.status, 0) << figures.err;
  EXPECT_NE(figures.out.find("anew/figures/spectra.png"), std::string::npos) << figures.out;  // of a log
  EXPECT_EQ(run(temporary, "report anew").status, 0);
  EXPECT_NE(bytes_of(temporary / "anew/report.html").find("<code>waverig evaluate done --out anew</code>"),
            std::string::npos);
  EXPECT_EQ(run(temporary, "sweep anew/campaign.toml --out again").status, 0);
  EXPECT_EQ(bytes_of(temporary / "anew/runs/T04.00s_H050.0cm_r1.lcm"),
            bytes_of(temporary / "again/runs/T04.00s_H050.0cm_r1.lcm"));
  // Results of another campaign stay.
  const std::string before = bytes_of(temporary / "other/results.json");
  const Outcome taken = run(temporary, "evaluate anew --out other");
  EXPECT_EQ(taken.status, 2);
  EXPECT_NE(taken.err.find("--out other: other/campaign.toml is of another campaign"), std::string::npos) << taken.err;
  EXPECT_EQ(bytes_of(temporary / "other/results.json"), before);
}

// Heave of someone else's program, of the right motion but on another clock, short, or upside down.
TEST(Program, RemarksOnHeaveThatDoesNotFitTheRun) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  const std::string name = "T04.00s_H050.0cm_r1";
  ASSERT_EQ(run(temporary, "estimate done/runs/" + name + ".lcm --out ours").status, 0);
  const auto give = [&](const std::string& folder, std::int64_t later_us, double gain, double part) {
    std::istringstream rows(bytes_of(temporary / "ours/heave.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(rows, line);) lines.push_back(line);
    std::string text = "utime,heave_m\n";
    for (std::size_t i = 1; i < static_cast<std::size_t>(part * static_cast<double>(lines.size())); ++i) {
      const std::size_t comma = lines[i].find(',');
      text += std::to_string(std::stoll(lines[i]) + later_us) + "," +
              std::to_string(gain * std::stod(lines[i].substr(comma + 1))) + "\n";
    }
    std::filesystem::create_directories(temporary / folder);
    temporary.write(folder + "/" + name + ".csv", text);
    return run(temporary, "evaluate done --heave theirs=" + folder + " --out judged_" + folder);
  };
  const Outcome good = give("good", 0, 1, 1);
  EXPECT_EQ(good.status, 0);
  EXPECT_EQ(good.err, "");
  const Outcome hour = give("hour", 3'600'000'000, 1, 1);
  EXPECT_EQ(hour.status, 2);
  EXPECT_NE(hour.err.find("hour/" + name + ".csv: heave from "), std::string::npos) << hour.err;
  EXPECT_NE(hour.err.find("none in the steady part of the run from "), std::string::npos) << hour.err;
  EXPECT_FALSE(std::filesystem::exists(temporary / "judged_hour"));
  const Outcome part = give("part", 0, 1, 0.5);
  EXPECT_EQ(part.status, 0);
  EXPECT_NE(part.err.find("% of the run's steady part"), std::string::npos) << part.err;
  EXPECT_NE(part.out.find(",gap "), std::string::npos) << part.out;
  const Outcome down = give("down", 0, -1, 1);
  EXPECT_EQ(down.status, 0);
  EXPECT_NE(down.err.find("upside down"), std::string::npos) << down.err;
  const Outcome taken = run(temporary, "evaluate done --heave harmonic=good --out taken");
  EXPECT_EQ(taken.status, 2);
  EXPECT_NE(taken.err.find("expected another name"), std::string::npos) << taken.err;
}

TEST(Program, ResultsDirectoryAloneReproducesItself) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out first --seed 5").status, 0);
  ASSERT_EQ(run(temporary, "sweep first/campaign.toml --out second").status, 0);
  EXPECT_EQ(bytes_of(temporary / "first/results.csv"), bytes_of(temporary / "second/results.csv"));
}

TEST(Program, EstimatesARecordedRunAsTheSweepDid) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out out").status, 0);
  const Outcome outcome =
      run(temporary, "estimate out/runs/T04.00s_H050.0cm_r1.lcm --method harmonic --out again");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t at = outcome.out.find("\"h13_m\":");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  EXPECT_NEAR(std::stod(outcome.out.substr(at + 8)), 0.5, 0.02) << "of the steady waves: the ramps' are lower";
}

TEST(Program, SaysWhichSamplesOfALogWereLeftOutAndWhy) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  const std::string log = "done/runs/T04.00s_H050.0cm_r1.lcm";
  const Outcome good = run(temporary, "estimate " + log + " --out good");
  EXPECT_EQ(good.err, "");
  EXPECT_NE(good.out.find("\"samples_left_out\": 0"), std::string::npos) << good.out;
  // The same run, the sensor's clock set back by five seconds after the first thousand samples.
  EventLogReader reader(temporary / log);
  EventLogWriter writer(temporary / "back.lcm");
  LogEvent event;
  for (int samples = 0; reader.next(event);) {
    if (event.channel != channel::kImu) continue;
    imu_t m{};
    ASSERT_TRUE(event.decode(m));
    if (++samples > 1000) m.utime -= 5'000'000;
    std::vector<std::uint8_t> data(static_cast<std::size_t>(m.getEncodedSize()));
    m.encode(data.data(), 0, m.getEncodedSize());
    writer.write(event.utime, event.channel, data.data(), data.size());
  }
  writer.close();
  const Outcome back = run(temporary, "estimate back.lcm --out back");
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_TRUE(back.err.starts_with("waverig: back.lcm: 500 of ")) << back.err;
  EXPECT_NE(back.err.find("(from sample 1001, time "), std::string::npos) << back.err;
  EXPECT_NE(back.err.find("was the clock set back by 5.0 s?"), std::string::npos) << back.err;
  EXPECT_EQ(std::count(back.err.begin(), back.err.end(), '\n'), 1) << back.err;
  EXPECT_NE(back.out.find("\"samples_left_out\": 500"), std::string::npos) << back.out;
}

std::string six_sides(double bias_mps2) {
  std::string text = "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 6 * 600; ++row) {
    const int pose = row / 600, wiggle = row % 2;
    double f[3] = {bias_mps2 + 0.001 * wiggle, bias_mps2, bias_mps2};
    f[pose / 2] += pose % 2 == 0 ? 9.80665 : -9.80665;
    text += std::to_string(row * 10000) + "," + std::to_string(f[0]) + "," + std::to_string(f[1]) + "," +
            std::to_string(f[2]) + ",0.01,0.02,0.03\n";
  }
  return text;
}

TEST(Program, CalibratesAUnitLaidOnItsSixSides) {
  const TemporaryDirectory temporary;
  temporary.write("sides.csv", six_sides(0.25));
  const Outcome outcome = run(temporary, "calibrate accelerometer sides.csv --sensor unit7 --out unit7.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("0.250"), std::string::npos) << outcome.out;
  EXPECT_NE(bytes_of(temporary / "unit7.json").find("unit7"), std::string::npos);
}

// A wave of 4 s and a metre as a level unit feels it.
std::string wave_record() {
  std::string text = "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 12000; ++row)
    text += std::to_string(row * 10000) + ",0,0," +
            std::to_string(-9.80665 + 1.2337 * std::cos(2 * std::numbers::pi * row / 400)) + ",0,0,0\n";
  return text;
}

double number_in(const std::string& json, const std::string& key) {
  const std::size_t at = json.find("\"" + key + "\":");
  return at == std::string::npos ? std::nan("") : std::stod(json.substr(at + key.size() + 3));
}

TEST(Program, StatesTheUncertaintyThatTheCalibrationFileLeaves) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  estimator::SensorCalibration calibration;
  calibration.accelerometer.covariance.diagonal().head<12>().setConstant(1e-7);
  calibration.gyroscope.offset_sigma_radps.setConstant(1e-4);
  estimator::store_calibration(calibration, temporary / "good.json");
  calibration.accelerometer.covariance *= 1e4;
  estimator::store_calibration(calibration, temporary / "poor.json");
  for (const std::string method : {"harmonic", "smoothed", "lee2014"}) {
    const std::string call = "estimate wave.csv --method " + method + " --calibration ";
    const Outcome good = run(temporary, call + "good.json --out " + method + "_good"),
                  poor = run(temporary, call + "poor.json --out " + method + "_poor");
    ASSERT_EQ(good.status, 0) << good.err;
    ASSERT_EQ(poor.status, 0) << poor.err;
    EXPECT_GT(number_in(poor.out, "expanded_uncertainty_m"), 1.5 * number_in(good.out, "expanded_uncertainty_m"))
        << method << good.out << poor.out;
  }
}

TEST(Program, CalibratesSamplesOfALogOnce) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  temporary.write("raw.toml", std::string(kTiny) + "[calibration]\nenabled = false\n");
  estimator::store_calibration({}, temporary / "unit.json");
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out done").status, 0);
  ASSERT_EQ(run(temporary, "sweep raw.toml --out raw").status, 0);
  const std::string run_log = "/runs/T04.00s_H050.0cm_r1.lcm ";
  for (const std::string& command : {"estimate done" + run_log + "--calibration unit.json --out x",
                                    "calibrate accelerometer done" + run_log + "--out x",
                                    "calibrate compass done" + run_log + "--base unit.json --out x"}) {
    const Outcome twice = run(temporary, command);
    EXPECT_EQ(twice.status, 2) << command;
    EXPECT_NE(twice.err.find("calibrated already"), std::string::npos) << twice.err;
    EXPECT_EQ(std::count(twice.err.begin(), twice.err.end(), '\n'), 1) << twice.err;
    EXPECT_FALSE(std::filesystem::exists(temporary / "x/summary.json"));
  }
  const Outcome once = run(temporary, "estimate raw" + run_log + "--calibration unit.json --out once");
  EXPECT_EQ(once.status, 0) << once.err;
}

TEST(Program, SaysInTheSummaryWhatItWasMadeOf) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  estimator::store_calibration({}, temporary / "unit.json");
  const Outcome outcome = run(temporary, "estimate wave.csv --method realtime --calibration unit.json --gravity 9.81 "
                                         "--rest-seconds 0.5 --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string summary = bytes_of(temporary / "out/summary.json");
  EXPECT_EQ(summary, outcome.out);
  const std::string version = run(temporary, "--version").out;  // "waverig X\n"
  const std::string sum = run(temporary, "--version >/dev/null; sha256sum wave.csv").out.substr(0, 64);
  for (const std::string& expected :
       {std::string("\"method\": \"realtime\""), std::string("\"sea_state_method\": \"spectral\""),
        "\"version\": \"" + version.substr(8, version.size() - 9) + "\"", std::string("\"input\": \"wave.csv\""),
        "\"input_sha256\": \"" + sum + "\"", std::string("\"calibration\": \"unit.json\""),
        std::string("\"gravity_mps2\": 9.81"), std::string("\"rest_s\": 0.5"), std::string("\"samples\": 12000"),
        std::string("\"begin_utime\": 0"), std::string("\"end_utime\": 119990000")})
    EXPECT_NE(summary.find(expected), std::string::npos) << expected << "\n" << summary;
}

// Runs a command, waits for a file to be there, and ends the command by SIGTERM: its exit status as a shell has it.
Outcome ended_early(const TemporaryDirectory& temporary, const std::string& arguments, const std::string& file) {
  temporary.write("end.sh", "cd '" + temporary.path().string() + "'\n" WAVERIG_PROGRAM " " + arguments +
                                " >stdout 2>stderr &\n"
                                "for i in $(seq 3000); do ls " + file + " >/dev/null 2>&1 && break; sleep 0.01; done\n"
                                "kill -TERM $!\nwait $!\n");
  const int status = std::system(("sh " + (temporary / "end.sh").string() + " 2>/dev/null").c_str());
  return {WEXITSTATUS(status), bytes_of(temporary / "stdout"), bytes_of(temporary / "stderr")};
}

TEST(Program, NamesResumeWhereASweepIsInterrupted) {
  const TemporaryDirectory temporary;
  temporary.write("long.toml",
                  "name = \"long\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 20000.0\n");
  const Outcome outcome = ended_early(temporary, "sweep long.toml --jobs 2 --out out", "out.partial/calibration.json");
  EXPECT_EQ(outcome.status, 128 + SIGTERM);
  EXPECT_EQ(outcome.err, "waverig: interrupted; out.partial keeps the runs that are done, --resume goes on with them\n");
}

TEST(Program, LeavesNothingHalfWhereAnEstimateIsInterrupted) {
  const TemporaryDirectory temporary;
  std::ofstream record(temporary / "long.csv");
  record << "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 1000000; ++row) record << row << "0000,0,0,-9.8,0,0,0\n";
  record.close();
  const Outcome outcome = ended_early(temporary, "estimate long.csv --method realtime --out out", "out/heave.csv.*");
  EXPECT_EQ(outcome.status, 128 + SIGTERM) << outcome.err;
  EXPECT_TRUE(std::filesystem::is_empty(temporary / "out"));
}

TEST(Program, KeepsAnEarlierFilmWhereTheNextIsInterrupted) {
  const TemporaryDirectory temporary;
  temporary.write("long.toml", "name = \"long\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 600.0\nrepeats = 1\n");
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
  EXPECT_NE(refused.err.find("out.partial is unfinished; expected --replace"), std::string::npos) << refused.err;
  EXPECT_EQ(run(temporary, "analyse compass --runs 2 --out out --replace").status, 0);
  temporary.write("c.toml", kTiny);
  std::filesystem::create_directories(temporary / "swept.partial");
  temporary.write("swept.partial/campaign.toml", "");
  const Outcome campaign = run(temporary, "sweep c.toml --out swept");
  EXPECT_NE(campaign.err.find("expected --resume to go on or --replace"), std::string::npos) << campaign.err;
}

TEST(Program, AnEarlierEstimateIsReplacedAsAWhole) {
  const TemporaryDirectory temporary;
  std::string csv = "utime,ax,ay,az,gx,gy,gz\n";
  for (int i = 0; i < 3000; ++i) csv += std::to_string(20000 * i) + ",0,0,-9.80665,0,0,0\n";
  temporary.write("level.csv", csv);
  EXPECT_EQ(run(temporary, "estimate level.csv --out out --netcdf").status, 0);
  EXPECT_TRUE(std::filesystem::exists(temporary / "out/record.nc"));
  EXPECT_EQ(run(temporary, "estimate level.csv --out out").status, 0);
  EXPECT_FALSE(std::filesystem::exists(temporary / "out/record.nc")) << "of the earlier call";
}

TEST(Program, KeepsAnEarlierEstimateWhereTheNextFails) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  temporary.write("broken.csv", wave_record() + "120000000,0,0,x,0,0,0\n");
  ASSERT_EQ(run(temporary, "estimate wave.csv --out out").status, 0);
  const std::string summary = bytes_of(temporary / "out/summary.json"), heave = bytes_of(temporary / "out/heave.csv");
  EXPECT_EQ(run(temporary, "estimate broken.csv --out out").status, 2);
  EXPECT_EQ(bytes_of(temporary / "out/summary.json"), summary);
  EXPECT_EQ(bytes_of(temporary / "out/heave.csv"), heave);
}

TEST(Program, PlanSaysNoWithExitOneAndTheReason) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", "name = \"t\"\n[sweep]\nperiods_s = [1.0, 6.0]\nheights_cm = [200.0]\n");
  const Outcome outcome = run(temporary, "plan c.toml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.out.find("REFUSED"), std::string::npos);
}

}  // namespace
}  // namespace waverig
