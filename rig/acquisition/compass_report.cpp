#include "estimator/calibration/readable_json.h"
#include "rig/acquisition/compass_run.h"

namespace waverig::rig {

std::string with_compass_report(const std::string& calibration_json, const CompassRun& run,
                                const MagnetometerParameters& truth, const EarthFieldSettings& earth) {
  using nlohmann::ordered_json;
  const auto list = [](const auto& v) { return ordered_json{v[0], v[1], v[2]}; };
  const auto rows = [&](const Matrix3d& m) {
    return ordered_json{list(m.row(0)), list(m.row(1)), list(m.row(2))};
  };
  ordered_json j = ordered_json::parse(calibration_json);
  ordered_json& turns = j["compass_turns"];
  turns["readings"] = run.raw_uT.size();
  turns["north_deg"] = run.north_rad / kDegree;
  for (const estimator::CompassCalibration* of : {&run.max_min, &run.ellipsoid}) {
    ordered_json& c = turns[of->method];
    c["gain_puT"] = rows(of->correction.gain);
    c["offset_uT"] = list(of->correction.offset);
    c["dip_deg"] = of->dip_rad / kDegree;
    c["norm_relative_std"] = of->residual.relative_std;
    c["norm_relative_largest"] = of->residual.relative_largest;
    c["error_offset_uT"] = list(Vector3d(of->correction.offset - truth.hard_iron_uT));
    c["error_heading_level_rms_deg"] = level_heading_error_rad(of->correction, truth, earth) / kDegree;
  }
  ordered_json& t = turns["simulated_truth"];
  t["soft_iron"] = rows(truth.soft_iron);
  t["hard_iron_uT"] = list(truth.hard_iron_uT);
  t["field_uT"] = earth.total_uT;
  t["dip_deg"] = earth.dip_rad / kDegree;
  t["uncalibrated_heading_level_rms_deg"] = level_heading_error_rad({}, truth, earth) / kDegree;
  return estimator::readable_json(j);
}

}  // namespace waverig::rig
