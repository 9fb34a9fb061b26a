// Sudden changes of the vertical accelerometer's offset within a record: a sensor that was knocked or slipped
// in its mounting, a supply that dropped. The drift of a SeaModel wanders and cannot follow them; what it
// does not take would be taken for sea.
//
// Over a minute no sea accelerates a body on average. The tapered mean over the minute after an
// instant less that over the minute before it stands out where the offset changed; when it did is told by the
// corner in the speed, int a dt, by least squares of two straight lines that meet there. Heave about that
// time carries flag::kSpike.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "estimator/heave/path_integrator.h"
#include "estimator/types.h"

namespace waverig::estimator {

// Of a piece without a gap that begins at first_utime; in order of time. Changes below 2.5 mg are left to the
// drift, as are those within a minute of its ends.
std::vector<OffsetChange> find_offset_changes(std::span<const LevelIncrement> increments,
                                              std::int64_t first_utime, double interval_s);

}  // namespace waverig::estimator
