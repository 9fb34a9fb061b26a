// One run of Cho's simulation (section III.4), as fast as it goes: the machinery under tilt_study.h.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "estimator/compass/tilt_study.h"
#include "motion/kinematics/random.h"

namespace waverig::estimator {

using Column = std::vector<double>;

// The sweep without errors, by column.
struct TiltSweep {
  struct Case {
    double cos_heading, sin_heading;
    Column x, y, z, by_roll, by_pitch;  // field; A and B of eq. (38)
  };
  Column tilt, sin_tilt, cos_tilt, ax, ay, az;
  Column roll_ay, roll_az, pitch_ax, pitch_ay, pitch_az;  // eqs. (28), (32)
  std::array<Case, 2> cases;

  explicit TiltSweep(const TiltStudySettings& settings);
  std::size_t points() const { return tilt.size(); }
};

struct MeanStd {
  double mean = 0, std = 0;
};

MeanStd mean_std(const Column& values);

// What is told of the two-axis module by one run.
struct TiltRunFigures {
  MeanStd z;              // of the estimated less the true z along the sweep, case I
  MeanStd dip, unit_dip;  // of the level turn: eq. (25) as printed, and of the field normalised before
};

// One run's errors along the sweep.
struct TiltRun {
  std::array<Column, kQuantities> error;
  std::array<Column, 4> predicted;
  Column z_error, turn_dip, turn_unit_dip;
  TiltRunFigures figures;
};

class TiltSimulation {
 public:
  explicit TiltSimulation(const TiltStudySettings& settings);
  const TiltSweep& sweep() const { return sweep_; }

  // The run of that number, the same whichever runs came before; `run` is only storage.
  void run(std::int64_t index, TiltRun& run) const;

 private:
  void point(std::size_t i, const Vector3d& constant, RandomStream& random, TiltRun& run) const;
  void level_turn(RandomStream& random, TiltRun& run) const;

  TiltStudySettings s_;
  TiltSweep sweep_;
  double sin_dip_;
};

}  // namespace waverig::estimator
