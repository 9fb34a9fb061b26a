// Bits of the flags fields on the bus: what a sample, heave or wave suffers from (QARTOD sense).
#pragma once
#include <cstdint>

namespace waverig::flag {

inline constexpr std::int32_t kGap = 1 << 0;  // samples are missing just before this one
// Of a sample: unlike its neighbours, not used. Of heave that is told all the same: a sample there was not
// used, or the sensor's offset changes about then, which is taken off.
inline constexpr std::int32_t kSpike = 1 << 1;
inline constexpr std::int32_t kRange = 1 << 2;  // outside what is physically plausible
inline constexpr std::int32_t kFlatLine = 1 << 3;
inline constexpr std::int32_t kSaturation = 1 << 4;  // a sensor axis stands at its limit
inline constexpr std::int32_t kTooFewWaves = 1 << 5;
inline constexpr std::int32_t kBelowNoise = 1 << 6;
inline constexpr std::int32_t kNoMagnetometer = 1 << 7;
inline constexpr std::int32_t kUncalibrated = 1 << 8;  // nominal sensitivities only
inline constexpr std::int32_t kSettling = 1 << 9;      // a filter has not converged yet
inline constexpr std::int32_t kIncomplete = 1 << 10;   // a wave cut by the record's edge

}  // namespace waverig::flag
