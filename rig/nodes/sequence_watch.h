// SequenceWatch: sees from the seq of a channel's messages what the bus, or whoever fills it, has lost.
#pragma once
#include <algorithm>
#include <cstdint>

namespace waverig::rig {

class SequenceWatch {
 public:
  // How many messages are missing just before this one. A seq that does not grow begins a new count, from 0;
  // what went before the first message heard is not missing.
  std::int64_t missing_before(std::int64_t seq) {
    seq = std::max<std::int64_t>(seq, 0);
    anew_ = !heard_ || seq <= last_seq_;
    const std::int64_t missing = !anew_ ? seq - last_seq_ - 1 : heard_ ? seq : 0;
    heard_ = true;
    last_seq_ = seq;
    missing_ += missing;
    return missing;
  }
  bool anew() const { return anew_; }                // the last message began a count, or was the first heard
  std::int64_t missing() const { return missing_; }  // in all

 private:
  bool heard_ = false, anew_ = false;
  std::int64_t last_seq_ = 0, missing_ = 0;
};

}  // namespace waverig::rig
