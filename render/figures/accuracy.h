// Figures of a campaign's results: how well each method measured the waves. One that nothing is known for has
// no panels.
#pragma once
#include "estimator/evaluation/results.h"
#include "render/figure.h"

namespace waverig::render {

// Table 2 as a chart: what was published beside what each method gives, mean
// with standard deviation, and the standard deviation of single waves beside
// the Cramér-Rao bound.
Figure table2_figure(const evaluation::CampaignResults& results);
// Whether a setting of the campaign is one of the published ones; the chart names the paper where it is.
bool shows_published(const evaluation::CampaignResults& results);

// Period x height, a map a method: error of the mean height; standard deviation
// with the bound beside.
Figure error_map_figure(const evaluation::CampaignResults& results);
Figure std_map_figure(const evaluation::CampaignResults& results);

// Gain and phase against period as on a buoy's calibration sheet, with the scatter between the runs of a
// period.
Figure frequency_response_figure(const evaluation::CampaignResults& results);

// Single waves, estimated against true.
Figure single_waves_figure(const evaluation::CampaignResults& results);

// Contributions to the standard uncertainty of the mean height (GUM), a panel a
// method, each setting's bars together.
Figure uncertainty_budget_figure(const evaluation::CampaignResults& results);

}  // namespace waverig::render
