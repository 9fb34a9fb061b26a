// A whole record's heave and attitude, forward and backward: what `smoothed` and `spectral` rest on.
#pragma once
#include <vector>

#include "estimator/attitude/attitude_smoother.h"
#include "estimator/heave/disturbance.h"
#include "estimator/heave/offset_changes.h"
#include "estimator/heave/sea_model.h"
#include "estimator/method.h"
#include "estimator/sample_guard.h"

namespace waverig::estimator {

// Collects the usable samples of a record, with the guard's flags on them.
class Record {
 public:
  void add(const ImuSample& sample);
  const std::vector<ImuSample>& samples() const { return samples_; }
  // Pieces without a gap, as indices of samples(): they are all of it, in order.
  struct Piece {
    std::size_t begin, end;
  };
  const std::vector<Piece>& pieces() const { return pieces_; }

 private:
  SampleGuard guard_;
  std::vector<ImuSample> samples_;
  std::vector<Piece> pieces_;
  std::int32_t pending_flags_ = 0;
};

struct SmoothedRecord {
  std::vector<HeaveSample> heave;        // one a usable sample
  std::vector<AttitudeSample> attitude;  // beside it; its acceleration less the changes of the offset
  std::vector<OffsetChange> offset_changes;
  SeaModel sea;
  Motion motion;
};

SmoothedRecord smooth_record(const Record& record, const SensorKnowledge& sensor);

// Gives the changes of the offset, every heave, and each wave as it ends; the waves are the answer, too.
std::vector<Wave> tell(const Record& record, const SmoothedRecord& smoothed, const SensorKnowledge& sensor,
                       Output& output);

}  // namespace waverig::estimator
