// The campaign's own calibration: what the six positions leave over, and how
// far the result is from the simulated truth.
#pragma once
#include <optional>
#include <string>

#include "render/figure.h"

namespace waverig::render {

// json: CampaignResults::calibration_json; none where it is empty. Throws
// UserError where it is not a calibration.
std::optional<Figure> calibration_figure(const std::string& json);

}  // namespace waverig::render
