// FrameEncoder and FrameDecoder: raw field values to frame bytes and back, after a FrameLayout.
//
// The decoder takes bytes as they come from a wire, in any pieces, and trusts none: after a failed check it
// advances one byte, never a frame's length, so that no intact frame is lost; the counter is checked too,
// since a 16-bit CRC lets one broken frame in 65,536 pass.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rig/frontend/frame_layout.h"

namespace waverig::rig {

// Where a field lies in the bytes; derived from its bit offset, width and byte order.
struct FieldPlace {
  explicit FieldPlace(const FrameField& field);
  std::int64_t load(const std::uint8_t* frame) const;       // sign-extended where signed
  void store(std::uint8_t* frame, std::int64_t raw) const;  // the low bits of raw

  std::size_t first_byte;
  int bytes, shift;
  std::uint64_t mask, sign;  // sign: the sign bit, 0 for the others
  bool big;
};

class FrameEncoder {
 public:
  explicit FrameEncoder(const FrameLayout& layout);
  std::size_t frame_bytes() const { return blank_.size(); }
  // raw: one value a field, in the layout's order. Appends one frame.
  void append(std::span<const std::int64_t> raw, std::vector<std::uint8_t>& out) const;

 private:
  std::vector<FieldPlace> places_;
  std::vector<std::uint8_t> blank_;  // sync and terminator in place
  std::optional<CrcPlacement> crc_place_;
  std::optional<Crc> crc_;
};

struct Frame {
  std::vector<std::int64_t> raw;  // one value a field, in the layout's order
  std::int64_t sequence = 0;      // unwrapped counter; counts frames where the layout has none
  std::int64_t missing = 0;       // frames lost just before this one
};

struct FrameStatistics {
  std::int64_t frames = 0;       // delivered
  std::int64_t lost = 0;         // missing between delivered ones, by the counter
  std::int64_t broken = 0;       // sync found, terminator or CRC wrong
  std::int64_t duplicates = 0;   // counter as before: dropped
  std::int64_t unconfirmed = 0;  // CRC right, counter wild, not borne out by the next frame: dropped
  std::int64_t restarts = 0;     // counter wild, borne out by the next frame
  std::int64_t bytes = 0;
  std::int64_t skipped_bytes = 0;  // outside delivered frames
};

class FrameDecoder {
 public:
  // A counter that jumps by more than largest_gap is believed only when the next frame bears it out.
  explicit FrameDecoder(const FrameLayout& layout, std::int64_t largest_gap = 500);

  void add(std::span<const std::uint8_t> bytes);
  // The next frame, valid until the next call; nullptr where more bytes are needed.
  const Frame* next();

  const FrameStatistics& statistics() const { return statistics_; }

 private:
  bool next_intact(Frame& frame);
  bool intact(const std::uint8_t* bytes) const;
  std::int64_t steps(std::int64_t from, std::int64_t to) const;  // of the wrapping counter
  const Frame* deliver(Frame& frame, std::int64_t jump);

  std::vector<FieldPlace> places_;
  std::size_t length_;
  std::vector<std::uint8_t> sync_, terminator_;
  std::optional<CrcPlacement> crc_place_;
  std::optional<Crc> crc_;
  std::optional<std::size_t> counter_;
  std::int64_t modulus_ = 0, largest_gap_;

  std::vector<std::uint8_t> buffer_;
  std::size_t at_ = 0;                // first byte not yet judged
  bool clean_start_ = true;           // nothing was skipped before the first frame
  std::optional<std::int64_t> last_;  // counter of the last delivered frame
  std::int64_t sequence_ = -1;
  Frame frame_, held_, waiting_;
  bool holding_ = false, has_waiting_ = false;
  FrameStatistics statistics_;
};

}  // namespace waverig::rig
