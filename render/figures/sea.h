// Figures of campaigns on irregular seas, where the set height is Hm0 and no single wave has it.
#pragma once
#include "estimator/evaluation/results.h"
#include "estimator/evaluation/run_record.h"
#include "render/figure.h"

namespace waverig::render {

// Setting by setting: rms error of the heave in percent of Hm0; Hm0 and Tm02 against the true ones.
Figure sea_states_figure(const evaluation::CampaignResults& results);

// Peak period x Hm0, a map a method: rms error of the heave in percent of Hm0.
Figure sea_heave_map_figure(const evaluation::CampaignResults& results);

// One run: true heave and that of each method for some waves, and below the error over the whole steady part,
// each method's mean removed.
// methods: of the campaign, for their colours.
Figure sea_trace_figure(const evaluation::RunRecord& run, const std::vector<std::string>& methods);

}  // namespace waverig::render
