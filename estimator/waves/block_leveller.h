// BlockLeveller: attitude for a platform that sways about a place, told block by block with a bounded delay.
//
// Within a block the gyro is integrated from an unknown start attitude with an unknown, constant bias. Both
// follow from the physics of a platform that stays where it is: over whole waves its mean acceleration is
// nought, so the levelled specific force has no horizontal offset and no horizontal drift. Weighted least
// squares over the block,
//
//   f_N = R f_B,  horizontal part of  f_N + phi x f_N = 0 + waves,  phi(t) = phi_0 - (integral of R) db
//
// iterated (the first block may lean by tens of degrees). The taper keeps the cut waves at the block's ends
// from leaning the frame. The bias about the vertical is taken from the mean rate; heading starts at nought
// and drifts with what is left of it: N is a level frame that turns slowly. Samples are gathered into nodes
// of a tenth of a second, rotation and force relative to the node's start, so that iterating costs next to
// nothing; each sample's own attitude is integrated once, when it is given.
#pragma once
#include <deque>
#include <vector>

#include "estimator/sample_guard.h"
#include "estimator/types.h"

namespace waverig::estimator {

struct BlockLevellerSettings {
  double gravity_mps2 = kStandardGravity;
  double gyro_bias_sigma_radps = 0.2 * kDegree;
  double block_s = 100;
  double taper_s = 20;
  double longest_gap_s = 0.4;  // beyond it the rotation across the gap is not known: a new block begins
};

struct LevelledSample {
  std::int64_t utime = 0;
  std::int64_t seq = 0;
  std::int32_t flags = 0;
  bool usable = false;  // f_B may enter a fit
  double t_s = 0;       // since the record's first usable sample
  double up_mps2 = 0;   // levelled vertical acceleration, up positive, gravity taken off
  Vector3d f_B = Vector3d::Zero();
  Quaterniond q_NB = Quaterniond::Identity();
};

class BlockLeveller {
 public:
  explicit BlockLeveller(const BlockLevellerSettings& settings) : settings_(settings) {}

  // Samples as they come, with what the guard says of them; levelled ones are appended to out, each sample
  // once and in order, later by a fifth of a block or more.
  void add(const ImuSample& sample, const GuardVerdict& verdict, std::deque<LevelledSample>& out);
  void finish(std::deque<LevelledSample>& out);

 private:
  struct Raw {
    LevelledSample levelled;
    Vector3d turn_B = Vector3d::Zero();  // since the sample before, gyro bias included
    double dt_s = 0;                     // of the turn; 0: none
  };
  struct Node {
    std::size_t first = 0;  // sample it begins with, counted from the record's first
    double begin_s = 0, duration_s = 0;
    Quaterniond turn = Quaterniond::Identity();  // from its start to its end, gyro bias included
    Vector3d force_sum = Vector3d::Zero();       // in the frame of its start
    double forces = 0;
    Quaterniond q_NB = Quaterniond::Identity();  // at its start
  };
  void level(std::size_t until, std::deque<LevelledSample>& out);
  void guess_attitude();
  bool iterate();  // one Gauss-Newton step; true once it no longer moves
  void restart();

  BlockLevellerSettings settings_;
  std::deque<Raw> raw_;  // samples from first_raw_ on
  std::deque<Node> nodes_;
  std::size_t first_raw_ = 0, given_ = 0;  // counted from the record's first sample
  bool started_ = false, has_rate_ = false, has_attitude_ = false;
  std::int64_t first_utime_ = 0;
  double last_t_s_ = 0;
  Vector3d last_w_B_ = Vector3d::Zero();
  Quaterniond q_start_ = Quaterniond::Identity();  // at nodes_.front()
  Vector3d bias_B_ = Vector3d::Zero();
};

}  // namespace waverig::estimator
