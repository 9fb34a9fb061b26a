// From what the marks of a panel need to an axis: its limits and its ticks.
#pragma once
#include "render/marks.h"
#include "render/ticks.h"

namespace waverig::render {

// The limits of an axis out of what its marks need and what was asked for; always a positive, finite range.
// on_base: no room is left beyond a zero at its end.
void set_limits(const Axis& axis, const Extent& data, bool padded, bool on_base, Mapping& out);

// About one tick every label_px, fewer where labels of that size would touch (along: they stand beside each
// other).
Ticks ticks_of(const Axis& axis, const Mapping& mapping, float length_px, float label_px,
               const FontBook& fonts, float size_px, bool along);

// "Heave (m)", "Torque (×10³ N m)", "Time (2005-07-01 UTC)"
std::string axis_text(const Axis& axis, const Ticks& ticks);
// The same where there is little room: the label is shortened, its unit stays.
std::string axis_text_fitted(const Axis& axis, const Ticks& ticks, float most_px, const FontBook& fonts,
                             float size_px);

}  // namespace waverig::render
