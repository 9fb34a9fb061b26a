// Coverage: over many simulated rigs, each with a sensor unit, a calibration and a noise of its own, how
// often the true mean height lies inside the expanded interval, and whether the budget predicts the scatter.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "rig/campaign/settings.h"

namespace waverig::rig {

struct Coverage {
  Setting setting;
  std::string method;
  int rigs = 0, inside = 0;  // of mean - U … mean + U, k = 2
  double mean_error = 0;     // relative, over the rigs
  double rms_error = 0;      // relative: what is observed
  double predicted = 0;      // relative: root mean square of U / 2
};

// The default campaign's rig and sensor, drawn for each seed from first_seed on; one run a setting.
std::vector<Coverage> coverage(std::uint64_t first_seed, int rigs, const std::vector<Setting>& settings,
                               double duration_s, const std::string& method);

}  // namespace waverig::rig
