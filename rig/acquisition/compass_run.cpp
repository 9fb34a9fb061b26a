#include "rig/acquisition/compass_run.h"

#include <cmath>

#include "lcmtypes/error.h"
#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

// The sensor on its turntable, which knows its own angles and nothing of north.
class Turntable {
 public:
  Turntable(const UnitSettings& settings, const UnitParameters& unit, Acquisition acquisition,
            std::uint64_t seed, const CompassRunSettings& run)
      : run_(run),
        step_s_(settings.sample_interval_s),
        sensor_(settings, unit, seed),
        acquisition_(std::move(acquisition)),
        fixture_(seed, "compass fixture"),
        zero_(quaternion_of({0, 0, run.turntable_zero_rad})) {
    motion_.utime = run.begin_utime;
    motion_.position_N = run.position_N_m;
  }

  // Turns through the attitudes and keeps the mean reading at each; returns those of the field.
  std::vector<Vector3d> turn(const std::vector<Quaterniond>& attitudes, CompassRun& into) {
    std::vector<Vector3d> turned_uT;
    for (const Quaterniond& attitude : attitudes) {
      const Vector3d miss(fixture_.gaussian(run_.fixture_sigma_rad),
                          fixture_.gaussian(run_.fixture_sigma_rad),
                          fixture_.gaussian(run_.fixture_sigma_rad));
      motion_.q_NB = zero_ * attitude * quaternion_exp(miss);
      if (!started_) sensor_.step(motion_, 0, bytes_);
      started_ = true;
      const Mean mean = dwell();
      turned_uT.push_back(mean.raw_uT);
      into.raw_uT.push_back(mean.raw_uT);
      into.f_B.push_back(mean.f_B);
    }
    return turned_uT;
  }
  std::int64_t utime() const { return motion_.utime; }

 private:
  struct Mean {
    Vector3d raw_uT = Vector3d::Zero(), f_B = Vector3d::Zero();
    double samples = 0;
  };
  Mean dwell() {
    Mean mean;
    const std::int64_t settled_utime = motion_.utime + std::llround(run_.settle_s / kMicrosecond);
    const std::int64_t end_utime = settled_utime + std::llround(run_.record_s / kMicrosecond);
    while (motion_.utime < end_utime) {
      motion_.utime += std::llround(step_s_ / kMicrosecond);
      sensor_.step(motion_, step_s_, bytes_);
      acquisition_.add(bytes_, [&](const UnitCounts& counts, const estimator::ImuSample& sample) {
        if (counts.utime < settled_utime || (sample.flags & flag::kNoMagnetometer) != 0) return;
        mean.raw_uT += sample.m_B_uT;
        mean.f_B += sample.f_B;
        mean.samples += 1;
      });
      bytes_.clear();
    }
    if (mean.samples == 0)
      throw UserError("compass calibration: the magnetometer gives no field: expected one within its range");
    mean.raw_uT /= mean.samples;
    mean.f_B /= mean.samples;
    return mean;
  }

  CompassRunSettings run_;
  double step_s_;
  SimulatedUnit sensor_;
  Acquisition acquisition_;
  RandomStream fixture_;
  Quaterniond zero_;
  BodyMotion motion_;
  bool started_ = false;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

CompassRun turn_compass(const UnitSettings& settings, const UnitParameters& unit, Acquisition acquisition,
                        std::uint64_t seed, const CompassRunSettings& run) {
  Turntable turntable(settings, unit, std::move(acquisition), seed, run);
  CompassRun result;
  // 1. Level, about z: magnetic north, and the extremes of the horizontal field.
  result.north_rad =
      estimator::north_from_level_turn(turntable.turn(estimator::level_turn(run.steps), result));
  // 2. x in the magnetic meridian, about y: x and z visit the field's full length. 3. y in it, about x: y
  // does.
  turntable.turn(estimator::pitch_turn(result.north_rad, run.steps), result);
  turntable.turn(estimator::roll_turn(result.north_rad, run.steps), result);
  // 4. Not the document's: in its three turns field and gravity never leave one plane of the body together,
  // and a turn of the triad about z cannot be told. Rolled with x in the meridian they do.
  turntable.turn(estimator::roll_turn(result.north_rad - std::numbers::pi / 2, run.steps), result);
  result.end_utime = turntable.utime();
  result.max_min = estimator::max_min_compass(result.raw_uT, result.f_B);
  result.ellipsoid = estimator::ellipsoid_compass(result.raw_uT, result.f_B);
  return result;
}

double level_heading_error_rad(const estimator::MagneticCalibration& calibration,
                               const MagnetometerParameters& unit, const EarthFieldSettings& earth) {
  constexpr int kHeadings = 72;
  double square = 0;
  for (int i = 0; i < kHeadings; ++i) {
    const double heading_rad = 2 * std::numbers::pi * i / kHeadings;
    const Vector3d field_uT = earth.total_uT * estimator::field_B(heading_rad, earth.dip_rad, {});
    const Vector3d m_B = calibration.apply(unit.soft_iron * field_uT + unit.hard_iron_uT);
    const double error_rad =
        std::remainder(estimator::level_heading_rad(m_B.x(), m_B.y()) - heading_rad, 2 * std::numbers::pi);
    square += error_rad * error_rad;
  }
  return std::sqrt(square / kHeadings);
}

}  // namespace waverig::rig
