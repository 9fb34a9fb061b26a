// A record's heave, single waves, spectrum and parameters as one NetCDF file after the CF conventions, with
// the names that wave buoys' files use.
#pragma once
#include <filesystem>
#include <span>
#include <string>

#include "estimator/evaluation/heave_csv.h"
#include "estimator/evaluation/heave_spectrum.h"
#include "estimator/evaluation/summary.h"
#include "estimator/types.h"

namespace waverig::evaluation {

struct NetcdfRecord {
  const HeaveSeries& heave;
  std::span<const estimator::Wave> waves;
  const HeaveSpectrum& spectrum;
  const Summary& summary;
  std::string source;  // program and version
  std::string title;
};

// There whole or not at all. Throws UserError where the place cannot be written, std::runtime_error where the
// disk is full; both name the file.
void write_netcdf(const std::filesystem::path& path, const NetcdfRecord& record);

}  // namespace waverig::evaluation
