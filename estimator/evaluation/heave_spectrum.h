// Variance density of a heave series, and the sea state that it tells.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/types.h"

namespace waverig::evaluation {

struct HeaveSpectrumSettings {
  double block_s = 200;      // Hann blocks, half overlapped; a shorter record is one block
  double lowest_hz = 0.025;  // below it heave is drift
  double highest_hz = 1e9;   // or half the sampling rate
};

struct HeaveSpectrum {
  std::int64_t start_utime = 0;
  double duration_s = 0;                  // without gaps
  double resolution_hz = 0;               // distance of the frequencies
  std::vector<double> frequency_hz;       // lowest_hz and above
  std::vector<double> density_m2_per_hz;  // one-sided
  std::int32_t flags = 0;
};

// The series is brought onto an even grid of its median interval first; single values that are unknown (NaN)
// are bridged by straight lines. No block reaches over a gap (three median intervals), and the flag tells of
// any value that is missing. Hann windows weigh a record's ends and what lies between two blocks less: the
// density is scaled to the mean square of all that is known, between the lowest and the highest frequency.
// Empty where no 16 samples are without a gap.
HeaveSpectrum spectrum_of(std::span<const std::int64_t> utime, std::span<const double> heave_m,
                          const HeaveSpectrumSettings& settings = {});

// Hm0 = 4 sqrt(m0), Tm01 = m0 / m1, Tm02 = sqrt(m0 / m2), Tm-10 = m_-1 / m0, Tp at the centroid of the
// density's fourth power (Young 1995). Everything unknown for an empty spectrum.
estimator::SeaState sea_of(const HeaveSpectrum& spectrum);

}  // namespace waverig::evaluation
