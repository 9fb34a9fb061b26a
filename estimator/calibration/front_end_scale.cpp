#include "estimator/calibration/front_end_scale.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The remainder on the integrator at both ends of a count, each uniform over one pulse.
const double kCountSigma = std::sqrt(2.0 / 12.0);
const double kRectangular = 1 / std::sqrt(3.0);
constexpr double kCoverage = 2;   // data sheets state 95 %

// One cause of error: what it does to each row's left side, in ampere, at one standard deviation.
struct ErrorSource {
  std::string name;
  VectorXd row_A;
  bool common = false;   // the same in every fit against the same reference
  char type = 'B';
};

struct Rows {
  MatrixXd A;                        // columns K_N, K_P, then one offset each for the DMM's ranges
  VectorXd y_A;
  std::vector<double> level_A;
  std::vector<int> polarity;         // 0: both in one row
};

const CalibratorRange& range_of(const ScaleFactorKnowledge& knowledge, double range_A) {
  for (const CalibratorRange& r : knowledge.calibrator)
    if (std::abs(r.full_scale_A - range_A) <= 1e-6 * range_A) return r;
  throw UserError(fmt::format("calibrator range {} A: expected a range of the calibrator's data sheet", range_A));
}

VectorXd row_weights(const Rows& rows, const std::vector<ErrorSource>& sources, RowWeighting weighting) {
  VectorXd w = VectorXd::Ones(rows.y_A.size());
  if (weighting == RowWeighting::kLevel)
    for (Index j = 0; j < w.size(); ++j) w[j] = 1 / rows.level_A[static_cast<std::size_t>(j)];
  if (weighting == RowWeighting::kUncertainty) {
    w.setZero();
    for (const ErrorSource& s : sources) w += s.row_A.cwiseAbs2();
    w = w.cwiseMax(1e-40).cwiseSqrt().cwiseInverse();
  }
  return w;
}

struct Solved {
  MatrixXd gain;    // K = gain * y
  VectorXd K;
};

Solved solve(const Rows& rows, const VectorXd& weight) {
  const MatrixXd A = weight.asDiagonal() * rows.A;
  // Columns of size one: K is of the order of 1e-9 C, the DMM's offsets of 1e-9 A.
  VectorXd size = A.colwise().norm().cwiseMax(1e-300).cwiseInverse();
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(A * size.asDiagonal());
  if (qr.rank() < A.cols()) throw UserError("scale factors: expected levels of both polarities that tell K_N from K_P");
  Solved s;
  s.gain = size.asDiagonal() * qr.solve(MatrixXd(weight.asDiagonal()));
  s.K = s.gain * rows.y_A;
  return s;
}

ScaleFactors finish(const Rows& rows, const std::vector<ErrorSource>& sources, RowWeighting weighting) {
  const Solved s = solve(rows, row_weights(rows, sources, weighting));
  ScaleFactors result;
  result.K_N_C = s.K[0];
  result.K_P_C = s.K[1];
  std::map<std::string, std::pair<Eigen::Vector2d, char>> variance;   // by name
  std::vector<std::string> names;
  for (const ErrorSource& source : sources) {
    const Eigen::Vector2d dK = (s.gain.topRows(2) * source.row_A).cwiseQuotient(s.K.head(2));
    (source.common ? result.covariance_common : result.covariance_random) += dK * dK.transpose();
    auto [entry, added] = variance.try_emplace(source.name, Eigen::Vector2d::Zero(), source.type);
    if (added) names.push_back(source.name);
    entry->second.first += dK.cwiseAbs2();
  }
  for (const std::string& name : names) {
    const auto& [v, type] = variance.at(name);
    result.budget_N.push_back({name, std::sqrt(v[0]), type});
    result.budget_P.push_back({name, std::sqrt(v[1]), type});
  }
  const VectorXd residual_A = rows.A * s.K - rows.y_A;
  for (Index j = 0; j < residual_A.size(); ++j) {
    const auto k = static_cast<std::size_t>(j);
    result.residuals.push_back({rows.level_A[k], rows.polarity[k], residual_A[j] / rows.level_A[k]});
  }
  return result;
}

// A first estimate of K for the counting noise, from the largest level of each polarity.
double rough_K(const std::vector<FrontEndReading>& readings, bool positive) {
  double K = 0, level = 0;
  for (const FrontEndReading& r : readings) {
    const double rate = positive ? r.rate_N_Hz : r.rate_P_Hz;
    if (r.polarity == (positive ? 1 : -1) && r.level_A > level && rate > 0) {
      level = r.level_A;
      K = r.level_A / rate;
    }
  }
  return K;
}

double reading_sigma_A(const FrontEndReading& r, double K_C, const ScaleFactorKnowledge& knowledge) {
  return std::hypot(K_C * kCountSigma / r.duration_s, knowledge.noise_A_sqrt_s / std::sqrt(r.duration_s));
}

}  // namespace

ScaleFactors scale_factors_by_calibrator(const std::vector<FrontEndReading>& readings,
                                         const ScaleFactorKnowledge& knowledge, RowWeighting weighting) {
  struct Pair {
    std::size_t level, zero;
  };
  std::vector<Pair> pairs;
  std::map<std::pair<double, int>, std::size_t> zero_of;   // by range and polarity: renewed on each range change
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const FrontEndReading& r = readings[i];
    if (r.polarity == 0) continue;
    if (r.level_A == 0) {
      zero_of[{r.range_A, r.polarity}] = i;
      continue;
    }
    const auto zero = zero_of.find({r.range_A, r.polarity});
    if (zero == zero_of.end())
      throw UserError(fmt::format("level {:+g} A: expected a zero reading of the same polarity in the calibrator's {} A "
                                  "range before it", r.polarity * r.level_A, r.range_A));
    pairs.push_back({i, zero->second});
  }

  const auto n = static_cast<Index>(pairs.size());
  Rows rows{MatrixXd(n, 2), VectorXd(n), {}, {}};
  const double K_N = rough_K(readings, true), K_P = rough_K(readings, false);
  std::map<double, ErrorSource> gain, leak;
  std::map<std::size_t, ErrorSource> zero_noise;
  std::vector<ErrorSource> sources;
  const auto unit = [&](Index j, double size) { return VectorXd(VectorXd::Unit(n, j) * size); };
  for (Index j = 0; j < n; ++j) {
    const auto [level, zero] = pairs[static_cast<std::size_t>(j)];
    const FrontEndReading &r = readings[level], &z = readings[zero];
    const CalibratorRange& range = range_of(knowledge, r.range_A);
    const double K = r.polarity > 0 ? K_N : K_P;
    rows.A.row(j) << r.rate_N_Hz - z.rate_N_Hz, -(r.rate_P_Hz - z.rate_P_Hz);   // eqs. (6), (9)
    rows.y_A[j] = r.polarity * r.level_A;
    rows.level_A.push_back(r.level_A);
    rows.polarity.push_back(r.polarity);

    auto& g = gain.try_emplace(r.range_A, ErrorSource{"calibrator", VectorXd::Zero(n), true}).first->second;
    g.row_A[j] = rows.y_A[j] * range.relative / kCoverage;
    sources.push_back({"calibrator drift from zero to level", unit(j, knowledge.floor_drift * range.floor_A)});
    sources.push_back({"switch leakage", unit(j, knowledge.leakage_limit_A * kRectangular)});
    sources.push_back({"bias wander from zero to level", unit(j, knowledge.bias_wander_A)});
    sources.push_back({"counting and noise, level", unit(j, reading_sigma_A(r, K, knowledge)), false, 'A'});
    sources.push_back({"clock ratio", unit(j, r.level_A * knowledge.clock_ratio_sigma)});
    auto& shared = zero_noise.try_emplace(zero, ErrorSource{"counting and noise, zero", VectorXd::Zero(n), false, 'A'})
                       .first->second;
    shared.row_A[j] = reading_sigma_A(z, K, knowledge);
  }
  for (auto& [range, source] : gain) sources.push_back(std::move(source));
  for (auto& [zero, source] : zero_noise) sources.push_back(std::move(source));
  return finish(rows, sources, weighting);
}

ScaleFactors scale_factors_by_dmm(const std::vector<FrontEndReading>& readings, const ScaleFactorKnowledge& knowledge,
                                  RowWeighting weighting) {
  std::map<double, std::pair<std::optional<FrontEndReading>, std::optional<FrontEndReading>>> levels;
  for (const FrontEndReading& r : readings) {
    if (r.polarity == 0 || r.level_A == 0) continue;
    auto& [plus, minus] = levels[r.level_A];
    (r.polarity > 0 ? plus : minus) = r;
  }
  std::map<double, Index> offset_of;   // the DMM's ranges
  for (const auto& [level_A, both] : levels) {
    const auto& [plus, minus] = both;
    if (!plus || !minus || !std::isfinite(plus->dmm_A) || !std::isfinite(minus->dmm_A) ||
        plus->dmm_range_A != minus->dmm_range_A)
      throw UserError(fmt::format("level {:g} A: expected both polarities, each with its DMM reading in one DMM range", level_A));
    offset_of.try_emplace(plus->dmm_range_A, static_cast<Index>(offset_of.size()));
  }

  const auto n = static_cast<Index>(2 * levels.size());
  Rows rows{MatrixXd::Zero(n, 2 + static_cast<Index>(offset_of.size())), VectorXd(n), {}, {}};
  const double K_N = rough_K(readings, true), K_P = rough_K(readings, false);
  std::map<double, ErrorSource> gain;
  std::vector<ErrorSource> sources;
  const auto pair_source = [&](Index j, double half_difference, double half_sum) {
    VectorXd v = VectorXd::Zero(n);
    v[j] = half_difference;
    v[j + 1] = half_sum;
    return v;
  };
  Index j = 0;
  for (const auto& [level_A, both] : levels) {
    const FrontEndReading &p = *both.first, &m = *both.second;
    rows.A.block(j, 0, 1, 2) << 0.5 * (p.rate_N_Hz - m.rate_N_Hz), -0.5 * (p.rate_P_Hz - m.rate_P_Hz);   // eq. (14)
    rows.y_A[j] = 0.5 * (p.dmm_A - m.dmm_A);
    rows.A.block(j + 1, 0, 1, 2) << 0.5 * (p.rate_N_Hz + m.rate_N_Hz), -0.5 * (p.rate_P_Hz + m.rate_P_Hz);
    rows.A(j + 1, 2 + offset_of.at(p.dmm_range_A)) = 1;
    rows.y_A[j + 1] = 0.5 * (p.dmm_A + m.dmm_A);
    for (int k = 0; k < 2; ++k) {
      rows.level_A.push_back(level_A);
      rows.polarity.push_back(0);
    }
    auto& g = gain.try_emplace(p.dmm_range_A, ErrorSource{"DMM", VectorXd::Zero(n), true}).first->second;
    g.row_A[j] = rows.y_A[j] * knowledge.dmm_relative / kCoverage;
    for (const auto& [reading, K, sign] : {std::tuple{p, K_N, 1.0}, std::tuple{m, K_P, -1.0}}) {
      const double sigma = 0.5 * reading_sigma_A(reading, K, knowledge);
      sources.push_back({"counting and noise", pair_source(j, sign * sigma, sigma), false, 'A'});
      const double dmm = 0.5 * knowledge.dmm_drift_A;
      sources.push_back({"DMM drift", pair_source(j, sign * dmm, dmm)});
      const double wander = 0.5 * knowledge.bias_wander_A;
      sources.push_back({"bias wander between polarities", pair_source(j, sign * wander, wander)});
      const double leak = 0.5 * knowledge.leakage_limit_A * kRectangular;
      sources.push_back({"switch leakage", pair_source(j, sign * leak, leak)});
    }
    sources.push_back({"clock ratio", pair_source(j, level_A * knowledge.clock_ratio_sigma, 0)});
    j += 2;
  }
  for (auto& [range, source] : gain) sources.push_back(std::move(source));
  return finish(rows, sources, weighting);
}

void fit_scale_factor_laws(const std::vector<ScaleFactorsAtTemperature>& points, FrontEndChannel& channel,
                           const TemperatureLawSettings& settings) {
  const auto fit_one = [&](int which, double K0_C, TemperatureLaw& law, std::vector<BudgetTerm>& budget) {
    std::vector<TemperaturePoint> series;
    std::map<std::string, double> random_variance;   // of each term that is not common, summed over the temperatures
    double random_sum = 0, common = 0;
    for (const ScaleFactorsAtTemperature& p : points) {
      const double K = which == 0 ? p.factors.K_N_C : p.factors.K_P_C;
      const double variance = p.factors.covariance_random(which, which);
      series.push_back({p.temperature_degC, K / K0_C - 1, std::sqrt(variance)});
      common += p.factors.covariance_common(which, which) / static_cast<double>(points.size());
      for (const BudgetTerm& t : which == 0 ? p.factors.budget_N : p.factors.budget_P)
        random_variance[t.name] += t.sigma * t.sigma;
      random_sum += variance;
    }
    const TemperatureLawFit fit = fit_temperature_law(series, settings);
    law = fit.law;
    const double fitted = law.sigma_at(settings.reference_degC);
    budget.clear();
    for (const BudgetTerm& t : which == 0 ? points.front().factors.budget_N : points.front().factors.budget_P) {
      const bool is_common = t.name == "calibrator" || t.name == "DMM";
      const double share = random_sum > 0 ? random_variance[t.name] / random_sum : 0;
      budget.push_back({t.name, is_common ? std::sqrt(common) : fitted * std::sqrt(share), t.type});
    }
    law.covariance(0, 0) += common;
  };
  fit_one(0, channel.K_N0_C, channel.dsf_N, channel.dsf_N_budget);
  fit_one(1, channel.K_P0_C, channel.dsf_P, channel.dsf_P_budget);
}

}  // namespace waverig::estimator
