// Direction roses: from where the waves came, where there is a compass.
#pragma once
#include <optional>

#include "estimator/evaluation/results.h"
#include "render/figure.h"

namespace waverig::render {

// Sea states with a known mean direction, by sector and height; none where no
// method told a direction.
std::optional<Figure> direction_figure(const evaluation::CampaignResults& results);

// One rose: shares of `directions_rad` (clockwise from north) in 16 sectors,
// stacked by classes of value.
Panel rose_panel(std::string title, const std::vector<double>& directions_rad,
                 const std::vector<double>& hm0_m);

}  // namespace waverig::render
