// Nodes that only listen: until they are told to stop, or the record they wait for is over.
#pragma once
#include "lcmtypes/bus.h"
#include "rig/cli/nodes/process.h"
#include "rig/nodes/run_watch.h"

namespace waverig::cli {

enum class Ending { kToldToStop, kRecordOver, kMotionSilent };

// Handles messages until a stop is asked for; or until the first record has ended and no estimate came for
// quiet_s since (methods that look at the whole record answer after its end), a minute at the most; or until
// the motion node says nothing for five seconds inside a record.
Ending listen_to_record(Bus& bus, Requests& requests, const rig::RunWatch& watch, double quiet_s);

}  // namespace waverig::cli
