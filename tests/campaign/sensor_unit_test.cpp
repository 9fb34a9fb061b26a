#include "rig/campaign/sensor_unit.h"

#include <gtest/gtest.h>

namespace waverig::rig {
namespace {

TEST(SensorKnowledge, IsWhatTheCalibrationSaysOfItselfAndNeverLess) {
  estimator::SensorCalibration calibration;
  calibration.accelerometer.covariance.diagonal().head<9>().setConstant(0.01 * 0.01);
  calibration.accelerometer.covariance.diagonal().segment<3>(9).setConstant(0.05 * 0.05);
  calibration.gyroscope.offset_sigma_radps.setConstant(0.02);
  const estimator::SensorKnowledge known = sensor_knowledge({}, calibration);
  EXPECT_GE(known.accel_scale_sigma, 0.01);
  EXPECT_NEAR(known.accel_misalignment_sigma_rad, 0.01, 1e-12);
  EXPECT_GE(known.accel_bias_sigma_mps2, 0.05);
  EXPECT_LT(known.accel_bias_sigma_mps2, 0.06);
  EXPECT_GE(known.gyro_bias_sigma_radps, 0.02);
}

// A calibration by rotation knows no offset of a gyroscope that never rested.
TEST(SensorKnowledge, OfWhatTheCalibrationDoesNotSayIsAsItWas) {
  CampaignSettings campaign;
  campaign.estimator.sensor.accel_scale_sigma = 0.03;
  campaign.estimator.sensor.gyro_bias_sigma_radps = 0.04;
  const estimator::SensorKnowledge known = sensor_knowledge(campaign, {});
  EXPECT_GE(known.accel_scale_sigma, 0.03);
  EXPECT_GE(known.gyro_bias_sigma_radps, 0.04);
}

}  // namespace
}  // namespace waverig::rig
