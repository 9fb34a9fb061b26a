#include "estimator/evaluation/heave_against_truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "estimator/evaluation/even_series.h"
#include "estimator/evaluation/high_pass.h"
#include "lcmtypes/error.h"

namespace waverig::evaluation {

HeaveComparison compare_with_truth(const HeaveSeries& heave, const HeaveSeries& truth,
                                   const AgainstTruthSettings& settings) {
  Interpolated estimate(heave.utime, heave.heave_m), reference(truth.utime, truth.heave_m);
  if (estimate.known() == 0 || reference.known() == 0 || truth.utime.size() < 3)
    throw UserError("heave and truth: one of them holds no heave; expected two series of one record");
  const std::int64_t begin = std::max(estimate.begin(), reference.begin()),
                     end = std::min(estimate.end(), reference.end());
  const std::int64_t step = median_interval(truth.utime);
  if (end - begin < 10 * step)
    throw UserError("heave and truth: they do not overlap in time; expected two series of one record");

  if (mostly_gap(begin, end, step, truth.utime.size()))
    throw UserError("truth: nearly all of its time is gap; expected a series without hours between its rows");

  // An even grid over the common time, both series on it, filtered alike.
  const auto count = static_cast<std::size_t>((end - begin) / step) + 1;
  std::vector<double> h(count), t(count);
  std::vector<bool> told(count);  // not only by the straight line over a gap
  const std::int64_t longest = longest_step(truth.utime),
                     longest_told = heave.utime.size() < 2 ? 0 : longest_step(heave.utime);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t utime = begin + static_cast<std::int64_t>(i) * step;
    h[i] = estimate.at(utime);
    t[i] = reference.at(utime);
    told[i] = estimate.bridged() <= longest_told && reference.bridged() <= longest;
  }
  const double rate_hz = 1 / (static_cast<double>(step) * kMicrosecond);
  if (!(settings.high_pass_hz < rate_hz / 2))
    throw UserError(fmt::format("--high-pass-hz {:g}: expected less than {:g}, half the rate of the truth",
                                settings.high_pass_hz, rate_hz / 2));
  if (settings.high_pass_hz > 0) {
    h = high_passed(h, rate_hz, settings.high_pass_hz);
    t = high_passed(t, rate_hz, settings.high_pass_hz);
  }

  HeaveComparison comparison;
  std::size_t row = 0;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const std::int64_t utime = begin + static_cast<std::int64_t>(i) * step;
    while (row + 1 < truth.utime.size() && truth.utime[row + 1] <= utime) ++row;
    const bool known =
        std::isfinite(truth.heave_m[row]) &&
        (row + 1 == truth.utime.size() || truth.utime[row] == utime || std::isfinite(truth.heave_m[row + 1]));
    if (!known || !told[i] || (!truth.moving.empty() && !truth.moving[row])) continue;
    comparison.add(h[i], t[i], (t[i + 1] - t[i - 1]) * rate_hz / 2);
  }
  if (comparison.samples() == 0)
    throw UserError(
        "heave and truth: nothing to compare between gaps and where the truth does not move; expected "
        "some time in which both tell heave");
  return comparison;
}

}  // namespace waverig::evaluation
