#include "estimator/calibration/readable_json.h"
#include "rig/acquisition/calibration_run.h"
#include "rig/mechanism/static_pose.h"

namespace waverig::rig {

std::string calibration_report(const CalibrationRun& run, const estimator::AccelerometerCalibration& truth) {
  using nlohmann::ordered_json;
  const estimator::AccelerometerCalibration& found = run.calibration.accelerometer;
  const auto list = [](const auto& v) {
    ordered_json out = ordered_json::array();
    for (Eigen::Index i = 0; i < v.size(); ++i) out.push_back(v[i]);
    return out;
  };
  const auto rows = [&](const Matrix3d& m) {
    return ordered_json{list(m.row(0)), list(m.row(1)), list(m.row(2))};
  };
  ordered_json j = ordered_json::parse(to_json(run.calibration));

  // 1. The simulated truth, and how far off the result is in units of its own uncertainty.
  const estimator::CalibrationError error = error_against(found, truth);
  ordered_json& t = j["simulated_truth"];
  t["M"] = rows(truth.M);
  t["b_mps2"] = list(truth.b_mps2);
  t["quadratic_pmps2"] = list(truth.quadratic_pmps2);
  t["error_over_sigma"] = list(error.over_sigma);
  t["chi_square"] = error.chi_square;
  t["degrees_of_freedom"] = error.degrees_of_freedom;

  // 2. The document's linear fit of the same readings.
  ordered_json& linear = j["linear_fit"];
  linear["M"] = rows(run.linear_fit.calibration.M);
  linear["b_mps2"] = list(run.linear_fit.calibration.b_mps2);
  linear["residual_rms_mps2"] = run.linear_fit.residual_rms_mps2;
  linear["chi_square"] = run.linear_fit.chi_square;
  linear["degrees_of_freedom"] = run.linear_fit.degrees_of_freedom;

  // 3. What was read, Lee 2014, Table 1.
  for (std::size_t k = 0; k < 6; ++k) {
    ordered_json& position = j["positions"][k];
    position["name"] = kSixPositions[k].name;
    position["reading_g"] = list(Vector3d(run.readings[k].mean_mps2 / kStandardGravity));
    position["residual_mps2"] = list(run.fit.residual_mps2[k]);
  }
  return estimator::readable_json(j);
}

}  // namespace waverig::rig
