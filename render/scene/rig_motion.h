// What a recorded run did, made ready for drawing: truth and estimate at any
// time.
#pragma once
#include <string>
#include <vector>

#include "estimator/evaluation/run_record.h"

namespace waverig::render {

struct RigInstant {
  double time_s = 0;  // since the start of the record
  double arm_angle_rad = 0;
  Vector3d sensor_m = Vector3d::Zero();        // true; along the azimuth, across, up
  Quaterniond q_SB = Quaterniond::Identity();  // true attitude, scene from body
  bool estimated = false;                      // whether there is an estimate at this time
  double estimated_heave_m = 0;
  Quaterniond estimated_q_SB = Quaterniond::Identity();
};

class RigMotion {
 public:
  // method: whose heave is shown; empty: the one nearest to the truth. color: its number in the palette, that
  // of the campaign's figures. Throws UserError where the run has no truth or no such method.
  RigMotion(const evaluation::RunRecord& run, const std::string& method, int color = 1);

  RigInstant at(double time_s) const;
  const std::string& method() const { return method_; }  // empty where no estimate was recorded
  int color() const { return color_; }
  const evaluation::RunRecord& run() const { return run_; }
  double heave_offset_m() const { return mean_heave_m_; }  // of the estimate from the truth: it is taken off
  double radius_m() const { return radius_m_; }            // of the arm; on a sea the largest heave
  bool on_sea() const { return on_sea_; }                  // a buoy on a sea instead of the arm's gondola
  double begin_s() const;  // of the steady part, or of the record where nothing is steady
  double end_s() const;
  double crest_near_s(double time_s) const;  // highest within half a period

 private:
  void find_azimuth();

  const evaluation::RunRecord& run_;
  std::string method_;
  int color_;
  const std::vector<estimator::HeaveSample>* heave_ = nullptr;
  double mean_heave_m_ = 0;  // of the estimate over the steady part, less that of the truth
  double azimuth_rad_ = 0;
  double radius_m_ = 0;
  bool on_sea_ = false;
};

// Nearest method by rms of heave against the truth, its mean removed, over the
// steady part; empty where none has heave.
std::string nearest_method(const evaluation::RunRecord& run);

}  // namespace waverig::render
