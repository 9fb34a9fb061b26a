// RunJudge: the evaluator's memory of one run. It is fed the messages of the bus one by one, in any order
// between channels, and tells at the end what each method's estimates are worth against the truth.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/evaluation/heave_comparison.h"
#include "estimator/evaluation/results.h"
#include "estimator/evaluation/truth_series.h"

namespace waverig {
class run_t;
class truth_t;
}  // namespace waverig

namespace waverig::evaluation {

struct JudgeSettings {
  double noise_density_mps2_rthz =
      estimator::kUnknown;      // one-sided, of the vertical acceleration; for the bound
  double sample_rate_hz = 100;  // of the sensor; for the bound
  Motion motion = Motion::kUnknown;
  std::map<std::string, double, std::less<>>
      heave_bound_m{};  // of methods whose sea is known (heave_bound.h)
  // Methods that tell their waves themselves: where one tells none there is none. Of all others' heave the
  // waves are counted.
  std::function<bool(std::string_view method)> tells_waves = [](std::string_view) { return false; };
};

struct RunRecord;

class RunJudge {
 public:
  RunJudge(std::string run, const JudgeSettings& settings);

  void add(const run_t& message);
  void add(const truth_t& message);
  void add(std::string_view method, const estimator::HeaveSample& heave);
  void add(std::string_view method, const estimator::Wave& wave);
  void add(std::string_view method, const estimator::SeaState& sea);

  // Waves that lie whole within the steady part are judged, all others only counted. One result a method, by
  // name. A method that gives heave alone is flagged with the gap where that misses more than one set period
  // of the steady part.
  std::vector<RunResult> finish();

 private:
  struct Heave {
    std::int64_t utime;
    double heave_m, sigma_m;
  };
  struct OfMethod {
    std::vector<estimator::Wave> waves;
    std::vector<estimator::SeaState> seas;
    std::vector<Heave> pending;  // heave that the truth has not reached yet
    HeaveComparison comparison;
    bool tells_waves = false;
    std::vector<Heave> series;  // of a method that gives no waves of its own: they are counted in its heave
  };

  OfMethod& of(std::string_view method);
  bool steady(std::int64_t utime) const;
  void settle(OfMethod& method);
  void compare(HeaveComparison& comparison, const Heave& heave) const;
  static std::vector<estimator::Wave> counted_waves(const OfMethod& method);
  double covered_s(const OfMethod& method) const;  // of the steady part, by heave without a gap
  RunResult result_of(const std::string& name, OfMethod& method) const;

  std::string run_;
  JudgeSettings settings_;
  double period_s_ = estimator::kUnknown, height_m_ = estimator::kUnknown;
  int repeat_ = 0;
  bool begun_ = false, ended_ = false;
  std::int64_t steady_begin_ = 0, steady_end_ = 0;
  TruthSeries truth_;
  std::map<std::string, OfMethod, std::less<>> methods_;
};

// The same for a run that was read back from its log.
std::vector<RunResult> judge(const RunRecord& record, const JudgeSettings& settings);

}  // namespace waverig::evaluation
