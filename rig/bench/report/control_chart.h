// The control chart of a unit: what each of its calibrations said, against the first of them.
#pragma once
#include <vector>

#include "render/figure.h"
#include "rig/bench/history.h"

namespace waverig::rig::bench {

// calibrations: of one unit, in the order of measurement. A panel a quantity and kind of channel; bars and
// bands are k = 2, the wider band k = 3 (warning and action limits of a Shewhart chart), of a difference to
// the first.
render::Figure control_chart(const std::vector<estimator::FrontEndCalibration>& calibrations,
                             bool reference_common);

}  // namespace waverig::rig::bench
