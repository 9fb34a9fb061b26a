#include "rig/campaign/sensor_unit.h"

#include <cmath>

#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

// Of q f^2 + c f^3, whose largest deviations from a straight line over +-R are drawn with the sheet's sigma: the slope at
// -g against the chord from -g to g is off by -2 q g + 2 c g^2, with q = 4 x / R and c = 8 x / R^2.
double slope_sigma(const AccelerometerSettings& sheet, double gravity_mps2) {
  if (sheet.range_mps2 <= 0) return 0;
  const double k = gravity_mps2 / sheet.range_mps2;
  return sheet.nonlinearity_sigma * std::hypot(8 * k, 16 * k * k);
}

}  // namespace

UnitSettings unit_settings(const CampaignSettings& campaign) {
  UnitSettings unit = datasheet_unit();
  unit.accelerometer = mma7331lc();
  unit.gyroscope = fxas21000(campaign.sensor.gyroscope_range_degps);
  unit.earth = local_earth(campaign.place);
  unit.power_up_utime = campaign.start_utime;
  return unit;
}

UnitParameters fresh_unit(const CampaignSettings& campaign) {
  return draw_unit(unit_settings(campaign), derived_seed(campaign.seed, "unit"));
}

UnitParameters tested_unit(const CampaignSettings& campaign) {
  const UnitParameters unit = fresh_unit(campaign);
  return campaign.sensor.aged ? aged(unit, AgeingSettings{}, derived_seed(campaign.seed, "ageing")) : unit;
}

estimator::SensorKnowledge sensor_knowledge(const CampaignSettings& campaign,
                                            const estimator::SensorCalibration& calibration) {
  const UnitSettings unit = unit_settings(campaign);
  const AccelerometerSettings& sheet = unit.accelerometer;
  const AgeingSettings age = campaign.sensor.aged ? AgeingSettings{} : AgeingSettings{0, 0, 0, 0};
  const Matrix3d M = calibration.accelerometer.sigma_M();
  const double temperature_span_degC = std::abs(unit.temperature.amplitude_degC) + std::abs(unit.temperature.warm_up_degC);
  const double scale_now = std::sqrt(M.diagonal().squaredNorm() / 3);
  const double misalignment_now = std::sqrt((M.squaredNorm() - M.diagonal().squaredNorm()) / 6);
  const double bias_now = std::sqrt(calibration.accelerometer.sigma_b_mps2().squaredNorm() / 3);
  const double offset_now = std::sqrt(calibration.gyroscope.offset_sigma_radps.squaredNorm() / 3);

  estimator::SensorKnowledge known = campaign.estimator.sensor;
  known.accel_bias_sigma_mps2 = std::hypot(
      std::hypot(bias_now, sheet.instability_sigma_mps2, sheet.bias_drift_sigma_mps2pdegC * temperature_span_degC),
      age.accel_bias_mps2);
  known.accel_scale_sigma =
      std::hypot(scale_now, sheet.scale_drift_sigma_pdegC * temperature_span_degC, age.accel_scale);
  known.accel_misalignment_sigma_rad = std::hypot(misalignment_now, age.accel_misalignment);
  known.accel_slope_sigma = slope_sigma(sheet, known.gravity_mps2);
  known.gyro_bias_sigma_radps = std::hypot(offset_now, unit.gyroscope.instability_sigma_radps, age.gyro_offset_radps);
  return known;
}

}  // namespace waverig::rig
