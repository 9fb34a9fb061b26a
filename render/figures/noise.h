// Figures of a sensor's noise: Allan deviation at rest, spectra under way.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "estimator/evaluation/run_record.h"
#include "render/figure.h"

namespace waverig::render {

// One quantity at rest, axis by axis, evenly sampled; several records of it are
// pooled.
struct RestRecord {
  double interval_s = 0;
  std::array<std::vector<double>, 3> axes;
};
struct RestRecords {
  std::vector<RestRecord> specific_force_mps2, angular_rate_radps;
  bool empty() const { return specific_force_mps2.empty(); }
};

// The part of a run before anything moves, told from the truth; gaps in the
// samples end it.
RestRecords rest_of(const evaluation::RunRecord& run);
void append(RestRecords& to, RestRecords&& from);

// Overlapping Allan deviation with the noise terms fitted to it (IEEE Std
// 952-1997) named in the legend. calibrated: whether a calibration stands behind the samples.
Figure allan_figure(const RestRecords& rest, bool calibrated);

// One-sided amplitude densities over the steady part: specific force on each
// axis with the noise floor, and the heave of each method beside the truth, as
// far as it is known without a break.
// noise_density: of the vertical acceleration, NaN where unknown. methods: of the campaign, for their
// colours.
Figure spectra_figure(const evaluation::RunRecord& run, double noise_density_mps2_rthz,
                      const std::vector<std::string>& methods);

// Welch: half-overlapping Hann blocks, mean removed from each. Returns
// amplitude density against frequency, without 0 Hz.
struct Spectrum {
  std::vector<double> frequency_hz, density_rthz;
};
Spectrum welch(std::span<const double> values, double interval_s, std::size_t block);

}  // namespace waverig::render
