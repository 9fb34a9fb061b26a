#include "rig/nodes/encoder_truth.h"

#include <cmath>

#include "rig/nodes/truth_publisher.h"

namespace waverig::rig {

EncoderTruth::EncoderTruth(Bus& bus, const ArmPlacement& arm)
    : bus_(bus), arm_(arm), q_azimuth_(quaternion_of({0, 0, arm.azimuth_rad})) {}

void EncoderTruth::tell(std::int64_t utime, double measured_rad) {
  const double dt_s = static_cast<double>(utime - last_utime_) * kMicrosecond;
  const double rate_radps = seq_ > 0 && dt_s > 0 ? (measured_rad - last_rad_) / dt_s : 0;
  const double c = arm_.radius_m * std::cos(measured_rad), s = arm_.radius_m * std::sin(measured_rad);
  BodyMotion tip;
  tip.utime = utime;
  tip.q_NB = q_azimuth_;
  tip.position_N = q_azimuth_ * Vector3d(c, 0, -s);
  tip.velocity_N = rate_radps * (q_azimuth_ * Vector3d(-s, 0, -c));
  publish_truth(bus_, tip, seq_++, measured_rad);
  last_utime_ = utime;
  last_rad_ = measured_rad;
}

}  // namespace waverig::rig
