// The drive's boundary as Modbus holding registers, one map for both ends. 32- and 64-bit values take the
// high word first.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "motion/drive.h"

namespace waverig::motion::registers {

//  0 sequence | 1 controlword | 2 mode | 3-4 target position | 5-6 target velocity
inline constexpr int kCommandAddress = 0;
inline constexpr int kCommandCount = 7;
//  100-103 utime | 104 sequence | 105 statusword | 106 mode | 107-108 position | 109-110 velocity | 111
//  torque | 112 error code
inline constexpr int kFeedbackAddress = 100;
inline constexpr int kFeedbackCount = 13;
inline constexpr int kMapCount = kFeedbackAddress + kFeedbackCount;

using CommandWords = std::array<std::uint16_t, kCommandCount>;
using FeedbackWords = std::array<std::uint16_t, kFeedbackCount>;

inline std::uint16_t word_of(std::uint64_t value, int shift) {
  return static_cast<std::uint16_t>(value >> shift);
}
inline std::int32_t pair_of(std::uint16_t high, std::uint16_t low) {
  return static_cast<std::int32_t>((static_cast<std::uint32_t>(high) << 16) | low);
}

inline CommandWords encode(const DriveCommand& c) {
  const auto position = static_cast<std::uint32_t>(c.target_position);
  const auto velocity = static_cast<std::uint32_t>(c.target_velocity);
  return {c.sequence,
          c.controlword,
          static_cast<std::uint16_t>(c.mode),
          word_of(position, 16),
          word_of(position, 0),
          word_of(velocity, 16),
          word_of(velocity, 0)};
}

inline DriveCommand decode_command(std::span<const std::uint16_t, kCommandCount> r) {
  return {.sequence = r[0],
          .controlword = r[1],
          .mode = static_cast<DriveMode>(static_cast<std::int8_t>(r[2])),
          .target_position = pair_of(r[3], r[4]),
          .target_velocity = pair_of(r[5], r[6])};
}

inline FeedbackWords encode(const DriveFeedback& f) {
  const auto utime = static_cast<std::uint64_t>(f.utime);
  const auto position = static_cast<std::uint32_t>(f.position),
             velocity = static_cast<std::uint32_t>(f.velocity);
  return {word_of(utime, 48),
          word_of(utime, 32),
          word_of(utime, 16),
          word_of(utime, 0),
          f.sequence,
          f.statusword,
          static_cast<std::uint16_t>(f.mode),
          word_of(position, 16),
          word_of(position, 0),
          word_of(velocity, 16),
          word_of(velocity, 0),
          static_cast<std::uint16_t>(f.torque_permille),
          f.error_code};
}

inline DriveFeedback decode_feedback(std::span<const std::uint16_t, kFeedbackCount> r) {
  const auto utime = (static_cast<std::uint64_t>(r[0]) << 48) | (static_cast<std::uint64_t>(r[1]) << 32) |
                     (static_cast<std::uint64_t>(r[2]) << 16) | r[3];
  return {.utime = static_cast<std::int64_t>(utime),
          .sequence = r[4],
          .statusword = r[5],
          .mode = static_cast<DriveMode>(static_cast<std::int8_t>(r[6])),
          .position = pair_of(r[7], r[8]),
          .velocity = pair_of(r[9], r[10]),
          .torque_permille = static_cast<std::int16_t>(r[11]),
          .error_code = r[12]};
}

}  // namespace waverig::motion::registers
