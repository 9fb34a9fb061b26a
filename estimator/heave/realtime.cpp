#include "estimator/heave/realtime.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "estimator/attitude/attitude_smoother.h"
#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kLongestSkip_s = 60;  // after that no wave is remembered
constexpr double kSeaLasts_s = 1800;   // after a longer gap it is another one
constexpr double kSettling_s = 60;
constexpr int kMostNodesBetween = 8;  // two samples, where a lag is waited for
// Beyond so many standard deviations of its sea heave has run away if it stays there for longer than a wave's
// crest, or if no other sea that moves as much as was felt just now goes so far. The sensor was knocked, or
// its offset changed, which was taken for sea.
constexpr double kLost = 6;
constexpr double kLongestCrest_s = 15;
constexpr double kSlowest_radps = 0.4;
constexpr double kRethought_s = 60;
constexpr std::array kSwells = {5e-4, 0.03, 0.5};  // relative variances, of which one is believed
constexpr double kLargeSwell = 0.3;                // a swell is the less usual the larger, by this power
constexpr int kRethoughtAgain = 12;                // when surprised, with a twelfth more seen
constexpr double kLikelier = 2;                    // by so much in log likelihood another onset is believed
constexpr int kRise = 76;                          // nodes after a rise was seen that are gone through again
constexpr std::int64_t kMayJump = 120;             // nodes; later, what is told has been taken for waves
constexpr double kSeaIsGone_s = 12;                // after a rest of that length
constexpr double kJumpFades_s = 4, kJumpFadesInCalm_s = 60;
constexpr int kStirred = 30;  // nodes; what comes up in a calm later is not what stirred in it
constexpr double kOutgrown = 2, kCalm_mps2 = 0.1;
constexpr double kChosenAgain = 1.5;  // times the nodes, while the sea is guessed
constexpr double kGuessWeight = 3;    // periodograms of less than a minute tell little
constexpr double kOffsetDoubt = 2;    // a sensor that is off is not to be taken for a swell
// A steep sea shows the gyroscope's scale soon enough from there; by hand a body is moved as no sea moves it.
constexpr double kScaleDoubt = 0.5;
constexpr std::size_t kMostRethought = 60'000;  // samples
constexpr double kAtOnce = 1.1;

SeaIdentifierSettings identifier_settings(const SensorKnowledge& sensor) {
  SeaIdentifierSettings s;
  s.guess_weight = kGuessWeight;
  s.accel_noise_m2ps3 = accel_noise_m2ps3(sensor);
  s.offset_sigma_mps2 = kOffsetDoubt * offset_sigma_mps2(sensor);
  return s;
}

}  // namespace

Realtime::Realtime(const MethodSettings& settings)
    : settings_(settings),
      attitude_(attitude_settings(settings.sensor)),
      path_(settings.sensor),
      identifier_(identifier_settings(settings.sensor)),
      filter_(identifier_.model(), 0, 0),
      counter_(settings.sensor) {
  const double longest = (filter_.order() - kMostNodesBetween) * kFineInterval_s;
  if (!(settings.fixed_lag_s >= 0 && settings.fixed_lag_s <= longest))
    throw UserError("realtime: fixed_lag_s = " + std::to_string(settings.fixed_lag_s) + " is outside 0 to " +
                    std::to_string(longest) + " s");
}

void Realtime::add(const ImuSample& raw, Output& output) {
  const GuardVerdict verdict = guard_.check(raw);
  if (!verdict.usable) {
    pending_flags_ |= verdict.flags & ~flag::kGap;
    return;
  }
  ImuSample sample = raw;
  sample.flags = verdict.flags | std::exchange(pending_flags_, 0);
  // 1. Level.
  AttitudeSample attitude = attitude_.update(sample);
  // 2. Integrate, and at the nodes tell drift from sea.
  if (!started_) {
    start_path(sample, attitude);
  } else if (verdict.anew) {
    resume(sample, output);
    start_path(sample, attitude);
  } else {
    follow(sample, attitude, steps_);
    for (const HeaveStep& step : steps_) filter(step);
    steps_.clear();
  }
  if (rethinks_) first_.push_back(sample);
  const bool moves = rethinks_ || rise_ || filter_.rest_s() == 0;  // a rest tells nothing of the sea
  if (moves && std::exchange(due_, false)) {
    if (rethinks_)
      attitude = rethink();
    else if (rise_)
      rethink_rise();
    else
      learn();
  }
  jump_m_ *= std::exp(-verdict.dt_s / (!rethinks_ && calm() ? kJumpFadesInCalm_s : kJumpFades_s));
  // 3. Answer, now or after the lag.
  Held held;
  held.sample.utime = sample.utime;
  held.sample.seq = sample.seq;
  held.sample.flags = sample.flags;
  if (rise_ || beyond_ > 0 || !attitude.settled ||
      static_cast<double>(settled_nodes_) * kFineInterval_s < kSettling_s)
    held.sample.flags |= flag::kSettling;
  locate(attitude, held);
  held_.push_back(held);
  release(sample.utime - std::llround(settings_.fixed_lag_s / kMicrosecond), output);
}

void Realtime::finish(Output& output) {
  if (!held_.empty()) release(held_.back().sample.utime, output);
}

void Realtime::start_path(const ImuSample& sample, const AttitudeSample& attitude) {
  path_.start(sample, attitude);
  whole_.clear();
  started_ = true;
}

// After a gap.
void Realtime::resume(const ImuSample& sample, Output& output) {
  finish(output);  // no later node tells more of what is held
  counter_.gap();
  settled_nodes_ = 0;
  jump_m_ = rest_level_m_ = 0;
  beyond_ = 0;
  calm_.clear();
  rise_.reset();
  const double missing_s = static_cast<double>(sample.utime - path_.last_utime()) * kMicrosecond;
  if (missing_s > kSeaLasts_s) {
    begin_record();
    return;
  }
  filter_.skip(static_cast<int>(std::ceil(std::min(missing_s, kLongestSkip_s) / kFineInterval_s)));
  identifier_.gap();
  end_rethinking();
}

// As if nothing had been seen: of a sea of long ago nothing is believed.
void Realtime::begin_record() {
  identifier_.restart();
  filter_ = HeaveFilter(identifier_.model(), 0, 0);
  first_.clear();
  start_.reset();
  nodes_ = chosen_at_ = thought_at_ = 0;
  old_enough_ = kOldEnough;
  path_.forget_motion();
  rethinks_ = true;
}

void Realtime::end_rethinking() {
  rethinks_ = false;
  first_ = {};
}

// Appends the node intervals that end with the sample.
void Realtime::follow(const ImuSample& sample, const AttitudeSample& attitude,
                      std::vector<HeaveStep>& steps) {
  const std::size_t first = steps.size();
  path_.add(sample, attitude, guard_.usual_interval_s(), steps);
  for (std::size_t i = first; i < steps.size(); ++i) {
    whole_.push_back(steps[i].increment);
    if (std::ssize(whole_) > filter_.order()) whole_.pop_front();
    due_ |= identifier_.add(filter_.without_leaks(steps[i].increment));
    ++nodes_;
  }
}

void Realtime::filter(const HeaveStep& step) {
  const bool was_gone = sea_is_gone();
  remember(step);
  filter_.step(step);
  jump_m_ -= filter_.correction_m();
  ++settled_nodes_;
  if (lost()) {
    find_again();
    return;
  }
  if (!rethinks_ && sea_is_gone()) {
    rest();
    return;
  }
  if (!rethinks_ && (was_gone || filter_.stirs())) {
    rise(calm_.newest());
    forget_sea(true);
    return;
  }
  // A sea that comes up softly surprises no filter of a calm: it is taken for a drift, of which it makes more
  // than noise does.
  if (!rise_ && calm_.drifts_away(filter_) && rises_softly()) return;
  // What comes up in a calm is new, however short the calm was.
  if (!filter_.surprised()) return;
  const bool out_of_calm = identifier_.calm() && (rethinks_ || outgrows_what_stirred());
  if (identifier_.age() > old_enough_ || out_of_calm) {
    // Surprised again at once: what was forgotten was too little to show a sea as slow as this.
    const bool at_once = identifier_.age() < kAtOnce * old_enough_;
    old_enough_ = at_once ? std::min(2 * old_enough_, kOldestEnough) : kOldEnough;
    rise(identifier_.calm() ? calm_.newest() : nullptr);
    forget_sea(identifier_.calm());
  } else if (rethinks_) {
    due_ |= nodes_ > thought_at_ + thought_at_ / kRethoughtAgain;
  }
}

bool Realtime::lost() {
  const double heave_m = std::abs(filter_.heave_m({}, 0));
  const bool unknown = rethinks_ || rise_ || !identifier_.has_spectrum() || filter_.rest_s() > 0;
  const bool beyond = heave_m > kLost * std::sqrt(filter_.model().heave_variance_m2());
  beyond_ = beyond && !unknown ? beyond_ + 1 : 0;
  if (beyond_ > 0) counter_.gap();  // no wave is so high
  const double crest_s = 3 * std::numbers::pi / filter_.model().mean_frequency_radps;
  return static_cast<double>(beyond_) * kFineInterval_s > std::min(crest_s, kLongestCrest_s) ||
         (beyond_ > 0 && heave_m > kLost * filter_.recent_mps2() / square(kSlowest_radps));
}

// The sea is known by its accelerations: path, speed and offset begin anew.
void Realtime::find_again() {
  const double offset_mps2 =
      std::hypot(offset_sigma_mps2(settings_.sensor), kOffsetDoubt * path_.motion().excess_mps2);
  filter_ = HeaveFilter(identifier_.model(), offset_mps2, kScaleDoubt * settings_.sensor.gyro_scale_sigma);
  settled_nodes_ = 0;
  beyond_ = 0;
  jump_m_ = rest_level_m_ = 0;
}

// Before a board is moved it is touched: that was not yet the sea that rises now.
bool Realtime::outgrows_what_stirred() const {
  return rise_ && identifier_.age() > kStirred &&
         filter_.recent_mps2() > std::max(kOutgrown * filter_.model().acceleration_mps2(), kCalm_mps2);
}

bool Realtime::sea_is_gone() const { return filter_.rest_s() > kSeaIsGone_s; }

bool Realtime::calm() const { return identifier_.calm() || sea_is_gone(); }

// What may come up is small beside the level of the rest, which lies anywhere in the sea that was: heave
// counts from there, until it comes.
void Realtime::rest() {
  HeaveFilter resting = filter_;
  rest_level_m_ += resting.count_from_here();
  tell_without_jump(std::move(resting));
  rise_.reset();
  forget_sea(true);
}

void Realtime::learn() {
  const bool was_calm = calm() && calm_.is_long();
  const SeaModel& sea = identifier_.identify();
  if (was_calm && !calm())
    leave_calm();
  else
    filter_.set_model(sea);
}

// Only for a sea that makes the path more probable than the calm does.
void Realtime::leave_calm() {
  if (rises_softly()) {
    rethink_rise();
  } else if (const Calm::Since* onset =
                 calm_.onset(identifier_.model(), rest_level_m_, filter_.log_likelihood())) {
    rise(onset);
    end_rethinking();
    rethink_rise();
  } else {
    identifier_.keep(filter_.model());
  }
}

// A sea of which nothing is known yet but that it was slow enough to hide.
bool Realtime::rises_softly() {
  const Calm::Since* onset = calm_.onset(identifier_.slow_sea(), rest_level_m_, filter_.log_likelihood());
  if (!onset) return false;
  rise(onset);
  forget_sea(true);
  return true;
}

void Realtime::rise(const Calm::Since* onset) {
  chosen_at_ = 0;
  rise_.reset();
  if (onset) rise_ = Rise{calm_, *onset, nodes_};
  calm_.clear();
}

void Realtime::forget_sea(bool calm) {
  chosen_at_ = 0;
  identifier_.forget(calm);
  end_rethinking();
}

void Realtime::remember(const HeaveStep& step) {
  if (rise_) {
    rise_->calm.follow(step);
    rise_->since.steps.push_back(step);
  }
  if (calm())
    calm_.add(filter_, step);
  else
    calm_.clear();
}

// The filter after these steps, from the record's start or out of a calm, had their sea been known.
HeaveFilter Realtime::filtered(const Calm::Since* calm, const std::vector<HeaveStep>& steps,
                               const SeaModel& sea) const {
  if (calm) return Calm::risen(*calm, sea, rest_level_m_);
  const double elapsed_s = static_cast<double>(nodes_) * kFineInterval_s;
  HeaveFilter filter(sea, offset_sigma_mps2(path_.motion(), sea, elapsed_s, settings_.sensor),
                     kScaleDoubt * settings_.sensor.gyro_scale_sigma);
  for (const HeaveStep& step : steps) filter.step(step);
  return filter;
}

// Of some swells that may lie under the sea, with the one which makes the path most probable.
HeaveFilter Realtime::most_probable(const Calm::Since* calm, const std::vector<HeaveStep>& steps) {
  const auto seen = std::ssize(steps);
  const bool choose = identifier_.has_spectrum() ||
                      static_cast<double>(seen) >= kChosenAgain * static_cast<double>(chosen_at_);
  if (choose) chosen_at_ = seen;
  std::optional<HeaveFilter> best;
  double most = 0, chosen = swell_;
  for (const double swell : choose ? std::span<const double>(kSwells) : std::span<const double>(&swell_, 1)) {
    HeaveFilter filter = filtered(calm, steps, identifier_.identify(swell));
    const double log_likelihood = filter.log_likelihood() - kLargeSwell * std::log(swell);
    if (!best || log_likelihood > most) {
      most = log_likelihood;
      best = std::move(filter);
      chosen = swell;
    }
  }
  swell_ = chosen;
  identifier_.keep(best->model());
  return *std::move(best);
}

// The samples so far, levelled by all of them and filtered as if their sea had been known. Attitude of the
// newest.
AttitudeSample Realtime::rethink() {
  const std::vector<AttitudeSample> attitude =
      smooth_attitude(first_, attitude_settings(settings_.sensor), &attitude_, start_ ? &*start_ : nullptr);
  start_ = attitude.front();
  nodes_ = 0;
  path_.forget_motion();
  identifier_.restart();
  start_path(first_.front(), attitude.front());
  std::vector<HeaveStep> steps;
  const std::size_t before = first_.size() - 1 - held_.size();  // those that are answered
  for (std::size_t i = 0; i < first_.size(); ++i) {
    if (i > 0) follow(first_[i], attitude[i], steps);
    if (i >= before && i - before < held_.size()) locate(attitude[i], held_[i - before]);
  }
  due_ = false;
  thought_at_ = nodes_;
  HeaveFilter whole = most_probable(nullptr, steps);
  if (!calm() && calm_.is_long()) {
    leave_calm();
    return attitude.back();
  }
  if (nodes_ > kMayJump)
    tell_without_jump(std::move(whole));
  else
    filter_ = std::move(whole);
  calm_.clear();
  if (calm()) {
    HeaveFilter filter = filtered(nullptr, {}, filter_.model());
    for (const HeaveStep& step : steps) {
      calm_.add(filter, step);
      filter.step(step);
    }
  }
  if (static_cast<double>(nodes_) * kFineInterval_s > kRethought_s || first_.size() > kMostRethought)
    end_rethinking();
  return attitude.back();
}

// A sea that came up, filtered again from the calm on as if it had been known: the first of it was taken for
// drift.
void Realtime::rethink_rise() {
  HeaveFilter risen = most_probable(&rise_->since, rise_->since.steps);
  if (const Calm::Since* onset = rise_->calm.onset(risen.model(), rest_level_m_,
                                                   risen.log_likelihood() + kLikelier, &rise_->since)) {
    rise_->since = *onset;
    risen = Calm::risen(*onset, risen.model(), rest_level_m_);
  }
  tell_without_jump(std::move(risen));
  if (nodes_ - rise_->seen_at <= kRise) return;
  rise_.reset();
  if (!calm()) rest_level_m_ = 0;
}

// Who looks at the waves would take a jump for one of them.
void Realtime::tell_without_jump(HeaveFilter filter) {
  const HeaveFilter before = std::exchange(filter_, std::move(filter));
  const LevelIncrement& partial = path_.partial();
  const double since_s = path_.since_node_s();
  jump_m_ += before.heave_m(partial, since_s) - filter_.heave_m(partial, since_s);
}

// Between which nodes the newest sample lies.
void Realtime::locate(const AttitudeSample& attitude, Held& held) const {
  held.sample.q_NB = attitude.q_NB;
  held.partial = path_.partial();
  held.since_node_s = path_.since_node_s();
  held.tilt_sigma_rad = attitude.tilt_sigma_rad;
  held.node = nodes_;
}

void Realtime::estimate(const Held& held, double systematic_m2, HeaveSample& out) const {
  const auto since = static_cast<int>(nodes_ - held.node);  // nodes, the one before the sample the first
  const int ago = std::min(since, filter_.order() - 1);
  const double t = held.since_node_s;
  double variance;
  if (ago == 0) {
    out.heave_m = filter_.heave_m(held.partial, t);
    out.heave_rate_mps = filter_.heave_rate_mps(held.partial, t);
    variance = filter_.variance_m2(held.partial, t);
  } else {  // between two nodes that are known by now
    const double dt = kFineInterval_s;
    const PathIncrement whole =
        filter_.without_drift(whole_[whole_.size() - static_cast<std::size_t>(ago)], dt);
    const PathIncrement partial = filter_.without_drift(held.partial, t);
    const double from = filter_.lagged_heave_m(ago), to = filter_.lagged_heave_m(ago - 1);
    const double speed = (to - from - whole.path_m) / dt;
    out.heave_m = from + t * speed + partial.path_m;
    out.heave_rate_mps = speed + partial.speed_mps;
    variance = filter_.lagged_variance_m2(ago - 1);
  }
  out.heave_m += jump_m_;
  // Of that its sea reaches little, as long as it is there and until path and drift begin anew.
  if (beyond_ > 0) variance += square(out.heave_m);
  out.heave_sigma_m = std::sqrt(identifier_.doubt() * variance + square(jump_m_) + systematic_m2);
}

void Realtime::release(std::int64_t until_utime, Output& output) {
  while (!held_.empty() && held_.front().sample.utime <= until_utime) {
    HeaveSample out = held_.front().sample;
    const double systematic_m2 = systematic_variance_m2(filter_.model(), path_.motion(), settings_.sensor);
    estimate(held_.front(), systematic_m2, out);
    output.heave(out);
    if (const auto wave = counter_.add(out, std::sqrt(systematic_m2), held_.front().tilt_sigma_rad))
      output.wave(*wave);
    held_.pop_front();
  }
}

}  // namespace waverig::estimator
