#include "estimator/heave/heave_smoother.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "estimator/heave/banded_cholesky.h"
#include "estimator/heave/rests.h"

namespace waverig::estimator {
namespace {

constexpr double kBiasVariance_m2ps4 = 0.1;  // nothing known
constexpr double kPathVariance_m2 = 1e4, kSpeedVariance_m2ps2 = 1e2;
// Speed that the drift gains within some seconds, squared over its variance, which the sensor's noise does
// not give it: of steady seas it is at most 14 in twenty minutes, of a crank set in motion 40 to 150. What
// the drift does all the time is no surprise: of seas a quarter of all lies below kUsual.
constexpr double kSurprising = 20, kGainsWithin_s = 8, kUsual = 0.2;
constexpr double kBefore_s = 4;  // of what was found: it began earlier
// What stands in the model's place there: besides its sea another one as high and slower than any wave, and
// an offset that changes by 5 mg or so.
constexpr double kSlowest_s = 50, kSlowRidge = 1e-5;
constexpr double kOffsetWalk_m2ps5 = 1e-4;
// By so much in log evidence, of the minutes about it, it was the offset that changed: of offsets that change
// by 2 mg half a minute from the ends or further it is 100 to 230, of cranks that stop at most 57.
constexpr double kChanged = 60, kAbout_s = 120;
constexpr double kStill_m = 1e-4;  // at rest heave is what it was a node before, but for so much at least
// Standard deviations of a rest's level, or of the mean of those that agree: chi square over their number.
constexpr double kOffLevel = 3, kAgree = 3;

// Path and speed at the nodes from rest, less the parabola of least squares: keeps the unknown drift small.
// Columns: up, and what a gyroscope's relative scale error about body x and y leaks into it.
struct Paths {
  Eigen::MatrixX3d path_m, speed_mps;
};

Paths integrate(std::span<const LevelIncrement> increments, double dt) {
  const auto n = static_cast<Eigen::Index>(increments.size()) + 1;
  Paths p{Eigen::MatrixX3d::Zero(n, 3), Eigen::MatrixX3d::Zero(n, 3)};
  for (Eigen::Index k = 0; k + 1 < n; ++k) {
    const LevelIncrement& step = increments[static_cast<std::size_t>(k)];
    p.path_m.row(k + 1) = p.path_m.row(k) + dt * p.speed_mps.row(k) + step.path_m.matrix().transpose();
    p.speed_mps.row(k + 1) = p.speed_mps.row(k) + step.speed_mps.matrix().transpose();
  }
  // Legendre's polynomials on [-1, 1], orthogonal up to O(1/n): twice over is enough.
  const Eigen::VectorXd x =
      n > 1 ? Eigen::VectorXd(Eigen::VectorXd::LinSpaced(n, -1, 1)) : Eigen::VectorXd::Zero(1);
  const Eigen::VectorXd parabola = (1.5 * x.array().square() - 0.5).matrix();
  const double per_s = n > 1 ? 2 / (dt * static_cast<double>(n - 1)) : 0.0;
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::RowVector3d c0 = p.path_m.colwise().mean();
    p.path_m.rowwise() -= c0;
    if (n < 4) break;
    const Eigen::RowVector3d c1 = x.transpose() * p.path_m / x.squaredNorm();
    p.path_m -= x * c1;
    p.speed_mps.rowwise() -= c1 * per_s;
    const Eigen::RowVector3d c2 = parabola.transpose() * p.path_m / parabola.squaredNorm();
    p.path_m -= parabola * c2;
    p.speed_mps -= 3 * per_s * x * c2;
  }
  return p;
}

// Adds weight * r r' to the matrix and weight * r * value to the right sides, for residuals r . u - value.
void add_row(BandedCholesky& A, Eigen::MatrixX3d& right, std::span<const Eigen::Index> index,
             std::span<const double> r, const Eigen::RowVector3d& value, double weight) {
  for (std::size_t i = 0; i < index.size(); ++i) {
    right.row(index[i]) += weight * r[i] * value;
    for (std::size_t j = 0; j < index.size(); ++j)
      if (index[j] <= index[i]) A.at(index[i], index[j]) += weight * r[i] * r[j];
  }
}

Eigen::Matrix3d drift_information(double noise_m2ps3, double walk_m2ps5, double dt) {
  Eigen::Matrix3d Q = Eigen::Matrix3d::Zero();
  Q(0, 0) = noise_m2ps3 * dt * dt * dt / 3;
  Q(0, 1) = Q(1, 0) = noise_m2ps3 * dt * dt / 2;
  Q(1, 1) = noise_m2ps3 * dt;
  Q(2, 2) = walk_m2ps5 * dt;
  return Q.inverse();
}

// u(k+1) - F u(k), six entries: G = [-F I].
Eigen::Matrix<double, 3, 6> drift_step(double dt) {
  Eigen::Matrix<double, 3, 6> G = Eigen::Matrix<double, 3, 6>::Zero();
  G.leftCols<3>() << -1, -dt, -dt * dt / 2, 0, -1, -dt, 0, 0, -1;
  G.rightCols<3>().setIdentity();
  return G;
}

// Where the record is not what the model says.
struct Exceptions {
  Rests rests;
  std::vector<bool> sea, offset;  // a node each: of any sea; of an offset that changes
  Exceptions of(Eigen::Index first, Eigen::Index last) const;  // those nodes alone
};

struct Solution {
  Eigen::VectorXd heave_m, heave_rate_mps, heave_variance_m2;
  Eigen::VectorXd drift;    // (d, d', b) a node
  double log_evidence = 0;  // of the record, but for a constant
};

// The normal equations in (d, d', b) at every node, a right side for each column of the paths.
struct NormalEquations {
  NormalEquations(Eigen::Index nodes, Eigen::Index order)
      : A(3 * nodes, std::max<Eigen::Index>(3 * std::min(order, nodes - 1), 5)),
        right(Eigen::MatrixX3d::Zero(3 * nodes, 3)) {}
  BandedCholesky A;
  Eigen::MatrixX3d right;
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  // of the weighted values
  double log_variances = 0;                           // of all residuals
};

class DriftProblem {
 public:
  DriftProblem(std::span<const LevelIncrement> increments, const SeaModel& model, const SensorDrift& sensor,
               std::span<const double> disturbance_m2ps3);
  Exceptions find_rests() const;
  Solution solve(const Exceptions& exceptions) const;
  // Of the rests, leaves those whose level is another than the sea's mean level.
  void keep_off_level(const Solution& solution, Rests& rests) const;
  // Marks the nodes about which the drift gains more speed than its noise gives it. False where there are
  // none.
  bool find_exceptions(const Solution& solution, Exceptions& exceptions) const;
  // Of each stretch of them: has the offset changed over it, or was it a sea that the model does not know?
  void tell_apart(Exceptions& exceptions) const;
  Eigen::Index nodes() const { return paths_.path_m.rows(); }

 private:
  void add_sea(const Exceptions& exceptions, NormalEquations& equations) const;
  void add_drift(const Exceptions& exceptions, NormalEquations& equations) const;
  Solution solution_of(NormalEquations& equations) const;
  double disturbed_m2ps3(double noise_m2ps3, Eigen::Index k) const {
    const double disturbance =
        disturbance_m2ps3_.empty() ? 0.0 : disturbance_m2ps3_[static_cast<std::size_t>(k)];
    return std::max(noise_m2ps3, disturbance);
  }

  std::span<const LevelIncrement> increments_;
  const SeaModel& model_;
  SensorDrift sensor_;
  std::span<const double> disturbance_m2ps3_;
  Paths paths_;
  Predictors<1> predictors_;
  Predictors<1> of_any_sea_;
  Pace pace_;
};

Pace pace(const SeaModel& model) {
  const double speed_mps =
      std::sqrt(std::max(2 * (model.autocovariance_m2[0] - model.autocovariance_m2[1]), 0.0)) /
      model.interval_s;
  const double memory_s = static_cast<double>(model.order()) * model.interval_s;
  return {speed_mps,
          std::min(memory_s, 2 * std::numbers::pi * std::sqrt(model.heave_variance_m2()) / speed_mps)};
}

// Of the model's sea over a slower one as high.
Predictors<1> predictors_of_any_sea(const SeaModel& model) {
  constexpr Eigen::Index kBins = 1025;
  const double df = 0.5 / model.interval_s / static_cast<double>(kBins - 1);
  const SeaModel slow =
      model_of_density(pierson_moskowitz_m2s(model.heave_variance_m2(), kSlowest_s, kBins, df), df,
                       model.interval_s, model.order(), kSlowRidge);
  return levinson(Eigen::VectorXd(model.autocovariance_m2 + slow.autocovariance_m2));
}

DriftProblem::DriftProblem(std::span<const LevelIncrement> increments, const SeaModel& model,
                           const SensorDrift& sensor, std::span<const double> disturbance_m2ps3)
    : increments_(increments),
      model_(model),
      sensor_(sensor),
      disturbance_m2ps3_(disturbance_m2ps3),
      paths_(integrate(increments, model.interval_s)),
      predictors_(levinson(model.autocovariance_m2)),
      of_any_sea_(predictors_of_any_sea(model)),
      pace_(pace(model)) {}

Exceptions DriftProblem::find_rests() const {
  const auto count = static_cast<std::size_t>(nodes());
  return {estimator::find_rests(paths_.speed_mps.col(0), model_.interval_s, pace_, sensor_.accel_noise_m2ps3),
          std::vector<bool>(count), std::vector<bool>(count)};
}

// The sea's innovations: e(k) = (path - d)(k) - sum a_j (path - d)(k-j). At rest, the path's own.
void DriftProblem::add_sea(const Exceptions& exceptions, NormalEquations& equations) const {
  const Eigen::Index order = model_.order();
  const Eigen::RowVectorXd as_before = Eigen::RowVectorXd::Ones(1);
  const double still_m2 = std::pow(std::max(kStillRate * pace_.rate_mps * model_.interval_s, kStill_m), 2);
  std::vector<Eigen::Index> index;
  std::vector<double> row;
  for (Eigen::Index k = 0, begin = 0; k < nodes(); ++k) {
    const auto node = static_cast<std::size_t>(k);
    const bool still = exceptions.rests.still[node] && k > 0, between = exceptions.rests.between[node];
    if (still || between) begin = k + 1;  // of the sea, which knows nothing of what was before
    const auto m =
        static_cast<std::size_t>(std::min(between ? k : std::max<Eigen::Index>(k - begin, 0), order));
    const Predictors<1>& predictors = between || exceptions.sea[node] ? of_any_sea_ : predictors_;
    const Eigen::RowVectorXd& a = still ? as_before : predictors.coefficients[m];
    index.assign(1, 3 * k);
    row.assign(1, 1.0);
    Eigen::RowVector3d value = paths_.path_m.row(k);
    for (Eigen::Index j = 1; j <= a.size(); ++j) {
      index.push_back(3 * (k - j));
      row.push_back(-a[j - 1]);
      value -= a[j - 1] * paths_.path_m.row(k - j);
    }
    const double weight = 1 / (still ? still_m2 : predictors.variance[m].value());
    equations.log_variances -= std::log(weight);
    add_row(equations.A, equations.right, index, row, value, weight);
    equations.squares += weight * value.transpose() * value;
  }
}

// The drift's steps, and what is known of it at first.
void DriftProblem::add_drift(const Exceptions& exceptions, NormalEquations& equations) const {
  BandedCholesky& A = equations.A;
  const double dt = model_.interval_s;
  const Eigen::Matrix<double, 3, 6> G = drift_step(dt);
  for (Eigen::Index k = 0; k + 1 < nodes(); ++k) {
    const double walk_m2ps5 =
        exceptions.offset[static_cast<std::size_t>(k)] ? kOffsetWalk_m2ps5 : model_.bias_walk_m2ps5;
    const Eigen::Matrix3d information =
        drift_information(disturbed_m2ps3(model_.accel_noise_m2ps3, k), walk_m2ps5, dt);
    equations.log_variances -= std::log(information.determinant());
    const Eigen::Matrix<double, 6, 6> W = G.transpose() * information * G;
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j <= i; ++j) A.at(3 * k + i, 3 * k + j) += W(i, j);
  }
  for (Eigen::Index k = 0; k < nodes(); ++k)
    A.at(3 * k, 3 * k) += 1 / (kPathVariance_m2 * static_cast<double>(nodes()));
  A.at(1, 1) += 1 / kSpeedVariance_m2ps2;
  A.at(2, 2) += 1 / kBiasVariance_m2ps4;
}

// The drift of each column of the paths; of these the leaks are taken as often as makes the whole most
// probable.
Solution DriftProblem::solution_of(NormalEquations& equations) const {
  BandedCholesky& A = equations.A;
  if (!A.factorise()) throw std::logic_error("smooth_heave: the normal equations are not positive definite");
  Eigen::MatrixX3d drifts(equations.right.rows(), 3);
  for (Eigen::Index column = 0; column < 3; ++column) {
    Eigen::VectorXd u = equations.right.col(column);
    A.solve(u);
    drifts.col(column) = u;
  }
  const Eigen::Matrix3d least = equations.squares - equations.right.transpose() * drifts;
  const double scale_variance = sensor_.gyro_scale_sigma * sensor_.gyro_scale_sigma;
  const Eigen::Matrix2d scale_known =
      Eigen::Matrix2d::Identity() + scale_variance * least.bottomRightCorner<2, 2>();
  const Eigen::Matrix2d scale_covariance = scale_variance * scale_known.inverse();
  const Eigen::Vector2d scale = scale_covariance * least.bottomLeftCorner<2, 1>();
  const Eigen::Vector3d taken(1, -scale.x(), -scale.y());

  const auto of_nodes = [](const auto& u, Eigen::Index state) {
    return u(Eigen::seqN(state, u.rows() / 3, 3), Eigen::all);
  };
  const Eigen::MatrixX2d leaks = (paths_.path_m - of_nodes(drifts, 0)).rightCols<2>();
  Solution solution;
  solution.drift = drifts * taken;
  solution.heave_m = paths_.path_m * taken - of_nodes(solution.drift, 0);
  solution.heave_rate_mps = paths_.speed_mps * taken - of_nodes(solution.drift, 1);
  solution.heave_variance_m2 =
      of_nodes(A.inverse_diagonal(), 0) + (leaks * scale_covariance).cwiseProduct(leaks).rowwise().sum();
  solution.log_evidence =
      -0.5 * (least(0, 0) - scale.dot(least.bottomLeftCorner<2, 1>()) + equations.log_variances +
              A.log_determinant() + std::log(scale_known.determinant()));
  return solution;
}

Solution DriftProblem::solve(const Exceptions& exceptions) const {
  NormalEquations equations(nodes(), model_.order());
  add_sea(exceptions, equations);
  add_drift(exceptions, equations);
  return solution_of(equations);
}

void DriftProblem::keep_off_level(const Solution& solution, Rests& rests) const {
  struct Rest {
    Eigen::Index begin, end;
    double level_m, variance_m2;
  };
  std::vector<Rest> found;
  double weights = 0, weighted = 0, squares = 0;
  for (Eigen::Index begin = 0, end = 0; begin < nodes(); begin = end + 1) {
    end = begin;
    while (end < nodes() && rests.still[static_cast<std::size_t>(end)]) ++end;
    if (end == begin) continue;
    const double level_m = solution.heave_m.segment(begin, end - begin).mean();
    const double variance_m2 = solution.heave_variance_m2.segment(begin, end - begin).mean();
    found.push_back({begin, end, level_m, variance_m2});
    weights += 1 / variance_m2;
    weighted += level_m / variance_m2;
    squares += level_m * level_m / variance_m2;
  }
  if (found.empty()) return;
  const double together = weighted * weighted / weights;  // chi square of their mean, and about it
  const bool at_one_level = squares - together <= kAgree * static_cast<double>(found.size() - 1);
  if (at_one_level && together > kOffLevel * kOffLevel) return;
  for (const Rest& rest : found)
    if (rest.level_m * rest.level_m <= kOffLevel * kOffLevel * rest.variance_m2)
      std::fill(rests.still.begin() + rest.begin, rests.still.begin() + rest.end, false);
}

bool DriftProblem::find_exceptions(const Solution& solution, Exceptions& exceptions) const {
  const double dt = model_.interval_s;
  const Eigen::Index steps = nodes() - 1;
  const Eigen::Index within = std::lround(kGainsWithin_s / dt), before = std::lround(kBefore_s / dt);
  if (steps < within) return false;
  Eigen::ArrayXd ratio(steps - within + 1);  // of the steps from here on
  double gained_mps = 0, variance = 0;
  const auto pass = [&](Eigen::Index k, double sign) {
    gained_mps +=
        sign * (solution.drift[3 * k + 4] - solution.drift[3 * k + 1] - dt * solution.drift[3 * k + 2]);
    variance += sign * dt * disturbed_m2ps3(sensor_.accel_noise_m2ps3, k);
  };
  for (Eigen::Index k = 0; k < within - 1; ++k) pass(k, 1);
  for (Eigen::Index first = 0; first < ratio.size(); ++first) {
    pass(first + within - 1, 1);
    ratio[first] = gained_mps * gained_mps / variance;
    pass(first, -1);
  }
  Eigen::ArrayXd sorted = ratio;
  const auto quarter = sorted.begin() + sorted.size() / 4;
  std::nth_element(sorted.begin(), quarter, sorted.end());
  const double surprising = kSurprising * std::max(*quarter / kUsual, 1.0);
  bool found = false;
  for (Eigen::Index first = 0, known = 0; first < ratio.size(); ++first) {
    if (ratio[first] < surprising) continue;
    found = true;
    // Until the autoregression remembers nothing of it.
    const Eigen::Index end = std::min(nodes(), first + within + model_.order());
    for (known = std::max(known, first - before); known < end; ++known) {
      const auto node = static_cast<std::size_t>(std::max<Eigen::Index>(known, 0));
      exceptions.sea[node] = exceptions.offset[node] = true;
    }
  }
  return found;
}

Exceptions Exceptions::of(Eigen::Index first, Eigen::Index last) const {
  const auto part = [&](const std::vector<bool>& all) {
    return std::vector<bool>(all.begin() + first, all.begin() + last + 1);
  };
  return {{part(rests.still), part(rests.between)}, part(sea), part(offset)};
}

void DriftProblem::tell_apart(Exceptions& exceptions) const {
  const Eigen::Index about = std::lround(kAbout_s / model_.interval_s);
  const auto none = [](std::vector<bool>& marks, Eigen::Index first, Eigen::Index last) {
    std::fill(marks.begin() + first, marks.begin() + last + 1, false);
  };
  for (Eigen::Index begin = 0; begin < nodes(); ++begin) {
    if (!exceptions.sea[static_cast<std::size_t>(begin)]) continue;
    Eigen::Index last = begin;
    while (last + 1 < nodes() && exceptions.sea[static_cast<std::size_t>(last + 1)]) ++last;
    const Eigen::Index from = std::max<Eigen::Index>(begin - about, 0),
                       to = std::min(last + about, nodes() - 1);
    const auto part = [&](const auto& all) {
      return all.subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
    };
    const DriftProblem problem(part(increments_), model_, sensor_,
                               disturbance_m2ps3_.empty() ? disturbance_m2ps3_ : part(disturbance_m2ps3_));
    Exceptions sea = exceptions.of(from, to), offset = sea;
    none(sea.offset, begin - from, last - from);
    none(offset.sea, begin - from, last - from);
    const bool changed = problem.solve(offset).log_evidence > problem.solve(sea).log_evidence + kChanged;
    none(changed ? exceptions.sea : exceptions.offset, begin, last);
    begin = last;
  }
}

}  // namespace

std::vector<SmoothedNode> smooth_heave(std::span<const LevelIncrement> increments, const SeaModel& model,
                                       const SensorDrift& sensor, std::span<const double> disturbance_m2ps3) {
  const DriftProblem problem(increments, model, sensor, disturbance_m2ps3);
  Exceptions exceptions = problem.find_rests();
  Solution solution = problem.solve(exceptions);
  Eigen::VectorXd unknown_level_m2 = Eigen::VectorXd::Zero(problem.nodes());
  if (exceptions.rests.any()) {
    unknown_level_m2 = solution.heave_variance_m2;
    problem.keep_off_level(solution, exceptions.rests);
    solution = problem.solve(exceptions);
  }
  if (problem.find_exceptions(solution, exceptions)) {
    problem.tell_apart(exceptions);
    solution = problem.solve(exceptions);
  }
  std::vector<SmoothedNode> answer(static_cast<std::size_t>(problem.nodes()));
  for (Eigen::Index k = 0; k < problem.nodes(); ++k)
    answer[static_cast<std::size_t>(k)] = {
        solution.heave_m[k], solution.heave_rate_mps[k], solution.drift[3 * k + 2],
        std::max({solution.heave_variance_m2[k], unknown_level_m2[k], 0.0})};
  return answer;
}

}  // namespace waverig::estimator
