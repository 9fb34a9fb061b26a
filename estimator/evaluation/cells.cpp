#include "estimator/evaluation/cells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "lcmtypes/flags.h"

namespace waverig::evaluation {

bool earlier(const RunResult& a, const RunResult& b) {
  const auto key = [](const RunResult& r) {
    return std::tie(r.period_s, r.height_m, r.method, r.repeat, r.run);
  };
  return key(a) < key(b);
}

void CellPooling::Mean::add(double value) {
  if (!std::isfinite(value)) return;
  count += 1;
  sum += value;
}

double CellPooling::Mean::value() const { return count > 0 ? sum / count : estimator::kUnknown; }

void CellPooling::MeanAngle::add(double angle_rad) {
  north.add(std::cos(angle_rad));
  east.add(std::sin(angle_rad));
}

double CellPooling::MeanAngle::value() const {
  constexpr double kNone = 0.1;  // of a full vector
  if (!(std::hypot(north.value(), east.value()) > kNone)) return estimator::kUnknown;
  const double angle_rad = std::atan2(east.value(), north.value());
  return angle_rad < 0 ? angle_rad + 360 * kDegree : angle_rad;
}

void CellPooling::MeanResponse::add(const RunResult& run) {
  const double lag_rad = 2 * std::numbers::pi * run.heave_lag_s / run.true_tm02_s;
  if (!std::isfinite(run.heave_gain) || !std::isfinite(lag_rad)) return;
  in_phase.add(run.heave_gain * std::cos(lag_rad));
  late.add(run.heave_gain * std::sin(lag_rad));
  period_s.add(run.true_tm02_s);
}

double CellPooling::MeanResponse::gain() const { return std::hypot(in_phase.value(), late.value()); }

double CellPooling::MeanResponse::lag_s() const {
  return std::atan2(late.value(), in_phase.value()) * period_s.value() / (2 * std::numbers::pi);
}

void CellPooling::MeanSea::add(const JudgedSea& judged) {
  const estimator::SeaState& s = judged.sea;
  duration.add(s.duration_s);
  hm0.add(s.hm0_m);
  const double variance_m2 = s.hm0_sigma_m * s.hm0_sigma_m,
               systematic_m2 = s.hm0_systematic_sigma_m * s.hm0_systematic_sigma_m;
  hm0_variance.add(variance_m2);
  hm0_systematic.add(std::isfinite(systematic_m2) ? std::min(systematic_m2, variance_m2) : variance_m2);
  tp.add(s.tp_s);
  tm01.add(s.tm01_s);
  tm02.add(s.tm02_s);
  tm_10.add(s.tm_10_s);
  h13.add(s.h13_m);
  h110.add(s.h110_m);
  hmax.add(s.hmax_m);
  spread.add(s.spread_rad);
  check.add(s.check_factor);
  direction.add(s.mean_direction_rad);
  peak_direction.add(s.peak_direction_rad);
  true_hm0.add(judged.true_hm0_m);
  true_tm02.add(judged.true_tm02_s);
  true_direction.add(judged.direction.mean_direction_rad);
  true_spread.add(judged.direction.spread_rad);
  true_check.add(judged.direction.check_factor);
  flags |= s.flags;
}

JudgedSea CellPooling::MeanSea::value() const {
  JudgedSea judged;
  estimator::SeaState& s = judged.sea;
  s.duration_s = duration.value();
  s.hm0_m = hm0.value();
  // More records lessen chance alone: what the sensor does wrong it does wrong in all of them.
  const double chance_m2 = (hm0_variance.value() - hm0_systematic.value()) / std::max(1.0, hm0_variance.count);
  s.hm0_sigma_m = std::sqrt(hm0_systematic.value() + chance_m2);
  s.hm0_systematic_sigma_m = std::sqrt(hm0_systematic.value());
  s.tp_s = tp.value();
  s.tm01_s = tm01.value();
  s.tm02_s = tm02.value();
  s.tm_10_s = tm_10.value();
  s.h13_m = h13.value();
  s.h110_m = h110.value();
  s.hmax_m = hmax.value();
  s.mean_direction_rad = direction.value();
  s.spread_rad = spread.value();
  s.peak_direction_rad = peak_direction.value();
  s.check_factor = check.value();
  s.flags = flags;
  judged.true_hm0_m = true_hm0.value();
  judged.true_tm02_s = true_tm02.value();
  judged.direction = {true_direction.value(), true_spread.value(), true_check.value()};
  return judged;
}

void CellPooling::add(const RunResult& run) {
  if (open_ && std::tie(run.period_s, run.height_m, run.method) !=
                   std::tie(cell_.period_s, cell_.height_m, cell_.method))
    close();
  open_ = true;
  cell_.period_s = run.period_s;
  cell_.height_m = run.height_m;
  cell_.method = run.method;
  cell_.motion = run.motion;
  for (const JudgedWave& wave : run.waves) heights_.add(wave);
  heights_.close_record();
  bound_square_.add(run.statistics.bound_std_m * run.statistics.bound_std_m);
  heave_square_.add(run.heave_rmse_m * run.heave_rmse_m);
  heave_bound_square_.add(run.heave_bound_m * run.heave_bound_m);
  true_hm0_.add(run.true_hm0_m);
  response_.add(run);
  flags_ |= run.statistics.flags & flag::kGap;
  sigma_ratio_.add(run.heave_sigma_ratio);
  for (const JudgedSea& sea : run.seas) {
    sea_.add(sea);
    const double error_rad = sea.direction_error_rad();
    direction_error_.add(error_rad);
    direction_square_.add(error_rad * error_rad);
  }
}

void CellPooling::close() {
  cell_.statistics = heights_.statistics(cell_.height_m, std::sqrt(bound_square_.value()));
  cell_.heave_rmse_m = std::sqrt(heave_square_.value());
  cell_.heave_bound_m = std::sqrt(heave_bound_square_.value());
  cell_.true_hm0_m = true_hm0_.value();
  cell_.statistics.flags |= flags_;
  cell_.heave_gain = response_.gain();
  cell_.heave_lag_s = response_.lag_s();
  cell_.heave_sigma_ratio = sigma_ratio_.value();
  cell_.sea = sea_.value();
  cell_.direction_error_rad = direction_error_.value();
  cell_.direction_rmse_rad = std::sqrt(direction_square_.value());
  std::vector<CellResult> cells = std::move(cells_);
  cells.push_back(std::move(cell_));
  *this = {};
  cells_ = std::move(cells);
}

std::vector<CellResult> CellPooling::finish() {
  if (open_) close();
  return std::move(cells_);
}

std::vector<CellResult> cells_of(std::span<const RunResult> runs) {
  std::vector<const RunResult*> sorted;
  for (const RunResult& run : runs) sorted.push_back(&run);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const RunResult* a, const RunResult* b) { return earlier(*a, *b); });
  CellPooling pooling;
  for (const RunResult* run : sorted) pooling.add(*run);
  return pooling.finish();
}

namespace {

// How far the root of the mean square over repeats is left to chance.
struct Scatter {
  double n = 0, mean = 0, squares = 0;  // of the mean squares of the runs

  void add(double rms_m) {
    if (!std::isfinite(rms_m)) return;
    const double q = rms_m * rms_m, step = q - mean;
    mean += step / ++n;
    squares += step * (q - mean);
  }
  // A root has half the relative uncertainty.
  double sigma_m() const {
    return n > 1 ? std::sqrt(squares / (n - 1) / n) / (2 * std::sqrt(mean)) : estimator::kUnknown;
  }
};

}  // namespace

void tell_scatter(std::span<CellResult> cells, std::span<const RunResult> runs) {
  for (CellResult& cell : cells) {
    Scatter heave, waves;
    for (const RunResult& run : runs) {
      if (run.period_s != cell.period_s || run.height_m != cell.height_m || run.method != cell.method)
        continue;
      heave.add(run.heave_rmse_m);
      waves.add(run.statistics.rmse_m);
    }
    cell.heave_rmse_sigma_m = heave.sigma_m();
    cell.heave_runs = static_cast<int>(heave.n);
    cell.wave_rmse_sigma_m = waves.sigma_m();
    cell.wave_runs = static_cast<int>(waves.n);
  }
}

}  // namespace waverig::evaluation
