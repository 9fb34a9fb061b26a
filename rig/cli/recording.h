// A recording as the program takes it: an LCM event log, or a sample CSV, plain or gzip.
#pragma once
#include <filesystem>
#include <functional>
#include <vector>

#include "estimator/types.h"

namespace waverig::cli {

// What a recording gives, sample by sample; false at its end.
using SampleSource = std::function<bool(estimator::ImuSample&)>;

// Throws UserError, here and while it is read, naming file and place of what is wrong.
SampleSource samples_of(const std::filesystem::path& path);

// For who is about to calibrate them. A log says of its samples whether that is done, and is refused then; a
// CSV does not say.
SampleSource uncalibrated_samples_of(const std::filesystem::path& path);

std::vector<estimator::ImuSample> all_of(const SampleSource& source);

}  // namespace waverig::cli
