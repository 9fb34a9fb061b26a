// Phases of a run (run_t.phase) and actions of a record (record_t.action).
#pragma once
#include <cstdint>

namespace waverig {

enum class Phase : std::int32_t { kRest = 0, kRampIn = 1, kSteady = 2, kRampOut = 3, kStopped = 4, kHeld = 5 };
enum class RecordAction : std::int32_t { kBegin = 1, kEnd = 2 };

}  // namespace waverig
