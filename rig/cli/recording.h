// A recording as the program takes it: an LCM event log, or a sample CSV, plain or gzip.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "estimator/types.h"
#include "rig/campaign/directory_lock.h"

namespace waverig::cli {

// What a recording gives, sample by sample; false at its end.
using SampleSource = std::function<bool(estimator::ImuSample&)>;

// Throws UserError, here and while it is read, naming file and place of what is wrong.
SampleSource samples_of(const std::filesystem::path& path);

// For who is about to calibrate them. A log says of its samples whether that is done, and is refused then; a
// CSV does not say.
SampleSource uncalibrated_samples_of(const std::filesystem::path& path);

// Seconds, milliseconds or nanoseconds in the place of microseconds would make waves of micrometres or of
// kilometres: throws UserError where the usual interval of a file's times can be none of a wave record. 0:
// not known.
void check_time_unit(const std::string& file, double usual_interval_s);

// Throws UserError where --out names the recording itself.
void refuse_to_overwrite(const std::filesystem::path& recording, const std::filesystem::path& out);

// Throws UserError where one of the results that a command writes into --out would take an input's place.
void refuse_to_overwrite(const std::vector<std::string>& inputs, const std::filesystem::path& out,
                         const std::vector<std::string>& results);

// Throws UserError where the option's file is one that the results of a campaign are made of.
void refuse_to_overwrite_results(const std::string& option, const std::filesystem::path& file,
                                 const std::vector<std::filesystem::path>& directories);

// The folder that --out names, made where it is not there, and held: two programs at work in it would leave
// a file of the one beside a file of the other. Throws as refuse_place() of lcmtypes/disk.h, and UserError
// where another one holds it.
[[nodiscard]] rig::DirectoryLock hold_out_directory(const std::string& out);

std::vector<estimator::ImuSample> all_of(const SampleSource& source);

}  // namespace waverig::cli
