#include "rig/campaign/sensor_unit.h"

#include <cmath>
#include <optional>

#include "motion/kinematics/random.h"
#include "rig/acquisition/calibration_run.h"

namespace waverig::rig {
namespace {

std::optional<MagnetometerSettings> magnetometer_settings(const CampaignSettings& campaign) {
  const SensorChoice& sensor = campaign.sensor;
  if (sensor.magnetometer == "none") return std::nullopt;
  MagnetometerSettings settings = sensor.magnetometer == "MAG3110" ? mag3110() : hmc5883l();
  settings.hard_iron_sigma_uT = sensor.board_iron_uT.value_or(settings.hard_iron_sigma_uT);
  settings.earth = campaign.magnetic.field;
  if (campaign.sweep.mover == Mover::kArm) settings.motor = motor_field(campaign, campaign.arm.azimuth_rad);
  return settings;
}

}  // namespace

UnitSettings unit_settings(const CampaignSettings& campaign) {
  UnitSettings unit = datasheet_unit();
  unit.accelerometer = mma7331lc();
  unit.gyroscope = fxas21000(campaign.sensor.gyroscope_range_degps);
  unit.magnetometer = magnetometer_settings(campaign);
  unit.earth = local_earth(campaign.rig_place);
  unit.power_up_utime = campaign.start_utime;
  return unit;
}

MotorFieldSettings motor_field(const CampaignSettings& campaign, double azimuth_rad) {
  const MagneticSettings& m = campaign.magnetic;
  const Quaterniond q_NP = quaternion_of({0, 0, azimuth_rad});
  // Positions are told from where the sensor hangs when the arm's tip is at the orbit's centre.
  const Vector3d hub_P(0, -m.motor_distance_m, -campaign.arm.lever_arm_G_m.z());
  return {.hub_N_m = q_NP * hub_P,
          .azimuth_rad = azimuth_rad,
          .stator_moment_N_Am2 = q_NP * m.stator_moment_P_Am2,
          .rotor_moment_Am2 = m.rotor_moment_Am2};
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
  const double temperature_span_degC =
      std::abs(unit.temperature.amplitude_degC) + std::abs(unit.temperature.warm_up_degC);
  estimator::SensorKnowledge known = campaign.estimator.sensor;
  // Zero: the calibration says nothing of it, as one by rotation of a gyroscope that never rested.
  const auto rms = [](double squares, int of, double unsaid) {
    return squares > 0 ? std::sqrt(squares / of) : unsaid;
  };
  const double scale_now = rms(M.diagonal().squaredNorm(), 3, known.accel_scale_sigma);
  const double misalignment_now =
      rms(M.squaredNorm() - M.diagonal().squaredNorm(), 6, known.accel_misalignment_sigma_rad);
  const double bias_now =
      rms(calibration.accelerometer.sigma_b_mps2().squaredNorm(), 3, known.accel_bias_sigma_mps2);
  const double offset_now =
      rms(calibration.gyroscope.offset_sigma_radps.squaredNorm(), 3, known.gyro_bias_sigma_radps);
  known.accel_bias_sigma_mps2 =
      std::hypot(std::hypot(bias_now, sheet.instability_sigma_mps2,
                            sheet.bias_drift_sigma_mps2pdegC * temperature_span_degC),
                 age.accel_bias_mps2);
  known.accel_scale_sigma =
      std::hypot(scale_now, sheet.scale_drift_sigma_pdegC * temperature_span_degC, age.accel_scale);
  known.accel_misalignment_sigma_rad = std::hypot(misalignment_now, age.accel_misalignment);
  known.accel_slope_sigma = slope_sigma(unit, calibration.accelerometer);
  known.gyro_bias_sigma_radps =
      std::hypot(offset_now, unit.gyroscope.instability_sigma_radps, age.gyro_offset_radps);
  return known;
}

}  // namespace waverig::rig
