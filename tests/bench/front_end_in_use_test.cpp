// The bench's calibration file in use: the acquisition applies it, and waves come out better.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"
#include "rig/acquisition/calibration_run.h"
#include "rig/bench/bench.h"
#include "rig/campaign/settings.h"
#include "rig/campaign/sweep.h"
#include "tests/bench/short_sequence.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

// Exact sensors on the front end that the data sheet allows: what is left is the converter's.
UnitSettings exact_sensors() {
  UnitSettings settings = ideal_unit();
  settings.front_end = datasheet_unit().front_end;
  settings.temperature = laboratory_temperature();
  return settings;
}

// rig/sequences/sensor_unit.toml over the real transports, with shorter recordings.
estimator::FrontEndCalibration calibrate_on_the_bench(const UnitSettings& settings, const UnitParameters& unit) {
  const ShortSequence files("sensor_unit.toml", {{"duration = \"100 s\"", "duration = \"20 s\""}});
  const Sequence sequence = load_sequence(files.file());
  BenchOptions options;
  options.out = files.out();
  options.simulate = true;
  options.simulation.world.converter.assign(unit.converter.begin(), unit.converter.end());
  options.simulation.world.master_clock_error = settings.front_end.master_clock_error;
  EXPECT_EQ(run_bench(sequence, options).outcome, "done");
  return analyse(sequence, Store::open(store_file(files.out()))).calibration;
}

// Level, up and down with that amplitude and period: what one wave height is wrong by, relative.
double height_error(const UnitSettings& settings, const UnitParameters& unit, Acquisition acquisition) {
  constexpr double kPeriod_s = 6, kAmplitude_m = 1, kStep_s = 2e-3, kOmega = 2 * std::numbers::pi / kPeriod_s;
  SimulatedUnit sensor(settings, unit, 3);
  std::vector<std::uint8_t> bytes;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  BodyMotion motion;
  for (int n = 0; n <= std::lround(10 * kPeriod_s / kStep_s); ++n) {
    const double t = n * kStep_s;
    motion.utime = n * 2000;
    motion.acceleration_N = {0, 0, kAmplitude_m * kOmega * kOmega * std::cos(kOmega * t)};
    sensor.step(motion, n == 0 ? 0 : kStep_s, bytes);
    acquisition.add(bytes, [&](const UnitCounts& counts, const estimator::ImuSample& sample) {
      const double at = kOmega * static_cast<double>(counts.utime) * kMicrosecond;
      const Eigen::Vector3d row(std::cos(at), std::sin(at), 1);
      normal += row * row.transpose();
      right += row * sample.f_B.z();
    });
    bytes.clear();
  }
  const Eigen::Vector3d fit = normal.ldlt().solve(right);
  return std::hypot(fit[0], fit[1]) / (kAmplitude_m * kOmega * kOmega) - 1;
}

TEST(FrontEndInUse, WaveHeightsLoseTheUnevennessOfTheResetCurrents) {
  const UnitSettings settings = exact_sensors();
  double without = 0, with = 0;
  constexpr int kUnits = 4;
  for (std::uint64_t seed = 1; seed <= kUnits; ++seed) {
    const UnitParameters unit = draw_unit(settings, seed);
    const Sensitivities nominal = nominal_sensitivities(settings);
    CalibrationRunSettings six;
    six.fixture_sigma_rad = 1e-7;
    const auto error = [&] {
      Acquisition acquisition(nominal);
      if (six.front_end) acquisition.apply(*six.front_end);
      const CalibrationRun run = run_six_positions(settings, unit, nominal, kStandardGravity, seed, six);
      acquisition.apply(run.calibration.accelerometer, run.calibration.gyroscope);
      return height_error(settings, unit, acquisition);
    };
    without += std::pow(error(), 2) / kUnits;
    six.front_end = FrontEndChoice{.calibration = calibrate_on_the_bench(settings, unit)};
    with += std::pow(error(), 2) / kUnits;
  }
  RecordProperty("height_error_without_ppm", std::to_string(1e6 * std::sqrt(without)));
  RecordProperty("height_error_with_ppm", std::to_string(1e6 * std::sqrt(with)));
  EXPECT_GT(std::sqrt(without), 100e-6);
  EXPECT_LT(std::sqrt(with), 0.2 * std::sqrt(without));
}

TEST(FrontEndInUse, ACampaignNamesTheCalibrationFile) {
  const TemporaryDirectory directory;
  const std::string campaign =
      "name = \"t\"\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 30.0\nrepeats = 1\nramp_periods = 1\n[calibration]\n";
  estimator::FrontEndCalibration calibration;
  for (const char* name : {"accel_1", "accel_2", "accel_3"}) {
    estimator::FrontEndChannel& channel = calibration.channels.emplace_back();
    channel.name = name;
    channel.K_N0_C = channel.K_P0_C = 94.53125e-9;
  }
  estimator::save(calibration, directory / "found.json");
  directory.write("good.toml", campaign + "front_end = \"found.json\"\n");
  const Campaign read = read_campaign(directory / "good.toml");
  ASSERT_TRUE(read.settings.calibration.front_end.has_value());
  EXPECT_NE(read.resolved.find(kFrontEndFile), std::string::npos);   // where the results keep it
  EXPECT_TRUE(calibrate(read.settings).unit.front_end.has_value());

  directory.write("channel.toml", campaign + "front_end = \"found.json\"\nfront_end_channels = [\"accel_1\", \"accel_2\", \"gyro_1\"]\n");
  directory.write("missing.toml", campaign + "front_end = \"lost.json\"\n");
  for (const auto& [file, expected] : {std::pair{"channel.toml", "accel_1, accel_2, accel_3"}, {"missing.toml", "lost.json"}}) {
    try {
      read_campaign(directory / file);
      ADD_FAILURE() << "took " << file;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace waverig::rig::bench
