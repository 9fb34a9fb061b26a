// The sensor unit of a campaign: from the names in its settings to a drawn, simulated unit.
#pragma once
#include "estimator/calibration/accelerometer_calibration.h"
#include "rig/campaign/settings.h"
#include "rig/frontend/simulated_unit.h"

namespace waverig::rig {

// Of the type chosen, at the campaign's place.
UnitSettings unit_settings(const CampaignSettings& campaign);

// The motor as a magnetometer on the arm has it, the arm's plane at that azimuth.
MotorFieldSettings motor_field(const CampaignSettings& campaign, double azimuth_rad);

// The one unit that the campaign tests, drawn from its seed: as it is calibrated, and as it is measured with
// later.
UnitParameters fresh_unit(const CampaignSettings& campaign);
UnitParameters tested_unit(const CampaignSettings& campaign);

// What a laboratory knows of its sensor, for the methods' uncertainty budgets: what the calibration says of
// itself, what the data sheet says the six positions cannot see (nonlinearity, temperature, instability),
// and, for a unit that has aged since, the certificate's allowance for that.
estimator::SensorKnowledge sensor_knowledge(const CampaignSettings& campaign,
                                            const estimator::SensorCalibration& calibration);

}  // namespace waverig::rig
