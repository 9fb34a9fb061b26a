#include "estimator/evaluation/run_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/evaluation/bound.h"
#include "estimator/evaluation/even_series.h"
#include "estimator/evaluation/height_statistics.h"
#include "estimator/evaluation/run_record.h"
#include "estimator/evaluation/true_direction.h"
#include "estimator/evaluation/zero_crossing.h"
#include "lcmtypes/flags.h"
#include "lcmtypes/phase.h"

namespace waverig::evaluation {
namespace {

struct TrueSea {
  double hm0_m = estimator::kUnknown, tm02_s = estimator::kUnknown;
};

constexpr double kLongestSpan_s = 1e6;  // of a wave or a sea state; messages of a bus are not to be trusted

// End of a span; none where its length is no plausible one, or the time itself is not.
std::optional<std::int64_t> end_of(std::int64_t begin_utime, double length_s) {
  constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max() / 2;
  if (!(length_s > 0) || !(length_s < kLongestSpan_s) || std::abs(begin_utime / 2) > kLatest / 2)
    return std::nullopt;
  return begin_utime + std::llround(length_s / kMicrosecond);
}

TrueSea true_sea(const TruthSeries& truth, std::int64_t begin, std::int64_t end) {
  double n = 0, h = 0, hh = 0, r = 0, rr = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth.utime(i) < begin || truth.utime(i) >= end) continue;
    const auto p = truth.point(i);
    n += 1;
    h += p.heave_m;
    hh += p.heave_m * p.heave_m;
    r += p.heave_rate_mps;
    rr += p.heave_rate_mps * p.heave_rate_mps;
  }
  if (n < 2) return {};
  const double m0 = hh / n - h * h / (n * n), m2 = rr / n - r * r / (n * n);  // m2 in (m rad/s)^2
  return {4 * std::sqrt(m0), 2 * std::numbers::pi * std::sqrt(m0 / m2)};
}

}  // namespace

RunJudge::RunJudge(std::string run, const JudgeSettings& settings)
    : run_(std::move(run)), settings_(settings) {}

RunJudge::OfMethod& RunJudge::of(std::string_view method) {
  const auto at = methods_.find(method);
  if (at != methods_.end()) return at->second;
  OfMethod& added = methods_.emplace(method, OfMethod{}).first->second;
  added.tells_waves = settings_.tells_waves(method);
  return added;
}

void RunJudge::add(const run_t& message) {
  period_s_ = message.period_s;
  height_m_ = message.height_m;
  repeat_ = message.repeat;
  if (message.phase == static_cast<std::int32_t>(Phase::kSteady)) {
    if (!begun_) steady_begin_ = message.utime;
    begun_ = true;
  } else if (begun_ && !ended_) {
    steady_end_ = message.utime;
    ended_ = true;
  }
}

void RunJudge::add(const truth_t& message) {
  truth_.add(message.utime, message.heave_m, message.heave_rate_mps, {message.north_m, message.east_m});
  for (auto& [name, method] : methods_)
    if (!method.pending.empty()) settle(method);
}

void RunJudge::add(std::string_view method, const estimator::HeaveSample& heave) {
  if (!steady(heave.utime) || !std::isfinite(heave.heave_m)) return;
  OfMethod& m = of(method);
  const Heave sample{heave.utime, heave.heave_m, heave.heave_sigma_m};
  if (!m.tells_waves && m.waves.empty() && (m.series.empty() || m.series.back().utime < sample.utime))
    m.series.push_back(sample);
  if (truth_.empty() || truth_.last_utime() < heave.utime)
    m.pending.push_back(sample);
  else
    compare(m.comparison, sample);
}

void RunJudge::add(std::string_view method, const estimator::Wave& wave) {
  OfMethod& m = of(method);
  if (!m.waves.empty() && m.waves.back().start_utime == wave.start_utime) return;  // sent twice
  m.waves.push_back(wave);
}

void RunJudge::add(std::string_view method, const estimator::SeaState& sea) {
  of(method).seas.push_back(sea);
}

bool RunJudge::steady(std::int64_t utime) const {
  return begun_ && utime >= steady_begin_ && (!ended_ || utime < steady_end_);
}

void RunJudge::settle(OfMethod& method) {
  std::erase_if(method.pending, [&](const Heave& heave) {
    if (heave.utime > truth_.last_utime()) return false;
    compare(method.comparison, heave);
    return true;
  });
}

void RunJudge::compare(HeaveComparison& comparison, const Heave& heave) const {
  const TruthSeries::Point truth = truth_.at(heave.utime);
  if (std::isfinite(truth.heave_m))
    comparison.add(heave.heave_m, truth.heave_m, truth.heave_rate_mps, heave.sigma_m);
}

std::vector<RunResult> RunJudge::finish() {
  if (begun_ && !ended_ && !truth_.empty()) steady_end_ = truth_.last_utime() + 1;
  std::vector<RunResult> results;
  for (auto& [name, method] : methods_) results.push_back(result_of(name, method));
  return results;
}

std::vector<estimator::Wave> RunJudge::counted_waves(const OfMethod& method) {
  std::vector<std::int64_t> utime;
  std::vector<double> heave_m, sigma_m;
  for (const Heave& heave : method.series) {
    utime.push_back(heave.utime);
    heave_m.push_back(heave.heave_m);
    sigma_m.push_back(heave.sigma_m);
  }
  return waves_of(count_waves(utime, heave_m, {.interpolate_extremes = true}, sigma_m));
}

double RunJudge::covered_s(const OfMethod& method) const {
  std::vector<std::int64_t> utime = {steady_begin_};
  for (const Heave& heave : method.series) utime.push_back(heave.utime);
  utime.push_back(steady_end_);
  const std::int64_t longest = longest_step(utime);
  std::int64_t covered = 0;
  for (std::size_t i = 1; i < utime.size(); ++i)
    if (const std::int64_t step = utime[i] - utime[i - 1]; step <= longest) covered += step;
  return static_cast<double>(covered) * kMicrosecond;
}

RunResult RunJudge::result_of(const std::string& name, OfMethod& method) const {
  RunResult result;
  result.run = run_;
  result.method = name;
  result.repeat = repeat_;
  result.period_s = period_s_;
  result.height_m = height_m_;
  result.motion = settings_.motion;
  result.noise_density_mps2_rthz = settings_.noise_density_mps2_rthz;
  for (const estimator::SeaState& sea : method.seas) {
    const auto end = end_of(sea.start_utime, sea.duration_s);
    const TrueSea truth = end ? true_sea(truth_, sea.start_utime, *end) : TrueSea{};
    result.seas.push_back({.sea = sea, .true_hm0_m = truth.hm0_m, .true_tm02_s = truth.tm02_s});
    if (end && std::isfinite(sea.mean_direction_rad))
      result.seas.back().direction = true_direction(truth_, std::max(sea.start_utime, steady_begin_),
                                                    ended_ ? std::min(*end, steady_end_) : *end);
  }

  const double steady_s = static_cast<double>(steady_end_ - steady_begin_) * kMicrosecond;
  if (!method.tells_waves && method.waves.empty() && !method.series.empty() && steady_s > 0) {
    method.waves = counted_waves(method);
    result.heave_coverage = covered_s(method) / steady_s;
  }
  HeightAccumulator accumulator;
  for (const estimator::Wave& wave : method.waves) {
    const auto end = end_of(wave.start_utime, wave.period_s);
    const bool whole = end && (wave.flags & flag::kIncomplete) == 0 && std::isfinite(wave.height_m);
    if (!whole || !begun_ || wave.start_utime < steady_begin_ || *end > steady_end_) {
      ++result.excluded_waves;
      continue;
    }
    result.waves.push_back({wave, truth_.height_m(wave.start_utime, *end)});
    accumulator.add(result.waves.back());
  }
  accumulator.close_record();
  const double bound_m =
      height_bound_m({period_s_, settings_.noise_density_mps2_rthz, settings_.sample_rate_hz});
  result.statistics = accumulator.statistics(height_m_, bound_m);
  if ((1 - result.heave_coverage) * steady_s > period_s_) result.statistics.flags |= flag::kGap;

  if (begun_) {
    const TrueSea sea = true_sea(truth_, steady_begin_, steady_end_);
    result.true_hm0_m = sea.hm0_m;
    result.true_tm02_s = sea.tm02_s;
  }
  result.heave_rmse_m = method.comparison.rmse_m();
  if (const auto bound = settings_.heave_bound_m.find(name); bound != settings_.heave_bound_m.end())
    result.heave_bound_m = bound->second;
  result.heave_gain = method.comparison.gain();
  result.heave_lag_s = method.comparison.lag_s();
  result.heave_sigma_ratio = method.comparison.sigma_ratio();
  return result;
}

std::vector<RunResult> judge(const RunRecord& record, const JudgeSettings& settings) {
  RunJudge judge(record.run, settings);
  run_t phase{};
  phase.repeat = record.repeat;
  phase.period_s = record.period_s;
  phase.height_m = record.height_m;
  phase.utime = record.steady_begin_utime;
  phase.phase = static_cast<std::int32_t>(Phase::kSteady);
  judge.add(phase);
  phase.utime = record.steady_end_utime;
  phase.phase = static_cast<std::int32_t>(Phase::kRampOut);
  judge.add(phase);
  for (const TruthSample& sample : record.truth) {
    truth_t truth{};
    truth.utime = sample.utime;
    truth.heave_m = sample.heave_m;
    truth.heave_rate_mps = sample.heave_rate_mps;
    truth.north_m = sample.north_m;
    truth.east_m = sample.east_m;
    judge.add(truth);
  }
  for (const auto& [method, samples] : record.heave)
    for (const estimator::HeaveSample& heave : samples) judge.add(method, heave);
  for (const auto& [method, waves] : record.waves)
    for (const estimator::Wave& wave : waves) judge.add(method, wave);
  for (const auto& [method, seas] : record.seas)
    for (const estimator::SeaState& sea : seas) judge.add(method, sea);
  return judge.finish();
}

}  // namespace waverig::evaluation
