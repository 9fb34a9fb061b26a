// A float on an irregular sea, with a data-sheet sensor: samples and truth. The sea comes from motion/sea_state.h, of
// which the estimator knows nothing.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "estimator/method.h"
#include "motion/sea_state.h"
#include "tests/estimator/synthetic_waves.h"

namespace waverig::testing {

struct SeaCase {
  double tp_s = 8, hm0_m = 1.5;
  double duration_s = 1200, rate_Hz = 100;
  double slope_following = 1;
  double swell_tp_s = 0, swell_hm0_m = 0;  // another sea under it, from elsewhere
  double tail_end = 5;                     // peak frequencies
  bool perfect_sensor = false, long_crested = false;
  double gyro_scale = estimator::kUnknown;   // relative error; drawn where unknown
};

struct SeaRecord {
  std::vector<estimator::ImuSample> samples;
  std::vector<double> heave_m, heave_rate_mps;
  std::vector<Quaterniond> q_NB;
};

// What a six-position calibration leaves (SensorKnowledge's defaults) and a data-sheet gyro.
inline SensorErrors calibrated_errors(std::uint64_t seed) {
  const estimator::SensorKnowledge knowledge;
  RandomStream stream(seed, "calibration");
  SensorErrors e = random_errors(stream, knowledge.accel_bias_sigma_mps2, knowledge.accel_scale_sigma,
                                 knowledge.accel_misalignment_sigma_rad, knowledge.gyro_bias_sigma_radps);
  e.gyro_scale = stream.gaussian(knowledge.gyro_scale_sigma);
  return e;
}

inline motion::SeaSettings sea_settings(double tp_s, double hm0_m, std::uint64_t seed) {
  motion::SeaSettings sea;
  sea.tp_s = tp_s;
  sea.hm0_m = hm0_m;
  sea.direction_from_rad = 1.0;
  sea.spreading_s = 10;
  sea.components = 250;
  sea.random_amplitudes = true;
  sea.exact_hm0 = false;
  sea.seed = seed;
  return sea;
}

// The sensor on a body whose motion at a time is motion(utime).
template <class Motion>
SeaRecord recorded(const SeaCase& c, std::uint64_t seed, Motion motion) {
  const SensorErrors e = c.perfect_sensor ? SensorErrors{.accel_noise_mps2_rthz = 0, .gyro_noise_radps_rthz = 0}
                                          : calibrated_errors(seed);
  const double gyro_scale = std::isfinite(c.gyro_scale) ? c.gyro_scale : e.gyro_scale;
  RandomStream noise(seed, "noise");
  const double accel_sigma = e.accel_noise_mps2_rthz * std::sqrt(0.5 * c.rate_Hz);
  const double gyro_sigma = e.gyro_noise_radps_rthz * std::sqrt(0.5 * c.rate_Hz);
  const Vector3d g_N(0, 0, kStandardGravity);
  const auto white = [&](double sigma) -> Vector3d {
    return {noise.gaussian(sigma), noise.gaussian(sigma), noise.gaussian(sigma)};
  };
  SeaRecord record;
  const auto count = static_cast<std::size_t>(c.duration_s * c.rate_Hz);
  for (std::size_t i = 0; i < count; ++i) {
    const auto utime = 1'000'000 + std::llround(static_cast<double>(i) / c.rate_Hz / kMicrosecond);
    const BodyMotion m = motion(utime);
    const Vector3d f = specific_force_B(m, g_N);
    estimator::ImuSample sample;
    sample.utime = utime;
    sample.seq = static_cast<std::int64_t>(i);
    sample.f_B = f + e.E * f + e.b_mps2 + white(accel_sigma);
    sample.w_NB_B = (1 + gyro_scale) * m.w_NB_B + e.gyro_bias_radps + white(gyro_sigma);
    record.samples.push_back(sample);
    record.heave_m.push_back(waverig::heave_m(m));
    record.heave_rate_mps.push_back(-m.velocity_N.z());
    record.q_NB.push_back(m.q_NB);
  }
  return record;
}

inline SeaRecord sea_record(const SeaCase& c, std::uint64_t seed) {
  motion::SeaSettings sea = sea_settings(c.tp_s, c.hm0_m, seed);
  sea.highest_relative = c.tail_end;
  if (c.long_crested) sea.spreading_s = 0;
  auto components = motion::draw_components(sea);
  if (c.swell_hm0_m > 0) {
    auto swell = sea_settings(c.swell_tp_s, c.swell_hm0_m, seed + 1000);
    swell.direction_from_rad = 2.5;
    for (const auto& component : motion::draw_components(swell)) components.push_back(component);
  }
  motion::FloatSettings body;
  body.slope_following = c.slope_following;
  body.heading_rad = 0.4;
  return recorded(c, seed, [motion = motion::SeaMotion(std::move(components), body)](std::int64_t utime) mutable {
    return motion.at(utime);
  });
}

// The same on a body that turns about its own vertical, once in turn_s.
inline SeaRecord turning_record(const SeaCase& c, double turn_s, std::uint64_t seed) {
  motion::FloatSettings body;
  body.slope_following = c.slope_following;
  motion::SeaMotion sea(motion::draw_components(sea_settings(c.tp_s, c.hm0_m, seed)), body);
  const Vector3d rate_B(0, 0, 2 * kPi / turn_s);
  return recorded(c, seed, [=](std::int64_t utime) mutable {
    BodyMotion m = sea.at(utime);
    const Quaterniond turned = quaternion_exp(static_cast<double>(utime) * kMicrosecond * rate_B);
    m.w_NB_B = turned.conjugate() * m.w_NB_B + rate_B;
    m.q_NB = m.q_NB * turned;
    return m;
  });
}

// From 0 to 1, smoothly, with its derivatives by time.
struct Ramp {
  double w, dw, ddw;
};
inline Ramp ramp(double t_s, double begins_s, double over_s) {
  const double x = std::clamp((t_s - begins_s) / over_s, 0.0, 1.0);
  return {x * x * x * (10 - 15 * x + 6 * x * x), 30 * x * x * (1 - x) * (1 - x) / over_s,
          60 * x * (1 - x) * (1 - 2 * x) / (over_s * over_s)};
}

// A body that stays level in one sea until another has taken its place, smoothly from begins_s on over rises_s; c is the
// second sea.
inline SeaRecord changing_record(const SeaCase& first, const SeaCase& c, double begins_s, double rises_s,
                                 std::uint64_t seed) {
  motion::FloatSettings level;
  level.slope_following = 0;
  motion::SeaMotion before(motion::draw_components(sea_settings(first.tp_s, first.hm0_m, seed)), level),
      after(motion::draw_components(sea_settings(c.tp_s, c.hm0_m, seed + 1000)), level);
  return recorded(c, seed, [=](std::int64_t utime) mutable {
    const BodyMotion a = before.at(utime), b = after.at(utime);
    const Ramp r = ramp(static_cast<double>(utime) * kMicrosecond, begins_s, rises_s);
    BodyMotion m = a;
    m.position_N += r.w * (b.position_N - a.position_N);
    m.velocity_N += r.w * (b.velocity_N - a.velocity_N) + r.dw * (b.position_N - a.position_N);
    m.acceleration_N += r.w * (b.acceleration_N - a.acceleration_N) + 2 * r.dw * (b.velocity_N - a.velocity_N) +
                        r.ddw * (b.position_N - a.position_N);
    return m;
  });
}

// The same, with a rest between the runs: each lasts c.duration_s and begins and ends within ramp_s, runs of the first
// sea and of the second taking turns. The rests are level_m below the mean level of the runs. Where each run begins is in
// begins_s.
struct RunsAndRests {
  SeaRecord record;
  std::vector<double> begins_s;
};
inline RunsAndRests runs_and_rests(const SeaCase& first, SeaCase c, double rest_s, int runs, std::uint64_t seed,
                                   double level_m = 0, double ramp_s = 1) {
  constexpr double kFirst_s = 21;
  motion::FloatSettings level;
  level.slope_following = 0;
  motion::SeaMotion odd(motion::draw_components(sea_settings(first.tp_s, first.hm0_m, seed)), level),
      even(motion::draw_components(sea_settings(c.tp_s, c.hm0_m, seed + 1000)), level);
  RunsAndRests result;
  double end_s = kFirst_s;
  for (int i = 0; i < runs; ++i) {
    result.begins_s.push_back(end_s);
    end_s += rest_s + (i % 2 == 0 ? first : c).duration_s;
  }
  c.duration_s = end_s;
  result.record = recorded(c, seed, [=, begins_s = result.begins_s](std::int64_t utime) mutable {
    const double t_s = static_cast<double>(utime) * kMicrosecond;
    const auto next = std::upper_bound(begins_s.begin() + 1, begins_s.end(), t_s);
    const double stops_s = (next == begins_s.end() ? end_s : *next) - rest_s - ramp_s;
    const Ramp up = ramp(t_s, *(next - 1), ramp_s), down = ramp(t_s, stops_s, ramp_s);
    const Ramp r{up.w - down.w, up.dw - down.dw, up.ddw - down.ddw};
    BodyMotion m = ((next - begins_s.begin()) % 2 == 1 ? odd : even).at(utime);
    m.position_N.z() -= level_m;
    m.acceleration_N = r.w * m.acceleration_N + 2 * r.dw * m.velocity_N + r.ddw * m.position_N;
    m.velocity_N = r.w * m.velocity_N + r.dw * m.position_N;
    m.position_N *= r.w;
    return m;
  });
  return result;
}

using estimator::square;

// Of an estimate against the truth from sample `begin` to `end`, mean removed; as a part of 4 std of the whole truth.
inline double rms_over_hm0(const std::vector<estimator::HeaveSample>& estimate, const SeaRecord& record,
                           std::size_t begin, std::size_t end) {
  double sum = 0, squares = 0, truth = 0, truth2 = 0;
  for (const double z : record.heave_m) truth += z, truth2 += z * z;
  const auto all = static_cast<double>(record.heave_m.size());
  for (std::size_t i = begin; i < end; ++i) {
    const double error = estimate[i].heave_m - record.heave_m[static_cast<std::size_t>(estimate[i].seq)];
    sum += error;
    squares += error * error;
  }
  const auto n = static_cast<double>(end - begin);
  return std::sqrt(squares / n - square(sum / n)) / (4 * std::sqrt(truth2 / all - square(truth / all)));
}

inline double tilt_between(const Quaterniond& a, const Quaterniond& b) {
  const Vector3d u = a.conjugate() * Vector3d::UnitZ(), v = b.conjugate() * Vector3d::UnitZ();
  return std::atan2(u.cross(v).norm(), u.dot(v));
}

}  // namespace waverig::testing
