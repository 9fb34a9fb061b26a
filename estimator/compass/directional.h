// Directional waves from levelled acceleration and the compass, in the conventions of the wave-buoy community
// (Longuet-Higgins et al. 1963, Kuik et al. 1988): the first five coefficients a0, a1, b1, a2, b2 by
// frequency, mean direction, spread, peak direction and check factor. Directions are where waves come FROM,
// clockwise from true north.
//
// For a wave from theta the north and east motion follow the heave by a quarter period times cos and sin
// theta, so
//   a1 = Im S_zn / sqrt(S_zz (S_nn + S_ee)),   b1 = Im S_ze / sqrt(S_zz (S_nn + S_ee)),
//   a2 = (S_nn - S_ee) / (S_nn + S_ee),        b2 = 2 Re S_ne / (S_nn + S_ee),      S_xy = E[X* Y],
// z up. The factor omega^-4 from acceleration to displacement cancels everywhere but in a0.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "estimator/compass/magnetic_calibration.h"
#include "estimator/heave/path_integrator.h"
#include "estimator/types.h"

namespace waverig::estimator {

struct DirectionalSettings {
  CompassSettings compass{};       // its declination is added once, at the very end
  double bin_s = 0.2;              // samples are averaged over it; its sinc is taken out of a0
  double segment_s = 102.4;        // of one Fourier transform; three quarters overlapped
  double shortest_segment_s = 20;  // a record without a whole segment is analysed in one shorter piece
  double lowest_Hz = 0.03, highest_Hz = 1.0;
  double noise_from_Hz = 1.6;    // above it there are no waves: the noise of each axis is read there
  double signal_over_noise = 3;  // a band counts where the vertical acceleration exceeds its noise so much
  double least_share_of_peak = 0.01;  // and where the heave's density reaches so much of its peak: drift and
                                      // leakage at low frequencies have no heave of their own
  double largest_gap_s = 1;           // a segment with a longer gap is left out
  double largest_heading_std_rad =
      30 * kDegree;  // of the compass about its fit: beyond it a segment is left out
};

// One sample in a level frame L that may point anywhere and turn slowly, as an attitude filter without a
// compass has it. q_LB: body to L. a_L: acceleration in m/s^2 with gravity removed, z down.
struct LevelSample {
  std::int64_t utime = 0;
  Vector3d a_L = Vector3d::Zero();
  Quaterniond q_LB = Quaterniond::Identity();
  Vector3d m_B_uT = Vector3d::Zero();
  bool has_field = true;  // false: there is no reading of the magnetometer at this sample
};

// One band of the spectrum. Directions from these are true.
struct DirectionalBand {
  double frequency_Hz = 0;
  double a0_m2pHz = 0;  // variance density of the heave, noise removed
  double a1 = 0, b1 = 0, a2 = 0, b2 = 0;
  double check_factor = kUnknown;     // sqrt((S_nn + S_ee) / S_zz): horizontal over vertical; 1 in deep water
  double direction_from_rad() const;  // in [0, 2 pi)
  double spread_rad() const;          // sqrt(2 (1 - sqrt(a1^2 + b1^2))), Kuik et al. 1988
};

struct DirectionalSea {
  std::vector<DirectionalBand> bands;    // lowest_Hz to highest_Hz
  int segments = 0;                      // that went into it; 0: nothing below is known
  int dropped_segments = 0;              // for gaps, or a compass that does not agree with itself
  double hm0_m = kUnknown;               // 4 sqrt of the heave's variance, noise removed
  double mean_direction_rad = kUnknown;  // of all energy
  double spread_rad = kUnknown;          // of all energy
  double peak_Hz = kUnknown;
  double peak_direction_rad = kUnknown;  // at the peak and its two neighbours
  double check_factor = kUnknown;        // of all energy
  double heading_std_rad = kUnknown;     // scatter of the compass about its fit, per bin
  double field_norm_std = kUnknown;      // relative: a calibrated compass shows a constant norm

  // Into Hm0 and the direction fields of a sea state, which stay unknown where segments == 0.
  void fill(SeaState& sea) const;
};

class DirectionalAnalysis {
 public:
  // Throws UserError where the settings leave no band.
  explicit DirectionalAnalysis(const DirectionalSettings& settings);
  ~DirectionalAnalysis();

  // Samples in increasing utime. Constant memory.
  void add(const LevelSample& sample);

  // Of what has been added since the last call, then begins anew (a block of a long record, or its end).
  DirectionalSea finish();

 private:
  struct Bin {
    Vector3d a_L = Vector3d::Zero();  // mean
    Vector3d m_L = Vector3d::Zero();  // sum while open, mean once closed
    bool seen = false;                // else a gap
    int fields = 0;
  };
  struct Sums;
  void close_bin();
  bool ends_a_segment() const;
  void analyse_end();
  void analyse(const std::vector<double>& window);  // all of bins_
  bool usable() const;

  DirectionalSettings settings_;
  std::size_t segment_bins_;
  std::deque<Bin> bins_;    // the last segment's
  std::size_t closed_ = 0;  // bins since the record began
  Bin open_;
  Integrator<Eigen::Array3d> mean_;  // a bin's, whatever the times of its samples are
  bool started_ = false;
  std::unique_ptr<Sums> sums_;
};

}  // namespace waverig::estimator
