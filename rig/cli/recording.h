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

std::vector<estimator::ImuSample> read_samples(const std::filesystem::path& path);

}  // namespace waverig::cli
