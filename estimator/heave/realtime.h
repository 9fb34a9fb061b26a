// `realtime`: heave, heave rate and attitude of any sea, sample by sample.
//
// AttitudeFilter levels the specific force; PathIntegrator integrates its vertical part twice; SeaIdentifier
// learns the sea's spectrum from it and HeaveFilter tells drift from sea by it, at nodes a quarter of a
// second apart. Between nodes heave is the double integral itself: gain one, no lag. The first minute is
// gone through again with every new model of the sea, levelled by all that was seen since, as if attitude
// and sea had been known from the start; what no spectrum shows yet, a swell under the sea, is settled by the
// likelihood of the path. What comes up after a calm is gone through again for its first twenty seconds, from
// the calm's end on; where that lies, some seconds back if the sea came up softly, is told by the likelihood
// too. A rest in the middle of a sea is short, or the sea is gone. With a fixed lag each sample waits
// until the nodes after it have told more about it.
#pragma once
#include <deque>
#include <optional>
#include <vector>

#include "estimator/attitude/attitude_filter.h"
#include "estimator/heave/calm.h"
#include "estimator/heave/heave_filter.h"
#include "estimator/heave/heave_steps.h"
#include "estimator/heave/sea_identifier.h"
#include "estimator/heave/wave_counter.h"
#include "estimator/method.h"
#include "estimator/sample_guard.h"

namespace waverig::estimator {

class Realtime : public Method {
 public:
  explicit Realtime(const MethodSettings& settings);
  void add(const ImuSample& sample, Output& output) override;
  void finish(Output& output) override;

 private:
  struct Held {  // a sample that waits for the fixed lag
    HeaveSample sample;
    LevelIncrement partial;  // from the node before it
    double since_node_s = 0, tilt_sigma_rad = 0;
    std::int64_t node = 0;  // number of that node
  };
  struct Rise {  // out of a calm, for as long as its end is gone through again
    Calm calm;
    Calm::Since since;
    std::int64_t seen_at;  // node
  };
  void start_path(const ImuSample& sample, const AttitudeSample& attitude);
  void resume(const ImuSample& sample, Output& output);
  void begin_record();
  void end_rethinking();
  void follow(const ImuSample& sample, const AttitudeSample& attitude, std::vector<HeaveStep>& steps);
  void filter(const HeaveStep& step);
  void remember(const HeaveStep& step);
  HeaveFilter filtered(const Calm::Since* calm, const std::vector<HeaveStep>& steps,
                       const SeaModel& sea) const;
  HeaveFilter most_probable(const Calm::Since* calm, const std::vector<HeaveStep>& steps);
  AttitudeSample rethink();
  void rethink_rise();
  bool lost();
  void find_again();
  bool outgrows_what_stirred() const;
  bool sea_is_gone() const;
  bool calm() const;
  void rest();
  void forget_sea(bool calm);
  void learn();
  void leave_calm();
  bool rises_softly();
  void rise(const Calm::Since* onset);
  void tell_without_jump(HeaveFilter filter);
  void locate(const AttitudeSample& attitude, Held& held) const;
  void estimate(const Held& held, double systematic_m2, HeaveSample& sample) const;
  void release(std::int64_t until_utime, Output& output);

  MethodSettings settings_;
  SampleGuard guard_;
  AttitudeFilter attitude_;
  HeaveSteps path_;
  SeaIdentifier identifier_;
  HeaveFilter filter_;
  WaveCounter counter_;

  std::vector<ImuSample> first_;         // from the start on, for as long as they are gone through again
  std::optional<AttitudeSample> start_;  // attitude of the first of them, as last found
  std::vector<HeaveStep> steps_;         // of the sample just added; a member for its memory
  Calm calm_;
  std::optional<Rise> rise_;
  double jump_m_ = 0;                 // of heave when it was, or by a rest: taken back, and fading
  std::deque<LevelIncrement> whole_;  // the newest node intervals, newest last
  std::deque<Held> held_;
  std::int64_t nodes_ = 0, settled_nodes_ = 0;
  std::int32_t pending_flags_ = 0;
  static constexpr int kOldEnough = 120, kOldestEnough = 480;
  int old_enough_ = kOldEnough;  // fine nodes of one sea before another one is believed
  double rest_level_m_ = 0;      // of the calm's zero, from the mean level of the sea before it
  double swell_ = 0;             // as last chosen
  std::int64_t chosen_at_ = 0, thought_at_ = 0;  // nodes, when it was, and when all was last gone through
  int beyond_ = 0;                               // nodes in a row with heave that its sea does not reach
  bool started_ = false, rethinks_ = true, due_ = false;
};

}  // namespace waverig::estimator
