#include "rig/frontend/frame_codec.h"

#include <algorithm>
#include <cstring>

namespace waverig::rig {
namespace {

std::uint32_t load_crc(const CrcPlacement& place, const std::uint8_t* frame) {
  std::uint32_t value = 0;
  const int bytes = place.parameters.width / 8;
  for (int i = 0; i < bytes; ++i) {
    const int from = place.order == ByteOrder::kBig ? i : bytes - 1 - i;
    value = (value << 8) | frame[place.byte_offset + from];
  }
  return value;
}

std::span<const std::uint8_t> covered(const CrcPlacement& place, const std::uint8_t* frame) {
  return {frame + place.first_byte, frame + place.last_byte + 1};
}

std::vector<FieldPlace> places_of(const FrameLayout& layout) {
  return {layout.fields.begin(), layout.fields.end()};
}

}  // namespace

FieldPlace::FieldPlace(const FrameField& field)
    : first_byte(static_cast<std::size_t>(field.bit_offset / 8)),
      bytes((field.bit_offset % 8 + field.bits + 7) / 8),
      shift(field.order == ByteOrder::kBig ? 8 * bytes - field.bit_offset % 8 - field.bits
                                           : field.bit_offset % 8),
      mask(field.bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field.bits) - 1),
      sign(field.type == FieldType::kSigned ? std::uint64_t{1} << (field.bits - 1) : 0),
      big(field.order == ByteOrder::kBig) {}

std::int64_t FieldPlace::load(const std::uint8_t* frame) const {
  const std::uint8_t* p = frame + first_byte;
  std::uint64_t word = 0;
  if (big)
    for (int i = 0; i < bytes; ++i) word = (word << 8) | p[i];
  else
    for (int i = bytes - 1; i >= 0; --i) word = (word << 8) | p[i];
  word = (word >> shift) & mask;
  return static_cast<std::int64_t>((word ^ sign) - sign);
}

void FieldPlace::store(std::uint8_t* frame, std::int64_t raw) const {
  std::uint8_t* p = frame + first_byte;
  const std::uint64_t word = (static_cast<std::uint64_t>(raw) & mask) << shift, field = mask << shift;
  for (int i = 0; i < bytes; ++i) {
    const int s = 8 * (big ? bytes - 1 - i : i);
    p[i] = static_cast<std::uint8_t>((p[i] & ~(field >> s)) | (word >> s));
  }
}

FrameEncoder::FrameEncoder(const FrameLayout& layout)
    : places_(places_of(layout)),
      blank_(static_cast<std::size_t>(layout.length_bytes)),
      crc_place_(layout.crc) {
  std::ranges::copy(layout.sync, blank_.begin());
  std::ranges::copy(layout.terminator, blank_.end() - static_cast<std::ptrdiff_t>(layout.terminator.size()));
  if (crc_place_) crc_.emplace(crc_place_->parameters);
}

void FrameEncoder::append(std::span<const std::int64_t> raw, std::vector<std::uint8_t>& out) const {
  const std::size_t begin = out.size();
  out.insert(out.end(), blank_.begin(), blank_.end());
  std::uint8_t* frame = out.data() + begin;
  for (std::size_t i = 0; i < places_.size(); ++i) places_[i].store(frame, raw[i]);
  if (!crc_) return;
  const std::uint32_t crc = crc_->of(covered(*crc_place_, frame));
  const int bytes = crc_place_->parameters.width / 8;
  for (int i = 0; i < bytes; ++i) {
    const int s = 8 * (crc_place_->order == ByteOrder::kBig ? bytes - 1 - i : i);
    frame[crc_place_->byte_offset + i] = static_cast<std::uint8_t>(crc >> s);
  }
}

FrameDecoder::FrameDecoder(const FrameLayout& layout, std::int64_t largest_gap)
    : places_(places_of(layout)),
      length_(static_cast<std::size_t>(layout.length_bytes)),
      sync_(layout.sync),
      terminator_(layout.terminator),
      crc_place_(layout.crc),
      largest_gap_(largest_gap) {
  if (crc_place_) crc_.emplace(crc_place_->parameters);
  if (!layout.counter.empty()) {
    counter_ = layout.index_of(layout.counter);
    modulus_ = std::int64_t{1} << layout.fields[*counter_].bits;
    largest_gap_ = std::min(largest_gap_, modulus_ / 4);  // a narrow counter tells little of long gaps
  }
  for (Frame* frame : {&frame_, &held_, &waiting_}) frame->raw.resize(places_.size());
}

void FrameDecoder::add(std::span<const std::uint8_t> bytes) {
  if (at_ > 0) {
    buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(at_));
    at_ = 0;
  }
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  statistics_.bytes += static_cast<std::int64_t>(bytes.size());
}

bool FrameDecoder::intact(const std::uint8_t* bytes) const {
  if (!std::equal(terminator_.begin(), terminator_.end(), bytes + length_ - terminator_.size())) return false;
  return !crc_ || crc_->of(covered(*crc_place_, bytes)) == load_crc(*crc_place_, bytes);
}

bool FrameDecoder::next_intact(Frame& frame) {
  while (buffer_.size() - at_ >= length_) {
    const std::uint8_t* const here = buffer_.data() + at_;
    if (std::equal(sync_.begin(), sync_.end(), here)) {
      if (intact(here)) {
        for (std::size_t i = 0; i < places_.size(); ++i) frame.raw[i] = places_[i].load(here);
        at_ += length_;
        return true;
      }
      ++statistics_.broken;
    }
    const std::size_t left = buffer_.size() - at_ - 1;
    const void* const found = left > 0 ? std::memchr(here + 1, sync_[0], left) : nullptr;
    const std::size_t step = found == nullptr
                                 ? left + 1
                                 : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - here);
    at_ += step;
    statistics_.skipped_bytes += static_cast<std::int64_t>(step);
    clean_start_ = false;
  }
  return false;
}

std::int64_t FrameDecoder::steps(std::int64_t from, std::int64_t to) const {
  return ((to - from) % modulus_ + modulus_) % modulus_;
}

// jump: how far the counter went; 1 where nothing was lost.
const Frame* FrameDecoder::deliver(Frame& frame, std::int64_t jump) {
  sequence_ += jump;
  frame.sequence = sequence_;
  frame.missing = jump - 1;
  statistics_.lost += frame.missing;
  ++statistics_.frames;
  if (counter_) last_ = frame.raw[*counter_];
  return &frame;
}

const Frame* FrameDecoder::next() {
  if (has_waiting_) {
    has_waiting_ = false;
    std::swap(frame_, waiting_);
    return deliver(frame_, steps(*last_, frame_.raw[*counter_]));
  }
  while (next_intact(frame_)) {
    if (!counter_) return deliver(frame_, 1);
    const std::int64_t counter = frame_.raw[*counter_];
    if (!last_ && clean_start_) return deliver(frame_, 1);
    const std::int64_t jump = last_ ? steps(*last_, counter) : 0;
    if (last_ && jump == 0) {
      ++statistics_.duplicates;
      statistics_.skipped_bytes += static_cast<std::int64_t>(length_);
      continue;
    }
    const auto drop_held = [&] {
      if (!holding_) return;
      holding_ = false;
      ++statistics_.unconfirmed;
      statistics_.skipped_bytes += static_cast<std::int64_t>(length_);
    };
    if (last_ && jump <= largest_gap_ + 1) {
      drop_held();
      return deliver(frame_, jump);
    }
    if (holding_) {
      const std::int64_t from_held = steps(held_.raw[*counter_], counter);
      if (from_held >= 1 && from_held <= largest_gap_ + 1) {  // borne out: the held one first, then this one
        holding_ = false;
        has_waiting_ = true;
        std::swap(waiting_, frame_);
        std::swap(frame_, held_);
        if (last_) ++statistics_.restarts;
        return deliver(frame_, last_ ? steps(*last_, frame_.raw[*counter_]) : 1);
      }
    }
    drop_held();
    std::swap(held_, frame_);
    holding_ = true;
  }
  return nullptr;
}

}  // namespace waverig::rig
