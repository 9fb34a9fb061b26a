// Turning: how fast the specific force turns in the body, as the gyroscope says and as the accelerometer
// sees. A level that is carried through waves agrees with itself within their accelerations; degrees taken
// for radians do not, by 57.
#pragma once
#include <cstdint>

#include "estimator/method.h"

namespace waverig::cli {

class Turning {
 public:
  void add(const estimator::ImuSample& sample);  // of a time after the one before
  // True where the gyroscope says that it turns as nothing that floats does (rms 2 rad/s about its mean) and
  // the accelerometer sees a quarter of it at most.
  bool contradicts_itself() const;
  double told_radps() const;  // rms about the mean
  double seen_radps() const;  // rms

 private:
  std::int64_t begin_utime_ = 0, last_utime_ = 0, count_ = 0;
  Vector3d begin_, told_ = Vector3d::Zero();  // of the window that goes on
  Vector3d sum_radps_ = Vector3d::Zero();
  double told_squares_ = 0, seen_squares_ = 0;
};

}  // namespace waverig::cli
