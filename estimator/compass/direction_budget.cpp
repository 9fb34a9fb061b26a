#include "estimator/compass/direction_budget.h"

#include <cmath>

namespace waverig::estimator {

double DirectionBudget::total_rad() const {
  return std::hypot(std::hypot(hard_iron_rad, soft_iron_rad, tilt_rad), declination_rad, gyro_rad);
}

DirectionBudget direction_budget(const CompassKnowledge& knowledge, double dip_rad) {
  const double horizontal = std::cos(dip_rad);  // of the field: what an error across it is held against
  return {
      knowledge.hard_iron_sigma / horizontal, knowledge.soft_iron_sigma / horizontal,
      knowledge.tilt_sigma_rad * std::abs(std::tan(dip_rad)),  // eq. (38), level: A and B over all headings
      knowledge.declination_sigma_rad, knowledge.gyro_misalignment_sigma_rad};
}

}  // namespace waverig::estimator
