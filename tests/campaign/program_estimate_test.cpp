// The program's commands about recordings: estimate and calibrate.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>
#include <waverig/imu_t.hpp>

#include "estimator/calibration/accelerometer_calibration.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/event_log.h"
#include "motion/kinematics/random.h"
#include "tests/campaign/program.h"

namespace waverig {
namespace {

TEST(Program, EstimatesARecordedRunAsTheSweepDid) {
  const TemporaryDirectory temporary;
  temporary.write("tiny.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep tiny.toml --out out").status, 0);
  const Outcome outcome =
      run(temporary, "estimate out/runs/T04.00s_H050.0cm_r1.lcm --method harmonic --out again");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::size_t at = outcome.out.find("\"h13_m\":");
  ASSERT_NE(at, std::string::npos) << outcome.out;
  EXPECT_NEAR(std::stod(outcome.out.substr(at + 8)), 0.5, 0.02)
      << "of the steady waves: the ramps' are lower";
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
    EXPECT_GT(number_in(poor.out, "expanded_uncertainty_m"),
              1.5 * number_in(good.out, "expanded_uncertainty_m"))
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
  const Outcome outcome = run(temporary,
                              "estimate wave.csv --method realtime --calibration unit.json --gravity 9.81 "
                              "--rest-seconds 0.5 --out out");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string summary = bytes_of(temporary / "out/summary.json");
  EXPECT_EQ(summary, outcome.out);
  const std::string version = run(temporary, "--version").out;  // "waverig X\n"
  const std::string sum = run(temporary, "--version >/dev/null; sha256sum wave.csv").out.substr(0, 64);
  for (const std::string& expected :
       {std::string("\"method\": \"realtime\""), std::string("\"sea_state_method\": \"spectral\""),
        "\"version\": \"" + version.substr(8, version.size() - 9) + "\"",
        std::string("\"input\": \"wave.csv\""), "\"input_sha256\": \"" + sum + "\"",
        std::string("\"calibration\": \"unit.json\""), std::string("\"gravity_mps2\": 9.81"),
        std::string("\"rest_s\": 0.5"), std::string("\"samples\": 12000"), std::string("\"begin_utime\": 0"),
        std::string("\"end_utime\": 119990000")})
    EXPECT_NE(summary.find(expected), std::string::npos) << expected << "\n" << summary;
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

TEST(Program, AnEarlierEvaluationIsReplacedAsAWhole) {
  const TemporaryDirectory temporary;
  std::string csv = "utime,heave_m\n";
  for (int i = 0; i < 3000; ++i)
    csv += std::to_string(200000 * i) + "," + std::to_string(std::sin(0.2 * i)) + "\n";
  temporary.write("heave.csv", csv);
  EXPECT_EQ(run(temporary, "evaluate heave.csv --out out --netcdf").status, 0);
  EXPECT_TRUE(std::filesystem::exists(temporary / "out/record.nc"));
  EXPECT_EQ(run(temporary, "evaluate heave.csv --out out").status, 0);
  EXPECT_FALSE(std::filesystem::exists(temporary / "out/record.nc")) << "of the earlier call";
}

TEST(Program, KeepsAnEarlierEvaluationWhereTheDiskIsFull) {
  const TemporaryDirectory temporary;
  std::string csv = "utime,heave_m\n";
  for (int i = 0; i < 3000; ++i)
    csv += std::to_string(200000 * i) + "," + std::to_string(std::sin(0.2 * i)) + "\n";
  temporary.write("heave.csv", csv);
  ASSERT_EQ(run(temporary, "evaluate heave.csv --out out --netcdf").status, 0);
  const std::string record = bytes_of(temporary / "out/record.nc"), summary = bytes_of(temporary / "out/summary.json");
  for (const std::string blocks : {"1", "30", "60"}) {
    const Outcome full = run(temporary, "--version >/dev/null; ulimit -f " + blocks + "; trap '' XFSZ; " WAVERIG_PROGRAM
                                        " evaluate heave.csv --out out --netcdf");
    EXPECT_EQ(full.status, 1) << blocks << full.err;
    EXPECT_NE(full.err.find("not everything could be written: File too large"), std::string::npos) << full.err;
    EXPECT_EQ(bytes_of(temporary / "out/record.nc"), record);
    EXPECT_EQ(bytes_of(temporary / "out/summary.json"), summary);
    const auto left = std::filesystem::directory_iterator(temporary / "out");
    EXPECT_EQ(std::distance(begin(left), end(left)), 3) << blocks;
  }
}

TEST(Program, AFullDiskLeavesNoHalfAnalysisAndNoHalfFilm) {
  const TemporaryDirectory temporary;
  temporary.write("c.toml", kTiny);
  ASSERT_EQ(run(temporary, "sweep c.toml --out done").status, 0);
  for (const std::string command : {"analyse compass --runs 2 --out full/compass",
                                    "film done/runs/T04.00s_H050.0cm_r1.lcm --seconds 1 --out full/rig.mp4"}) {
    std::filesystem::create_directories(temporary / "full");
    const Outcome full =
        run(temporary, "--version >/dev/null; ulimit -f 4; trap '' XFSZ; " WAVERIG_PROGRAM " " + command);
    EXPECT_EQ(full.status, 1) << command << full.err;
    EXPECT_NE(full.err.find("File too large"), std::string::npos) << full.err;
    EXPECT_TRUE(std::filesystem::is_empty(temporary / "full")) << command;
  }
}

TEST(Program, KeepsAnEarlierCalibrationWhereThePlaceCannotBeWritten) {
  const TemporaryDirectory temporary;
  temporary.write("sides.csv", six_sides(0.25));
  std::filesystem::create_directories(temporary / "kept/unit.json");
  const Outcome refused = run(temporary, "calibrate accelerometer sides.csv --out kept/unit.json");
  EXPECT_EQ(refused.status, 2) << refused.err;
  EXPECT_NE(refused.err.find("kept/unit.json: cannot be written: Is a directory"), std::string::npos)
      << refused.err;
  for (const auto& file : std::filesystem::directory_iterator(temporary / "kept"))
    EXPECT_EQ(file.path().filename(), "unit.json");
  temporary.write("unit7.json", "the one before");
  const Outcome full = run(temporary, "--version >/dev/null; ulimit -f 2; trap '' XFSZ; " WAVERIG_PROGRAM
                                      " calibrate accelerometer sides.csv --out unit7.json");
  EXPECT_EQ(full.status, 1) << full.err;
  EXPECT_NE(full.err.find("unit7.json: not everything could be written: File too large"), std::string::npos)
      << full.err;
  EXPECT_EQ(bytes_of(temporary / "unit7.json"), "the one before");
}

// Angular rates in degrees per second, the whole record beyond what is plausible.
TEST(Program, RefusesARecordingOfWhichEverySampleWasLeftOut) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  std::string degrees = "utime,ax,ay,az,gx,gy,gz\n";
  for (int row = 0; row < 1000; ++row)
    degrees += std::to_string(20000 * row) + ",0,0," + std::to_string(-9.8 + 0.001 * (row % 7)) + ",400,0,0\n";
  temporary.write("degrees.csv", degrees);
  ASSERT_EQ(run(temporary, "estimate wave.csv --out out").status, 0);
  const std::string summary = bytes_of(temporary / "out/summary.json"),
                    heave = bytes_of(temporary / "out/heave.csv");
  const Outcome refused = run(temporary, "estimate degrees.csv --out out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.out, "");
  EXPECT_EQ(refused.err,
            "waverig: degrees.csv: 1000 of 1000 samples left out: 1000 not finite or beyond what is plausible; "
            "expected samples in m/s^2 and rad/s, nothing is told from these\n");
  EXPECT_EQ(bytes_of(temporary / "out/summary.json"), summary);
  EXPECT_EQ(bytes_of(temporary / "out/heave.csv"), heave);
}

// 2 degrees of tilt at 4 s: 3 deg/s is plausible in rad/s, but for the accelerometer, which sees the tilt itself.
TEST(Program, RefusesAGyroscopeInDegrees) {
  const TemporaryDirectory temporary;
  const double amplitude = 2 * kDegree, omega = 2 * std::numbers::pi / 4;
  for (const double unit : {1.0, 1 / kDegree}) {
    std::string rows = "utime,ax,ay,az,gx,gy,gz\n";
    for (int row = 0; row < 6000; ++row) {
      const double t = 0.02 * row, roll = amplitude * std::sin(omega * t),
                   rate = unit * amplitude * omega * std::cos(omega * t),
                   down = -9.8 + 0.5 * std::sin(omega * t + 1);
      rows += std::to_string(20000 * row) + ",0," + std::to_string(down * std::sin(roll)) + "," +
              std::to_string(down * std::cos(roll)) + "," + std::to_string(rate) + ",0,0\n";
    }
    temporary.write("tilting.csv", rows);
    const Outcome outcome = run(temporary, "estimate tilting.csv --out out");
    if (unit == 1) {
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      continue;
    }
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err,
              "waverig: tilting.csv: by its gyroscope the unit turns at 2.2 rad/s (rms), by its accelerometer at "
              "0.04; expected rates in rad/s about the accelerometer's axes (are they in degrees?)\n");
  }
}

// A heave.csv of the one beside a waves.csv of the other would be nobody's result.
TEST(Program, WritesIntoNoFolderThatAnotherProgramIsAtWorkIn) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  ASSERT_EQ(run(temporary, "estimate wave.csv --out out").status, 0);
  const std::string summary = bytes_of(temporary / "out/summary.json");
  for (const char* call : {"estimate wave.csv --method lee2014 --out out", "evaluate out/heave.csv --out out"}) {
    const Outcome held =
        run(temporary, std::string("--version >/dev/null; flock out " WAVERIG_PROGRAM " ") + call);
    EXPECT_EQ(held.status, 2) << call;
    EXPECT_EQ(held.err, "waverig: --out out: another waverig is at work in it; expected another directory\n");
  }
  EXPECT_EQ(bytes_of(temporary / "out/summary.json"), summary);
  EXPECT_EQ(run(temporary, "estimate wave.csv --method lee2014 --out out").status, 0);
}

// One sample that is not a number is left out; it does not hide that the others are in g.
TEST(Program, SeesTheUnitsOfALogWithASampleThatIsNoNumber) {
  const TemporaryDirectory temporary;
  EventLogWriter writer(temporary / "g.lcm");
  imu_t m{};
  std::vector<std::uint8_t> data(static_cast<std::size_t>(m.getEncodedSize()));
  for (m.seq = 0; m.seq < 1000; ++m.seq) {
    m.utime = 20000 * m.seq;
    m.accel_mps2[2] = m.seq == 500 ? std::nan("") : -1 + 0.001 * static_cast<double>(m.seq % 7);
    m.encode(data.data(), 0, m.getEncodedSize());
    writer.write(m.utime, channel::kImu, data.data(), data.size());
  }
  writer.close();
  const Outcome refused = run(temporary, "estimate g.lcm --out out");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("g.lcm: the mean specific force is 0.997; expected about 9.81"), std::string::npos)
      << refused.err;
}

// Nor does one that is left out as no reading, however large.
TEST(Program, EstimatesARecordingWithOneSampleBeyondAllReason) {
  const TemporaryDirectory temporary;
  std::string record = wave_record();
  const std::size_t row = record.find("\n50000000,0,");
  ASSERT_NE(row, std::string::npos);
  record.replace(row, 12, "\n50000000,1e308,");
  temporary.write("wave.csv", record);
  const Outcome outcome = run(temporary, "estimate wave.csv --out out");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err,
            "waverig: wave.csv: 1 of 12000 samples left out: 1 not finite or beyond what is plausible; 1 gap in the "
            "times, 0.01 s in all\n");
  EXPECT_NEAR(number_in(outcome.out, "mean_height_m"), 1, 0.01);
}

// Every sample three times, as a gateway that repeats itself: the series of heave grows in time all the same.
TEST(Program, TellsHeaveInOrderOfTimeWhereSamplesComeAgain) {
  const TemporaryDirectory temporary;
  const auto record = [&](const std::string& name, int times) {
    EventLogWriter writer(temporary / name);
    imu_t m{};
    std::vector<std::uint8_t> data(static_cast<std::size_t>(m.getEncodedSize()));
    for (m.seq = 0; m.seq < 12000; ++m.seq) {
      m.utime = 10000 * m.seq;
      m.accel_mps2[2] = -9.80665 + 1.2337 * std::cos(2 * std::numbers::pi * static_cast<double>(m.seq) / 400);
      m.encode(data.data(), 0, m.getEncodedSize());
      for (int i = 0; i < times; ++i) writer.write(m.utime, channel::kImu, data.data(), data.size());
    }
    writer.close();
  };
  record("once.lcm", 1);
  record("thrice.lcm", 3);
  for (const std::string method : {"harmonic", "lee2014"}) {
    const Outcome once = run(temporary, "estimate once.lcm --out once --method " + method);
    const Outcome thrice = run(temporary, "--version >/dev/null; ulimit -t 60; ulimit -v 4000000; " WAVERIG_PROGRAM
                                          " estimate thrice.lcm --netcdf --out thrice --method " + method);
    ASSERT_EQ(thrice.status, 0) << method << thrice.err;
    EXPECT_GT(number_in(thrice.out, "waves"), 20) << method;
    EXPECT_EQ(bytes_of(temporary / "thrice/heave.csv"), bytes_of(temporary / "once/heave.csv")) << method;
    const Outcome again = run(temporary, "evaluate thrice/heave.csv --out again");
    EXPECT_EQ(again.status, 0) << method << again.err;
  }
}

// Five minutes of noise about gravity: millimetres of heave that cross their zero line, which the methods know for
// noise. Counted by whoever asks for it they carry the heave's own sigma, which is larger than they are.
TEST(Program, TellsNoWavesOfASensorAtRest) {
  const TemporaryDirectory temporary;
  std::string rest = "utime,ax,ay,az,gx,gy,gz\n";
  RandomStream random(1, "rest");
  for (int row = 0; row < 30000; ++row) {
    rest += std::to_string(row * 10000);
    for (const double mean : {0.0, 0.0, -9.80665})
      rest.append(",").append(std::to_string(mean + random.gaussian(0.0245)));
    for (int axis = 0; axis < 3; ++axis) rest.append(",").append(std::to_string(random.gaussian(0.002)));
    rest += "\n";
  }
  temporary.write("rest.csv", rest);
  for (const std::string method : {"smoothed", "spectral"}) {
    const Outcome outcome = run(temporary, "estimate rest.csv --out out --method " + method);
    ASSERT_EQ(outcome.status, 0) << method << outcome.err;
    EXPECT_EQ(number_in(outcome.out, "waves"), 0) << method << outcome.out;
    EXPECT_NE(outcome.out.find("too_few_waves"), std::string::npos) << method << outcome.out;
    EXPECT_EQ(bytes_of(temporary / "out/waves.csv").find('\n') + 1, bytes_of(temporary / "out/waves.csv").size());
  }
  const Outcome counted = run(temporary, "evaluate out/heave.csv --out counted");
  EXPECT_GT(number_in(counted.out, "waves"), 20);
  EXPECT_GT(number_in(counted.out, "expanded_uncertainty_m"), number_in(counted.out, "mean_height_m")) << counted.out;
}

// A gyroscope that reads 0.05 rad/s too much, and in its rest one reading beyond all reason, one that is no number and
// one a day ahead: heave as without them.
TEST(Program, TakesTheBiasAtRestFromUsableSamplesAlone) {
  const TemporaryDirectory temporary;
  const auto record = [&](const std::string& name, bool spoiled) {
    EventLogWriter writer(temporary / name);
    imu_t m{};
    std::vector<std::uint8_t> data(static_cast<std::size_t>(m.getEncodedSize()));
    RandomStream random(1, "rest");
    for (m.seq = 0; m.seq < 12000; ++m.seq) {
      const double t_s = 0.01 * static_cast<double>(m.seq);
      m.utime = 10000 * m.seq + (spoiled && m.seq == 300 ? 86'400'000'000 : 0);
      m.accel_mps2[2] = -9.80665 + random.gaussian(0.01) + (t_s < 5 ? 0 : 1.2337 * std::sin(std::numbers::pi / 2 * (t_s - 5)));
      m.gyro_radps[0] = spoiled && m.seq == 100 ? 1e30 : spoiled && m.seq == 200 ? std::nan("") : 0.05;
      m.encode(data.data(), 0, m.getEncodedSize());
      writer.write(10000 * m.seq, channel::kImu, data.data(), data.size());
    }
    writer.close();
  };
  record("sound.lcm", false);
  record("spoiled.lcm", true);
  const Outcome sound = run(temporary, "estimate sound.lcm --rest-seconds 5 --out sound"),
                spoiled = run(temporary, "estimate spoiled.lcm --rest-seconds 5 --out spoiled");
  ASSERT_EQ(sound.status, 0) << sound.err;
  ASSERT_EQ(spoiled.status, 0) << spoiled.err;
  EXPECT_EQ(number_in(spoiled.out, "samples_left_out"), 3) << spoiled.out;
  EXPECT_EQ(number_in(spoiled.out, "waves"), number_in(sound.out, "waves"));
  EXPECT_NEAR(number_in(spoiled.out, "mean_height_m"), number_in(sound.out, "mean_height_m"), 1e-3);
  EXPECT_NEAR(number_in(sound.out, "mean_height_m"), 1, 0.02);
  const Outcome brief = run(temporary, "estimate spoiled.lcm --rest-seconds 200 --out brief");
  EXPECT_EQ(brief.status, 2);
  EXPECT_EQ(brief.err, "waverig: spoiled.lcm: usable samples for 120.0 s; expected more than --rest-seconds 200\n");
}

// A minute into the record, which is row 6000.
TEST(Program, TellsHeaveOfRealtimeWithLessUncertaintyWhereItMayWait) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  const auto sigma_m = [&](const std::string& lag) {
    const Outcome outcome = run(temporary, "estimate wave.csv --method realtime " + lag + " --out out");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string heave = bytes_of(temporary / "out/heave.csv");
    const std::size_t row = heave.find("\n60000000,");
    EXPECT_NE(row, std::string::npos);
    return std::stod(heave.substr(heave.find(',', row + 11) + 1));
  };
  const double at_once_m = sigma_m(""), late_m = sigma_m("--lag-s 2");
  EXPECT_EQ(number_in(bytes_of(temporary / "out/summary.json"), "lag_s"), 2);
  EXPECT_GT(late_m, 0);
  EXPECT_LT(late_m, 0.8 * at_once_m);
}

TEST(Program, KeepsAnEarlierEstimateWhereTheNextFails) {
  const TemporaryDirectory temporary;
  temporary.write("wave.csv", wave_record());
  temporary.write("broken.csv", wave_record() + "120000000,0,0,x,0,0,0\n");
  ASSERT_EQ(run(temporary, "estimate wave.csv --out out").status, 0);
  const std::string summary = bytes_of(temporary / "out/summary.json"),
                    heave = bytes_of(temporary / "out/heave.csv");
  EXPECT_EQ(run(temporary, "estimate broken.csv --out out").status, 2);
  EXPECT_EQ(bytes_of(temporary / "out/summary.json"), summary);
  EXPECT_EQ(bytes_of(temporary / "out/heave.csv"), heave);
}

}  // namespace
}  // namespace waverig
