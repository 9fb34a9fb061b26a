// The limit of heave on the seas of a campaign: what evaluation/heave_bound.h makes of the spectrum that is
// set.
#pragma once
#include <string>

#include "estimator/evaluation/heave_bound.h"
#include "motion/sea_state.h"
#include "rig/sensors/accelerometer.h"

namespace waverig::rig {

// Of the sea as draw_components draws it: nothing below lowest_relative, nothing above highest_relative.
evaluation::HeaveBound sea_bound(const motion::SeaSettings& sea, const AccelerometerSettings& accelerometer);

// How far behind its newest sample a method tells heave: fixed_lag_s where it runs in real time, else the
// whole record, which limits every method.
double heave_lag_s(const std::string& method, double fixed_lag_s);

}  // namespace waverig::rig
