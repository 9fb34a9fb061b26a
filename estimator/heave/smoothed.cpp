#include "estimator/heave/smoothed.h"

namespace waverig::estimator {

void Smoothed::finish(Output& output) {
  tell(record_, smooth_record(record_, settings_.sensor), settings_.sensor, output);
}

}  // namespace waverig::estimator
