#include "rig/campaign/sensor_unit.h"

#include "motion/kinematics/random.h"

namespace waverig::rig {

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

}  // namespace waverig::rig
