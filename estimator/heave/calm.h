// Calm: a calm as `realtime` saw it, second by second, and what came since: from when on a sea came up.
//
// A sea that comes up softly, as a rig's runs do, hides in the sensor's noise for its first seconds; the
// filter of the calm takes it for drift and surprises nobody. Once it shows, the path is gone through again
// from the end of the calm on, as if the sea had been known; where that lies is told by what makes the path
// most probable. The earlier it is, the less of the sea has gone into the drift, and the more the sea has to
// explain.
#pragma once
#include <cstdint>
#include <deque>
#include <vector>

#include "estimator/heave/heave_filter.h"
#include "estimator/heave/sea_model.h"

namespace waverig::estimator {

class Calm {
 public:
  struct Since {  // the calm's filter as it stood, and the steps from then on
    HeaveFilter filter;
    std::vector<HeaveStep> steps;
    std::int64_t at;  // so many steps after the calm began
  };
  // The filter after these steps had they been those of a sea. level_m: of the rest over the mean level of
  // the sea that was, which a sea keeps that is large enough for it.
  static HeaveFilter risen(const Since& since, const SeaModel& sea, double level_m);

  void clear();
  void add(const HeaveFilter& before, const HeaveStep& step);  // of the calm: the filter before the step
  void follow(const HeaveStep& step);                          // of what came up
  bool is_long() const;
  const Since* newest() const { return since_.empty() ? nullptr : &since_.back(); }
  // Of a long calm's moments that since when a sea makes the path most probable; none where no moment makes
  // it more so than `log_likelihood`. beside: of those within three
  // seconds of this one alone.
  const Since* onset(const SeaModel& sea, double level_m, double log_likelihood,
                     const Since* beside = nullptr) const;
  // The filter's drift has become what noise does not make of it.
  bool drifts_away(const HeaveFilter& now) const;

 private:
  std::deque<Since> since_;  // oldest first
  std::int64_t lasts_ = 0;   // steps
};

}  // namespace waverig::estimator
