// A run's directory: what the bench keeps there so that the directory alone tells what the run was and what
// it measured.
#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "rig/bench/analysis.h"

namespace waverig::rig::bench {

inline std::filesystem::path store_file(const std::filesystem::path& out) { return out / "bench.sqlite"; }
// The scale factors that a bias run goes by.
inline std::filesystem::path kept_scale_factors(const std::filesystem::path& out) {
  return out / "scale_factors.json";
}

// Copies the sequence and every file behind it to out/sequence, as they lie to each other. Returns the
// sequence's place, from out on. Throws UserError where out cannot be written.
std::string keep_files(const Sequence& sequence, const std::filesystem::path& out);

// The sequence of the run in out, from the files kept there. Throws UserError where it is none of ours, or
// was changed.
Sequence kept_sequence(const std::filesystem::path& out, const RunInfo& info);

// What the run in out measured, merged with known where it is given; nothing where its procedure is none.
// Throws UserError where the recordings do not suffice.
std::optional<Analysis> analyse_run(const Sequence& sequence, const Store& store,
                                    const estimator::FrontEndCalibration* known);

}  // namespace waverig::rig::bench
