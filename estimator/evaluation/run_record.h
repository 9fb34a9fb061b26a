// RunRecord: the series of one recorded run, read back from its LCM event log for figures and evaluation.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "estimator/types.h"
#include "motion/kinematics/body_motion.h"

namespace waverig::evaluation {

struct TruthSample {
  std::int64_t utime = 0;
  double heave_m = 0, heave_rate_mps = 0, north_m = 0, east_m = 0, arm_angle_rad = 0;
  Quaterniond q_NB = Quaterniond::Identity();
};

struct RawSample {   // front-end counts as recorded
  std::int64_t utime = 0;
  std::int64_t seq = 0;
  Eigen::Vector3i accel_positive = Eigen::Vector3i::Zero(), accel_negative = Eigen::Vector3i::Zero(),
                  gyro = Eigen::Vector3i::Zero(), mag = Eigen::Vector3i::Zero();
  int temperature = 0;
  std::int32_t flags = 0;
};

struct RunRecord {
  std::string run;
  double period_s = 0, height_m = 0;          // as set
  int repeat = 0;
  std::int64_t start_utime = 0;               // of the record
  std::int64_t steady_begin_utime = 0, steady_end_utime = 0;
  std::vector<TruthSample> truth;
  std::vector<estimator::ImuSample> imu;      // calibrated
  std::vector<RawSample> raw;
  std::map<std::string, std::vector<estimator::HeaveSample>> heave;   // by method
  std::map<std::string, std::vector<estimator::Wave>> waves;          // by method
  std::map<std::string, std::vector<estimator::SeaState>> seas;       // by method
};

// Throws UserError where the log is truncated, corrupt or of a foreign type.
RunRecord load_run(const std::filesystem::path& log);

}  // namespace waverig::evaluation
