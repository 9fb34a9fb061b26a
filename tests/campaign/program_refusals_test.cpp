// Bad input: exit status 2, the one line on stderr, and nothing harmed.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/campaign/program.h"

namespace waverig {
namespace {

struct BadCall {
  const char* name;
  const char* arguments;
  const char* complaint;  // what the line must hold
};

class ProgramRefuses : public ::testing::TestWithParam<BadCall> {};

TEST_P(ProgramRefuses, WithExitTwoAndOneLine) {
  const TemporaryDirectory temporary;
  temporary.write("unknown_key.toml", std::string("colour = 1\n") + kTiny);
  temporary.write("two_lines.toml", std::string(kTiny) + "\"a\\nb\" = 1\n");
  temporary.write("wrong_type.toml", std::string(kTiny) + "rest_before_s = \"long\"\n");
  temporary.write("too_high.toml", "name = \"t\"\n[sweep]\nperiods_s = [6.0]\nheights_cm = [900.0]\n");
  temporary.write("no.toml", "name = \n");
  temporary.write("twice.toml", "name = \"t\"\n[sweep]\nperiods_s = [6.0, 6.0]\nheights_cm = [60.0]\n");
  temporary.write("methods_twice.toml",
                  "name = \"t\"\nmethods = [\"harmonic\", \"harmonic\"]\n[sweep]\nperiods_s = "
                  "[6.0]\nheights_cm = [60.0]\n");
  temporary.write("broken_row.csv", "utime,ax,ay,az,gx,gy,gz\n0,0,0,-9.8,0,0,0\n10000,0,0,x,0,0,0\n");
  temporary.write("level.csv", "utime,ax,ay,az,gx,gy,gz\n0,0,0,-9.8,0,0,0\n10000,0,0,-9.8,0,0,0\n");
  temporary.write("no_header.csv", "1,2,3\n");
  temporary.write("truncated.lcm", std::string("\xED\xA1\xDA\x01", 4) + "short");
  temporary.write("heave.csv", "utime,heave_m\n0,1\n0,2\n");
  temporary.write("empty.toml", "");
  temporary.write("negative.csv", "utime,heave_m,heave_sigma_m\n0,1,-1\n");
  std::string seas = "utime,heave_m\n", late = seas;
  for (int row = 0; row < 300; ++row) {
    seas += std::to_string(100000 * row) + "," + std::to_string(row % 7) + "\n";
    late += std::to_string(100000 * row + 1000000000) + "," + std::to_string(row % 7) + "\n";
  }
  temporary.write("seas.csv", seas);
  temporary.write("waves.csv", seas);
  temporary.write("late.csv", late);
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
        BadCall{"UnknownCommandOfACommand", "node estimater",
                "\"estimater\" is no command; expected one of rig-sim, motion"},
        BadCall{"NoOut", "sweep unknown_key.toml", "--out"},
        BadCall{"MissingFile", "sweep nowhere.toml --out out", "nowhere.toml"},
        BadCall{"NotToml", "sweep no.toml --out out", "no.toml:1"},
        BadCall{"UnknownKey", "sweep unknown_key.toml --out out",
                "unknown_key.toml:1: colour = 1: unknown key"},
        BadCall{"KeyOfTwoLines", "sweep two_lines.toml --out out",
                "two_lines.toml:8: sweep.a?b = 1: unknown key"},
        BadCall{"WrongType", "sweep wrong_type.toml --out out",
                "wrong_type.toml:8: sweep.rest_before_s = 'long'"},
        BadCall{"TooHigh", "sweep too_high.toml --out out", "too_high.toml:4: sweep.heights_cm = 900"},
        BadCall{
            "PeriodTwice", "sweep twice.toml --out out",
            "twice.toml:3: sweep.periods_s = [ 6.0, 6.0 ]: expected each value once, 0.01 apart at least"},
        BadCall{"MethodTwice", "sweep methods_twice.toml --out out",
                "methods_twice.toml:2: methods = [ 'harmonic', 'harmonic' ]: expected each name once"},
        BadCall{"BadShard", "sweep too_high.toml --out out --shard 3/2", "--shard 3/2"},
        BadCall{"BrokenRow", "estimate broken_row.csv --out out", "broken_row.csv, line 3, column az: 'x'"},
        BadCall{"TimesInMilliseconds", "estimate milliseconds.csv --out out",
                "milliseconds.csv: column utime: by its times a row every 1e-05 s; expected microseconds"},
        BadCall{"HeaveTimesInSeconds", "evaluate seconds.csv --out out",
                "seconds.csv: column utime: by its times a row every 1e-06 s; expected microseconds"},
        BadCall{"EmptyCampaign", "sweep empty.toml --out out", "empty.toml:1: name is missing"},
        BadCall{"NoHeader", "estimate no_header.csv --out out", "no_header.csv, line 1"},
        BadCall{"TruncatedLog", "estimate truncated.lcm --out out", "truncated.lcm"},
        BadCall{"UnknownMethod", "estimate broken_row.csv --method magic --out out",
                "--method: magic: expected one of lee2014, harmonic, "},
        BadCall{"RestIsNoNumber", "estimate level.csv --rest-seconds abc --out out",
                "--rest-seconds: abc: expected a number of 0 or more"},
        BadCall{"RestIsNaN", "estimate level.csv --rest-seconds nan --out out",
                "--rest-seconds: nan: expected a number of 0 or more"},
        BadCall{"LagIsNaN", "estimate level.csv --method realtime --lag-s nan --out out",
                "--lag-s: nan: expected a number of 0 or more"},
        BadCall{"LagOfAMethodThatKnowsNone", "estimate level.csv --lag-s 2 --out out",
                "method \"smoothed\" cannot be asked to answer late; expected no lag, or one that can: realtime"},
        BadCall{"LagIsTooLong", "estimate level.csv --method realtime --lag-s 600 --out out",
                "realtime: fixed_lag_s = 600.000000 is outside 0 to "},
        BadCall{"GravityIsNaN", "estimate level.csv --gravity nan --out out",
                "--gravity: nan: expected a number from 9.7 to 9.9"},
        BadCall{"GravityIsOfTheMoon", "estimate level.csv --gravity 1.62 --out out",
                "--gravity: 1.62: expected a number from 9.7 to 9.9"},
        BadCall{"DeclinationIsNaN", "estimate level.csv --declination nan --out out",
                "--declination: nan: expected a number from -180 to 180"},
        BadCall{"ZeroLineIsInfinite", "evaluate heave.csv --zero-line-m inf --out out",
                "--zero-line-m: inf: expected a number"},
        BadCall{"FixtureIsNaN", "calibrate accelerometer level.csv --fixture-sigma-deg nan --out out",
                "--fixture-sigma-deg: nan: expected a number from 0 to 10"},
        BadCall{"BeginIsNaN", "film truncated.lcm --begin nan --out out", "--begin: nan: expected a number"},
        BadCall{"SpeedIsZero", "film truncated.lcm --speed 0 --out out",
                "--speed: 0: expected a number above 0"},
        BadCall{"SeedBelowZero", "sweep tiny.toml --seed -1 --out out",
                "--seed: -1: expected a whole number from 0"},
        BadCall{"SeedOfAnAnalysis", "analyse compass --seed -1 --out out",
                "--seed: -1: expected a whole number from 0"},
        BadCall{"OutIsAFile", "estimate level.csv --out level.csv", "--out level.csv: "},
        BadCall{"OutHoldsTheRecording", "estimate heave.csv --out .",
                "--out .: ./heave.csv would take the place of heave.csv"},
        BadCall{"OutHoldsTheTruth", "evaluate seas.csv --truth waves.csv --out .",
                "--out .: ./waves.csv would take the place of waves.csv"},
        BadCall{"OutIsTheRecording", "calibrate accelerometer level.csv --out ./level.csv",
                "--out ./level.csv: is the recording itself"},
        BadCall{"OutIsTheLog", "film truncated.lcm --out truncated.lcm",
                "--out truncated.lcm: is the recording itself"},
        BadCall{"FilmIsADevice", "film truncated.lcm --out /dev/null",
                "--out /dev/null: is no file that another could replace"},
        BadCall{"FilmIsAFolder", "film truncated.lcm --out .", "--out .: is a folder; expected an MP4 file"},
        BadCall{"FilmIsAnAvi", "film truncated.lcm --out rig.avi",
                "--out rig.avi: the film is an MP4 file; expected a name that ends in .mp4"},
        BadCall{"NotSixPositions", "calibrate accelerometer level.csv --out out",
                "level.csv: six-position calibration: x up held still for 0 s"},
        BadCall{"NoMagnetometer", "calibrate compass level.csv --out out", "level.csv: no magnetic field"},
        BadCall{"NoCalibration", "estimate level.csv --calibration no.toml --out out", "no.toml"},
        BadCall{"TruthForACampaign", "evaluate . --truth heave.csv --out out", "--truth: . is a directory"},
        BadCall{"NetcdfForACampaign", "evaluate . --netcdf --out out", "--netcdf: . is a directory"},
        BadCall{"DetrendForACampaign", "evaluate . --detrend --out out", "--detrend: . is a directory"},
        BadCall{"DeadBandForACampaign", "evaluate . --dead-band-m 0.1 --out out",
                "--dead-band-m: . is a directory"},
        BadCall{"DeadBandIsNoNumber", "evaluate heave.csv --dead-band-m abc --out out",
                "--dead-band-m: abc: expected a number of 0 or more"},
        BadCall{"DeadBandIsNaN", "evaluate heave.csv --dead-band-m nan --out out",
                "--dead-band-m: nan: expected a number of 0 or more"},
        BadCall{"HighPassBelowZero", "evaluate heave.csv --truth heave.csv --high-pass-hz=-1 --out out",
                "--high-pass-hz: -1: expected a number of 0 or more"},
        BadCall{"HighPassWithoutTruth", "evaluate heave.csv --high-pass-hz 0.1 --out out", "--truth"},
        BadCall{"OthersForAHeave", "evaluate heave.csv --heave a=. --out out",
                "--heave: heave.csv is no directory"},
        BadCall{"OneValueToEachHeave", "evaluate --heave a=. nowhere --out out",
                "--heave: nowhere is no directory"},
        BadCall{"CommaInAName", "evaluate . --heave a,b=. --out out", "--heave a,b=.: name 'a,b'"},
        BadCall{"NameTwice", "evaluate . --heave a=. --heave a=. --out out",
                "--heave a=.: 'a' is given twice"},
        BadCall{"SigmaBelowZero", "evaluate negative.csv --out out",
                "negative.csv, line 2, column heave_sigma_m: '-1'; expected a number of 0 or more"},
        BadCall{"TruthOfAnotherTime", "evaluate seas.csv --truth late.csv --out out",
                "seas.csv against late.csv: heave and truth: they do not overlap"},
        BadCall{"TimeStandsStill", "evaluate heave.csv --out out", "heave.csv, line 3, column utime"}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace waverig
