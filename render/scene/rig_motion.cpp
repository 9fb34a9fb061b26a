#include "render/scene/rig_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lcmtypes/error.h"
#include "render/figures/run_time.h"

namespace waverig::render {
namespace {

// The sample at or before a time; the first where all are later.
template <class Sample>
std::size_t index_at(const std::vector<Sample>& samples, std::int64_t utime) {
  const auto after = std::upper_bound(samples.begin(), samples.end(), utime,
                                      [](std::int64_t t, const Sample& s) { return t < s.utime; });
  return after == samples.begin() ? 0 : static_cast<std::size_t>(after - samples.begin()) - 1;
}

// Share of the way from sample i to the next.
template <class Sample>
double share_at(const std::vector<Sample>& samples, std::size_t i, std::int64_t utime) {
  if (i + 1 >= samples.size() || samples[i + 1].utime <= samples[i].utime) return 0;
  return std::clamp(static_cast<double>(utime - samples[i].utime) /
                        static_cast<double>(samples[i + 1].utime - samples[i].utime),
                    0.0, 1.0);
}

struct Offset {
  double mean_m = 0, rms_m = 0;
  std::size_t n = 0;
};

Offset offset_from_truth(const evaluation::RunRecord& run, const std::vector<estimator::HeaveSample>& heave) {
  const bool any_steady = run.steady_end_utime > run.steady_begin_utime;
  double sum = 0, squares = 0;
  std::size_t n = 0;
  for (const estimator::HeaveSample& sample : heave) {
    if (any_steady && (sample.utime < run.steady_begin_utime || sample.utime >= run.steady_end_utime))
      continue;
    if (!std::isfinite(sample.heave_m)) continue;
    const std::size_t i = index_at(run.truth, sample.utime);
    const double k = share_at(run.truth, i, sample.utime);
    const double truth_m =
        run.truth[i].heave_m +
        k * (run.truth[std::min(i + 1, run.truth.size() - 1)].heave_m - run.truth[i].heave_m);
    sum += sample.heave_m - truth_m;
    squares += (sample.heave_m - truth_m) * (sample.heave_m - truth_m);
    ++n;
  }
  if (n == 0) return {};
  const double count = static_cast<double>(n), mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean)), n};
}

}  // namespace

std::string nearest_method(const evaluation::RunRecord& run) {
  std::string best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [method, heave] : run.heave) {
    const Offset offset = offset_from_truth(run, heave);
    if (offset.n == 0 || offset.rms_m >= least) continue;
    least = offset.rms_m;
    best = method;
  }
  return best;
}

RigMotion::RigMotion(const evaluation::RunRecord& run, const std::string& method, int color)
    : run_(run), method_(method), color_(color), on_sea_(is_on_sea(run)) {
  if (run.truth.empty())
    throw UserError("run " + run.run + ": it holds no truth of the rig, so there is nothing to show");
  if (method_.empty()) method_ = nearest_method(run);
  if (!method_.empty()) {
    const auto it = run.heave.find(method_);
    if (it == run.heave.end()) {
      std::string known;
      for (const auto& [name, samples] : run.heave) known += (known.empty() ? "" : ", ") + name;
      throw UserError("--method " + method_ + ": run " + run.run + " holds no heave of it; expected one of " +
                      known);
    }
    heave_ = &it->second;
    mean_heave_m_ = offset_from_truth(run, *heave_).mean_m;
  }
  find_azimuth();
}

// The horizontal way of the sensor follows the arm's cosine: its direction is
// the arm's azimuth.
void RigMotion::find_azimuth() {
  double north = 0, east = 0, highest = -1e9, lowest = 1e9;
  for (const evaluation::TruthSample& s : run_.truth) {
    const double c = std::cos(s.arm_angle_rad);
    if (std::isfinite(c)) {
      north += s.north_m * c;
      east += s.east_m * c;
    }
    highest = std::max(highest, s.heave_m);
    lowest = std::min(lowest, s.heave_m);
  }
  if (north != 0 || east != 0) azimuth_rad_ = std::atan2(east, north);
  // The arm is as long as it was set; no length is set of a sea, whose highest waves go far beyond half of
  // Hm0.
  if (on_sea_)
    radius_m_ = std::max({0.05, highest, -lowest});
  else
    radius_m_ = run_.height_m > 0 ? 0.5 * run_.height_m : std::max(0.05, 0.5 * (highest - lowest));
}

double RigMotion::begin_s() const {
  return run_.steady_end_utime > run_.steady_begin_utime
             ? static_cast<double>(run_.steady_begin_utime - run_.start_utime) * kMicrosecond
             : 0;
}

double RigMotion::end_s() const {
  const std::int64_t end =
      run_.steady_end_utime > run_.steady_begin_utime ? run_.steady_end_utime : run_.truth.back().utime;
  return static_cast<double>(end - run_.start_utime) * kMicrosecond;
}

double RigMotion::crest_near_s(double time_s) const {
  const double half_s = 0.5 * run_.period_s;
  double crest_s = time_s, highest_m = -std::numeric_limits<double>::infinity();
  for (const evaluation::TruthSample& s : run_.truth) {
    const double at_s = since_start_s(run_, s.utime);
    if (std::abs(at_s - time_s) > half_s || s.heave_m <= highest_m) continue;
    highest_m = s.heave_m;
    crest_s = at_s;
  }
  return crest_s;
}

RigInstant RigMotion::at(double time_s) const {
  RigInstant instant{.time_s = time_s};
  const std::int64_t utime = run_.start_utime + std::llround(time_s / kMicrosecond);
  // From navigation (north, east, down) to scene (along, across, up).
  const double c = std::cos(azimuth_rad_), s = std::sin(azimuth_rad_);
  Matrix3d R_SN;
  R_SN << c, s, 0, s, -c, 0, 0, 0, -1;
  const Quaterniond q_SN(R_SN);
  const std::size_t i = index_at(run_.truth, utime), next = std::min(i + 1, run_.truth.size() - 1);
  const evaluation::TruthSample &a = run_.truth[i], &b = run_.truth[next];
  const double k = share_at(run_.truth, i, utime);
  const Vector3d a_N(a.north_m, a.east_m, -a.heave_m), b_N(b.north_m, b.east_m, -b.heave_m);
  instant.sensor_m = R_SN * (a_N + k * (b_N - a_N));
  instant.arm_angle_rad = std::isfinite(a.arm_angle_rad)
                              ? a.arm_angle_rad + k * (b.arm_angle_rad - a.arm_angle_rad)
                              : std::atan2(instant.sensor_m.z(), instant.sensor_m.x());
  instant.q_SB = q_SN * a.q_NB.slerp(k, b.q_NB);
  if (heave_ != nullptr && !heave_->empty()) {
    const std::size_t j = index_at(*heave_, utime), after = std::min(j + 1, heave_->size() - 1);
    const estimator::HeaveSample &e = (*heave_)[j], &f = (*heave_)[after];
    const double m = share_at(*heave_, j, utime);
    instant.estimated_heave_m = e.heave_m + m * (f.heave_m - e.heave_m) - mean_heave_m_;
    Euler tilt = euler_of(e.q_NB.slerp(m, f.q_NB));
    tilt.yaw_rad = euler_of(a.q_NB).yaw_rad;  // most methods know no heading:
                                              // theirs is not what is compared
    instant.estimated_q_SB = q_SN * quaternion_of(tilt);
    instant.estimated = std::isfinite(instant.estimated_heave_m);
  }
  return instant;
}

}  // namespace waverig::render
