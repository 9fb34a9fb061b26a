#include "estimator/heave/heave_steps.h"

#include <algorithm>
#include <utility>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kMotionMemory_s = 120;

}  // namespace

HeaveSteps::HeaveSteps(const SensorKnowledge& sensor) : sensor_(sensor), integrator_(kFineInterval_s) {}

double HeaveSteps::MeanForce::change_mps2() {
  const Vector3d mean_B = count > 0 ? Vector3d(sum_B / count) : before_B;
  const double change = (mean_B - std::exchange(before_B, mean_B)).norm();
  sum_B.setZero();
  count = 0;
  return change;
}

void HeaveSteps::forget_motion() {
  motion_ = {};
  samples_ = 0;
}

void HeaveSteps::start(const ImuSample& sample, const AttitudeSample& attitude) {
  integrator_.start(sample.utime, {-attitude.a_N.z(), 0, 0});
  disturbance_ = {};
  force_ = {};
}

void HeaveSteps::add(const ImuSample& sample, const AttitudeSample& attitude, double interval_s,
                     std::vector<HeaveStep>& steps) {
  motion_.follow(attitude, std::max(1.0 / static_cast<double>(++samples_), interval_s / kMotionMemory_s));
  disturbance_.add(disturbance_m2ps3(attitude, sample.flags, sensor_.gravity_mps2) +
                   turned_offset_m2ps3(attitude, motion_, sensor_));
  if (sample.flags & flag::kGap)
    disturbance_.add_gap(
        unseen_speed_mps(static_cast<double>(sample.utime - integrator_.last_utime()) * kMicrosecond),
        kFineInterval_s);
  force_.add(sample.f_B);
  Eigen::Array3d up;
  up << -attitude.a_N.z(), gyro_scale_leaks_mps2(attitude, motion_, sample.f_B);
  integrator_.add(sample.utime, up, [&](std::int64_t, const LevelIncrement& increment) {
    steps.push_back({increment, disturbance_.mean(), force_.change_mps2()});
    disturbance_ = {};
  });
}

}  // namespace waverig::estimator
