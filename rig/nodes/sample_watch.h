// SampleWatch: sees which samples of a record the methods leave out and why, by the guard that they all have,
// and puts it into words: a flag alone does not tell a clock that was set back from a loose plug.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "estimator/sample_guard.h"

namespace waverig::rig {

class SampleWatch {
 public:
  void add(const estimator::ImuSample& sample);
  void begin_record();  // times begin anew, the counts go on

  std::int64_t samples() const { return samples_; }
  std::int64_t left_out() const { return late_ + ahead_ + implausible_ + spikes_ + flat_; }
  double usual_interval_s() const { return guard_.usual_interval_s(); }
  // Empty where nothing was left out and nothing is missing.
  std::string words() const;

 private:
  struct SetBack {
    std::int64_t sample, utime;
    double by_s;
  };
  void add_late(const estimator::ImuSample& sample);

  estimator::SampleGuard guard_;
  std::int64_t samples_ = 0, late_ = 0, ahead_ = 0, implausible_ = 0, spikes_ = 0, flat_ = 0, gaps_ = 0;
  double missing_s_ = 0;
  std::optional<std::int64_t> last_utime_;  // of the last usable sample of the record
  std::int64_t late_utime_ = 0;             // of the last late one
  int late_in_a_row_ = 0;                   // each after the one before
  SetBack row_{}, set_back_{};
};

}  // namespace waverig::rig
