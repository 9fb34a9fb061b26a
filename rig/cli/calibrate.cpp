// waverig calibrate: a calibration file from a recording of a unit that was turned by hand or laid on its
// sides.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "estimator/calibration/rotation_fit.h"
#include "estimator/calibration/six_position_record.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "rig/cli/commands.h"
#include "rig/cli/number_checks.h"
#include "rig/cli/recording.h"

namespace waverig::cli {
namespace {

constexpr const char* kSixPositionsWay = "six-positions";
constexpr const char* kRotationWay = "rotation";
constexpr const char* kEllipsoidWay = "ellipsoid";
constexpr const char* kMaxMinWay = "max-min";
constexpr double kTurning_radps = 0.1;

struct AccelerometerArguments {
  std::string recording, out, way = kSixPositionsWay, sensor_id = "unnamed";
  double gravity_mps2 = kStandardGravity;
  double fixture_sigma_deg = estimator::SixPositionRecordSettings{}.fixture_sigma_rad / kDegree;
};

estimator::SensorCalibration by_six_positions(const std::vector<estimator::ImuSample>& samples,
                                              const AccelerometerArguments& arguments) {
  estimator::SixPositionRecordSettings settings;
  settings.fixture_sigma_rad = arguments.fixture_sigma_deg * kDegree;
  const auto record = estimator::fit_six_position_record(samples, arguments.gravity_mps2, settings);
  estimator::SensorCalibration calibration;
  calibration.method = "six positions";
  calibration.accelerometer = record.fit.calibration;
  calibration.gyroscope = record.gyroscope;
  calibration.temperature_degC = record.temperature_degC;
  calibration.residual_rms_mps2 = record.fit.residual_rms_mps2;
  calibration.chi_square = record.fit.chi_square;
  calibration.degrees_of_freedom = record.fit.degrees_of_freedom;
  for (std::size_t k = 0; k < record.still_s.size(); ++k)
    fmt::print("{:<8} still for {:.0f} s\n", estimator::kSixPositions[k].name, record.still_s[k]);
  return calibration;
}

estimator::SensorCalibration by_rotation(const std::vector<estimator::ImuSample>& samples,
                                         const AccelerometerArguments& arguments) {
  const auto fit = estimator::fit_rotation(samples, arguments.gravity_mps2);
  estimator::SensorCalibration calibration;
  calibration.method = "rotation";
  calibration.accelerometer = fit.calibration;
  if (fit.gyroscope.offset_radps.allFinite()) calibration.gyroscope = fit.gyroscope;
  calibration.residual_rms_mps2 = fit.residual_rms_mps2;
  fmt::print("{} windows, attitudes cover {:.0f} %; |f| - g before {:.4f}, after {:.4f} m/s^2 rms\n",
             fit.windows, 100 * fit.coverage, fit.residual_before_mps2, fit.residual_rms_mps2);
  return calibration;
}

std::string table_of(const estimator::SensorCalibration& calibration) {
  const auto& [M, b, q, covariance] = calibration.accelerometer;
  const Matrix3d sigma_M = calibration.accelerometer.sigma_M();
  const Vector3d sigma_b = calibration.accelerometer.sigma_b_mps2();
  std::string text =
      "\nM (f_m = M f + b), b in m/s^2, gyroscope's offset in deg/s; standard uncertainties below\n";
  for (int i = 0; i < 3; ++i) {
    text += fmt::format("  {:9.5f} {:9.5f} {:9.5f}   {:9.5f}   {:9.4f}\n", M(i, 0), M(i, 1), M(i, 2), b[i],
                        calibration.gyroscope.offset_radps[i] / kDegree);
    text += fmt::format("  {:9.5f} {:9.5f} {:9.5f}   {:9.5f}   {:9.4f}\n", sigma_M(i, 0), sigma_M(i, 1),
                        sigma_M(i, 2), sigma_b[i], calibration.gyroscope.offset_sigma_radps[i] / kDegree);
  }
  return text;
}

int calibrate_accelerometer(const AccelerometerArguments& arguments) {
  refuse_to_overwrite(arguments.recording, arguments.out);
  const auto samples = all_of(uncalibrated_samples_of(arguments.recording));
  estimator::SensorCalibration calibration;
  try {
    calibration = arguments.way == kRotationWay ? by_rotation(samples, arguments)
                                                : by_six_positions(samples, arguments);
  } catch (const UserError& error) {
    throw UserError(fmt::format("{}: {}", arguments.recording, error.what()));
  }
  calibration.sensor_id = arguments.sensor_id;
  calibration.utime = samples.back().utime;
  calibration.gravity_mps2 = arguments.gravity_mps2;
  estimator::store_calibration(calibration, arguments.out);
  fmt::print("{}\nCalibration: {}\n", table_of(calibration), arguments.out);
  return 0;
}

struct CompassArguments {
  std::string recording, out, base, way = kEllipsoidWay;
};

void print_way(const char* name, const estimator::CompassCalibration& c, bool chosen) {
  fmt::print(
      "{:<10} norm constant within {:.2f} % rms, {:.2f} % at most; field {:.2f} uT, dip {:.2f} deg{}\n", name,
      100 * c.residual.relative_std, 100 * c.residual.relative_largest, c.field_uT, c.dip_rad / kDegree,
      chosen ? "   <- kept" : "");
}

int calibrate_compass(const CompassArguments& arguments) {
  refuse_to_overwrite(arguments.recording, arguments.out);
  estimator::SensorCalibration calibration;
  if (!arguments.base.empty()) calibration = estimator::load_calibration(arguments.base);
  const estimator::AccelerometerCorrection correct(calibration.accelerometer);
  std::vector<Vector3d> raw_uT, f_B;
  SampleSource source =
      arguments.base.empty() ? samples_of(arguments.recording) : uncalibrated_samples_of(arguments.recording);
  for (estimator::ImuSample sample; source(sample);) {
    if ((sample.flags & flag::kNoMagnetometer) != 0 || !sample.m_B_uT.allFinite()) continue;
    if (!raw_uT.empty() && sample.m_B_uT == raw_uT.back()) continue;  // slower than the inertial sensors
    if (sample.w_NB_B.norm() < kTurning_radps) continue;  // a rest would outweigh the attitudes of the turn
    raw_uT.push_back(sample.m_B_uT);
    f_B.push_back(correct(sample.f_B));
  }
  if (raw_uT.empty())
    throw UserError(fmt::format("{}: no magnetic field while the unit turns; expected columns mx,my,mz",
                                arguments.recording));
  try {
    const auto max_min = estimator::max_min_compass(raw_uT, f_B),
               ellipsoid = estimator::ellipsoid_compass(raw_uT, f_B);
    const bool by_ellipsoid = arguments.way == kEllipsoidWay;
    fmt::print("{} readings\n", raw_uT.size());
    print_way(kMaxMinWay, max_min, !by_ellipsoid);
    print_way(kEllipsoidWay, ellipsoid, by_ellipsoid);
    calibration.compass = by_ellipsoid ? ellipsoid : max_min;
  } catch (const UserError& error) {
    throw UserError(fmt::format("{}: {}", arguments.recording, error.what()));
  }
  estimator::store_calibration(calibration, arguments.out);
  fmt::print("Calibration: {}\n", arguments.out);
  return 0;
}

void add_compass(CLI::App& command, Command& chosen) {
  auto arguments = std::make_shared<CompassArguments>();
  CLI::App* compass = command.add_subcommand("compass", "Hard and soft iron of the magnetometer");
  compass
      ->add_option("recording", arguments->recording,
                   "Sample CSV with mx,my,mz, plain or .gz, or LCM event log: the unit turned slowly through "
                   "all attitudes")
      ->required();
  compass->add_option("--out", arguments->out, "Calibration file to write (JSON)")->required();
  compass->add_option("--base", arguments->base, "Calibration file of the same unit, kept and completed");
  compass->add_option("--from", arguments->way, "ellipsoid: full fit; max-min: Cho's method, eq. (8)")
      ->check(CLI::IsMember({kEllipsoidWay, kMaxMinWay}))
      ->capture_default_str();
  compass->footer(
      "Example:\n  waverig calibrate compass turned.csv.gz --base unit7.json --out unit7-compass.json");
  compass->callback([arguments, &chosen] { chosen = [arguments] { return calibrate_compass(*arguments); }; });
}

}  // namespace

void add_calibrate(CLI::App& app, Command& chosen) {
  CLI::App* command = app.add_subcommand(
      "calibrate", "A calibration file from a recording of a turned unit, or from a bench run");
  command->require_subcommand(1);
  auto arguments = std::make_shared<AccelerometerArguments>();
  CLI::App* accelerometer = command->add_subcommand(
      "accelerometer", "Scale, misalignment and bias; the gyroscope's offset beside them");
  accelerometer->add_option("recording", arguments->recording, "Sample CSV, plain or .gz, or LCM event log")
      ->required();
  accelerometer->add_option("--out", arguments->out, "Calibration file to write (JSON)")->required();
  accelerometer
      ->add_option("--from", arguments->way,
                   "six-positions: laid still on each of six sides, in any order, 5 s or more each; "
                   "rotation: turned slowly through many attitudes")
      ->check(CLI::IsMember({kSixPositionsWay, kRotationWay}))
      ->capture_default_str();
  accelerometer->add_option("--gravity", arguments->gravity_mps2, "Local gravity, m/s^2")
      ->check(between(9.7, 9.9))
      ->capture_default_str();
  accelerometer
      ->add_option("--fixture-sigma-deg", arguments->fixture_sigma_deg,
                   "How exactly the sides stand upright, standard uncertainty")
      ->check(between(0.0, 10.0))
      ->capture_default_str();
  accelerometer->add_option("--sensor", arguments->sensor_id, "Name or serial number, kept in the file");
  accelerometer->footer(
      "Examples:\n"
      "  waverig calibrate accelerometer six-sides.csv --sensor unit7 --out unit7.json\n"
      "  waverig calibrate accelerometer turned.csv.gz --from rotation --out unit7.json\n"
      "  waverig estimate recording.csv.gz --calibration unit7.json --out results/mine");
  accelerometer->callback(
      [arguments, &chosen] { chosen = [arguments] { return calibrate_accelerometer(*arguments); }; });
  add_compass(*command, chosen);
  add_calibrate_front_end(*command, chosen);
  command->footer(
      "Examples:\n  waverig calibrate accelerometer six-sides.csv --out unit7.json\n"
      "  waverig calibrate front-end results/scale --out unit7-front-end.json");
}

}  // namespace waverig::cli
