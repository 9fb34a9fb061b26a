#include "estimator/compass/directional_method.h"

#include <algorithm>

#include "estimator/heave/disturbance.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kDead_s = 5;  // without the least change, which noise makes: no reading

bool has_field(const ImuSample& sample) { return (sample.flags & flag::kNoMagnetometer) == 0; }

// How far the body really wanders, as the white path that the attitude's bounded-path model takes it for:
// variance times period. The model's own default holds a long swell's orbit for drift and leans the frame
// against it.
double path_density_m2s(const DirectionalSea& sea) {
  double variance_m2 = 0;
  for (const DirectionalBand& band : sea.bands) variance_m2 += band.a0_m2pHz;
  if (sea.bands.size() > 1) variance_m2 *= sea.bands[1].frequency_Hz - sea.bands[0].frequency_Hz;
  return variance_m2 / sea.peak_Hz;
}

}  // namespace

DirectionalSea directional_sea(const std::vector<ImuSample>& samples,
                               const std::vector<AttitudeSample>& attitude, const CompassSettings& compass) {
  DirectionalAnalysis analysis({.compass = compass});
  for (std::size_t i = 0; i < samples.size(); ++i)
    analysis.add({.utime = samples[i].utime,
                  .a_L = attitude[i].a_N,
                  .q_LB = attitude[i].q_NB,
                  .m_B_uT = samples[i].m_B_uT,
                  .has_field = has_field(samples[i])});
  return analysis.finish();
}

void Directional::add(const ImuSample& raw, Output&) {
  ImuSample sample = raw;
  if (is_dead(sample)) sample.flags |= flag::kNoMagnetometer;
  record_.add(sample);
  has_field_ = has_field_ || has_field(sample);
}

bool Directional::is_dead(const ImuSample& sample) {
  if (sample.m_B_uT != last_m_B_uT_) {
    last_m_B_uT_ = sample.m_B_uT;
    changed_utime_ = sample.utime;
  }
  return sample.m_B_uT.isZero() ||
         static_cast<double>(sample.utime - changed_utime_) * kMicrosecond > kDead_s;
}

void Directional::finish(Output& output) {
  if (!has_field_) return;
  const std::vector<ImuSample>& samples = record_.samples();
  AttitudeSettings attitude = attitude_settings(settings_.sensor);
  DirectionalSea found = directional_sea(samples, smooth_attitude(samples, attitude), settings_.compass);
  if (found.segments == 0) return;
  const double density_m2s = path_density_m2s(found);
  if (density_m2s > attitude.motion_m2s) {
    attitude.motion_m2s = density_m2s;
    found = directional_sea(samples, smooth_attitude(samples, attitude), settings_.compass);
  }
  SeaState sea;
  sea.start_utime = samples.front().utime;
  sea.duration_s = static_cast<double>(samples.back().utime - samples.front().utime) * kMicrosecond;
  found.fill(sea);
  output.sea(sea);
}

}  // namespace waverig::estimator
