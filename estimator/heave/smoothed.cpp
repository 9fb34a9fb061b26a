#include "estimator/heave/smoothed.h"

#include "estimator/heave/wave_counter.h"

namespace waverig::estimator {

void Smoothed::finish(Output& output) {
  const SmoothedRecord smoothed = smooth_record(record_, settings_.sensor);
  WaveCounter counter(settings_.sensor);
  for (std::size_t i = 0; i < smoothed.heave.size(); ++i) {
    output.heave(smoothed.heave[i]);
    if (const auto wave = counter.add(smoothed.heave[i], smoothed.attitude[i].tilt_sigma_rad))
      output.wave(*wave);
  }
}

}  // namespace waverig::estimator
