// What `waverig bench-estimators` measures: seas and regular waves from motion/, felt by the simulated sensor
// unit after its six-position calibration, through frames and acquisition, given to methods one by one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/evaluation/heave_bound.h"
#include "estimator/evaluation/transfer.h"
#include "estimator/evaluation/truth_series.h"
#include "rig/campaign/run.h"

namespace waverig::cli {

enum class BenchMotion { kRegular, kJonswap, kPiersonMoskowitz };

struct BenchCase {
  BenchMotion motion = BenchMotion::kJonswap;
  double period_s = 8;    // of a sea Tp
  double height_m = 1.5;  // of a sea Hm0
  double duration_s = 1200;
};

struct BenchRecord {
  BenchCase settings;
  std::vector<estimator::ImuSample> samples;
  evaluation::TruthSeries truth;  // at the samples' rate
};

// The seed draws sea, phases and noise; the unit stays the one given.
BenchRecord bench_record(const BenchCase& settings, const rig::CampaignUnit& unit, std::uint64_t seed);

// The least error that heave can have in a sea of the set spectrum; nothing for regular waves.
std::optional<evaluation::HeaveBound> bound_of(const BenchCase& settings, const rig::CampaignUnit& unit);

struct BenchMethod {
  std::string name;
  double fixed_lag_s = 0;
  bool tells_heave = true;  // false: its trace is not meant to be heave, only its waves are judged
  std::string title() const;
};

// Errors of one method on one record, in percent; NaN where the method does not tell.
struct BenchFigures {
  double rms = 0, settled_rms = 0;  // of heave, of 4 std of the truth; whole record, and after five minutes
  double hm0_error = 0, tm02_error = 0;
  double mean_height_error = 0;  // mean of the single waves against that of the truth
  double std_over_bound = 0;     // regular waves: of single heights, over the Cramer-Rao bound
  double gain = 0, lag_s = 0;    // least squares, all frequencies
  double us_a_sample = 0;
  std::vector<evaluation::TransferPoint> transfer;  // from half to four times the peak frequency, settled
};

BenchFigures judge_method(const BenchMethod& method, const BenchRecord& record,
                          const rig::CampaignUnit& unit);

// What the method's heave is limited to by its lag, as BenchFigures has it.
struct BenchLimits {
  double rms = estimator::kUnknown, settled_rms = estimator::kUnknown;
};
BenchLimits limits(const BenchCase& settings, const BenchMethod& method, const evaluation::HeaveBound& bound);

// Mean over records of what is signed, root mean square of what is not.
BenchFigures pooled(const std::vector<BenchFigures>& figures);

}  // namespace waverig::cli
