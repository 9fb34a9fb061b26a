// Waves CSV: start_utime,period_s,height_cm,sigma_cm; a row a single wave.
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "estimator/types.h"

namespace waverig::evaluation {

// Standard uncertainty (k = 1) of one wave's height: its known contributions in quadrature, NaN where none is
// known.
double combined_sigma_m(const estimator::Wave& wave);

std::string waves_csv(std::span<const estimator::Wave> waves);
void write_waves_csv(const std::filesystem::path& path, std::span<const estimator::Wave> waves);

}  // namespace waverig::evaluation
