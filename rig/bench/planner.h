// From steps as they stand in a sequence file to the plan.
#pragma once
#include <vector>

#include "rig/bench/sequence.h"
#include "rig/bench/sequence_document.h"

namespace waverig::rig::bench {

// Unfolds loops and appends to sequence.plan, each step checked against sequence.laboratory. Throws UserError
// naming file, line, key, value and what was expected.
void unfold(const Document& document, const std::vector<RawStep>& steps, Section section, Sequence& sequence);

}  // namespace waverig::rig::bench
