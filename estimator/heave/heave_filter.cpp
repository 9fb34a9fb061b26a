#include "estimator/heave/heave_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "estimator/heave/node_spectrum.h"

namespace waverig::estimator {
namespace {

constexpr double kPathVariance_m2 = 100, kSpeedVariance_m2ps2 = 25;  // nothing known
constexpr double kScaleWalk_ps = 1e-8;                               // a thousandth in a hundred seconds
constexpr double kMeasurementVariance_m2 = 1e-10;  // the path is exact; this keeps the algebra regular
// Innovation squared over its variance from which on it surprises, and what it is then taken to be: a sea of
// one spectrum seldom makes a large one; in a restless one, moved by hand, they tell little of the drift.
struct Surprise {
  double from, taken;
};
constexpr Surprise kSteady{12, 3}, kRestless{2, 2};
// A mean over some 30 s of innovations squared over their variance, each at most kMostRestless, beyond which
// a sea is restless: of seas of one spectrum it is 0.2 to 1.1, of a board moved by hand 1.3 to 3.
constexpr double kRestlessFrom = 1.25, kRestlessShare = 1.0 / 120, kMostRestless = 30;
constexpr double kUsualGrowth = 1.02;  // a node; how soon the variance of innovations is found to have grown
constexpr double kFastestRise = 10, kLargestSurprise = 1e6;
constexpr double kCalmDown = 0.95;         // a node
constexpr double kRoughShare = 0.05;       // of a node in the mean that tells another sea
constexpr double kRecentShare = 1.0 / 40;  // of a node
constexpr double kQuiet = 0.06;  // of the sea's acceleration: a body that rests, its sensor's noise and all
constexpr double kShortestRest_s = 1.5;
constexpr double kRestVariance_m2 = 1e-8;  // by which a resting body is found to have moved, a node
constexpr double kRestLevel = 0.05;        // of the sea's variance: how far from its mean level it rests
constexpr Surprise kStirs{40, 3};          // of a rest that is none
constexpr int kOnset = 16;  // nodes of a sea that begins again: it need not be another one for being rough

}  // namespace

HeaveFilter::HeaveFilter(const SeaModel& model, double offset_sigma_mps2, double gyro_scale_sigma) {
  const double scale_variance = gyro_scale_sigma * gyro_scale_sigma;
  const DriftVector variances{kPathVariance_m2, kSpeedVariance_m2ps2, offset_sigma_mps2 * offset_sigma_mps2,
                              scale_variance, scale_variance};
  begin(model, variances.asDiagonal());
}

HeaveFilter::DriftMatrix HeaveFilter::transition(const LevelIncrement& increment, double dt_s) {
  DriftMatrix F = DriftMatrix::Identity();
  F(0, 1) = dt_s;
  F(0, 2) = dt_s * dt_s / 2;
  F(1, 2) = dt_s;
  F.block<1, 2>(0, 3) = increment.path_m.tail<2>().matrix().transpose();
  F.block<1, 2>(1, 3) = increment.speed_mps.tail<2>().matrix().transpose();
  return F;
}

void HeaveFilter::set_model(const SeaModel& model) {
  if (model.interval_s != model_.interval_s || model.order() != model_.order()) {
    begin(model, drift());
  } else {
    model_ = model;
  }
  surprise_ = roughness_ = 1;
  usual_variance_m2_ = kNoVariance;
}

double HeaveFilter::count_from_here() {
  z_.array() -= path_m_;
  return std::exchange(path_m_, 0.0);
}

void HeaveFilter::begin_sea(const SeaModel& model, double level_m) {
  set_model(model);
  path_m_ += level_m;
  begin_from_rest();
  restlessness_ = kNewSea;
}

// No heave is known at these nodes yet: its prior is the sea's own.
void HeaveFilter::begin(const SeaModel& model, const DriftMatrix& drift) {
  model_ = model;
  const int n = model.order();
  z_.setZero(n);
  P_.setZero(n + kDrift, n + kDrift);
  for (int j = 0; j < n; ++j) P_.col(j).segment(j, n - j) = model.autocovariance_m2.head(n - j);
  P_.bottomRightCorner<kDrift, kDrift>() = drift;
}

// Of its waves nothing is known yet but that they begin near the level of the rest; speed and bias are known.
void HeaveFilter::begin_from_rest() {
  DriftMatrix known = drift();
  known.row(0).setZero();
  known.col(0).setZero();
  known(0, 0) = kRestLevel * model_.heave_variance_m2();
  begin(model_, known);
}

void HeaveFilter::step(const HeaveStep& step) {
  const double dt = model_.interval_s;
  const PathIncrement sea = without_drift(step.increment, dt);
  path_m_ += dt * speed_mps_ + sea.path_m;
  speed_mps_ += sea.speed_mps;
  drift_speed_mps_ += dt * bias_mps2_;
  const double told_m = path_m_;
  const bool rested = rests_;
  look_for_rest(sea, step.turn_mps2);
  if (rested && !rests_) begin_from_rest();
  predict(step.increment, std::max(model_.accel_noise_m2ps3, step.disturbance_m2ps3));
  update();
  correction_m_ = rested || rests_ ? path_m_ - told_m : 0.0;
}

// Half a wave is the least: any sea has moments without acceleration.
void HeaveFilter::look_for_rest(const PathIncrement& sea, double turn_mps2) {
  const double dt = model_.interval_s;
  const double a_mps2 = second_difference_m(std::exchange(last_, sea), sea, dt) / (dt * dt);
  recent_m2ps4_ += kRecentShare * (a_mps2 * a_mps2 - recent_m2ps4_);
  const bool quiet = std::hypot(a_mps2, turn_mps2) < kQuiet * model_.acceleration_mps2();
  quiet_ = quiet ? quiet_ + 1 : 0;
  rests_ = quiet_ * dt > std::max(kShortestRest_s, std::numbers::pi / model_.mean_frequency_radps);
}

void HeaveFilter::skip(int intervals) {
  const int n = model_.order();
  for (int i = 0; i < intervals; ++i) predict({}, model_.accel_noise_m2ps3);
  P_.middleRows(n, 2).setZero();
  P_.block(n + 2, n, kDrift - 2, 2).setZero();
  P_(n, n) = kPathVariance_m2;
  P_(n + 1, n + 1) = kSpeedVariance_m2ps2;
  path_m_ = z_[0];
  speed_mps_ = 0;
  last_ = {};
  quiet_ = 0;
  rests_ = false;
}

void HeaveFilter::predict(const LevelIncrement& increment, double noise_m2ps3) {
  const int n = model_.order();
  const Eigen::VectorXd at_rest = rests_ ? Eigen::VectorXd::Unit(n, 0) : Eigen::VectorXd();
  const Eigen::VectorXd& a = rests_ ? at_rest : model_.ar;
  const double z = a.dot(z_);
  for (int i = n - 1; i > 0; --i) z_[i] = z_[i - 1];
  z_[0] = z;

  const double dt = model_.interval_s;
  const DriftMatrix F = transition(increment, dt);
  const auto heave = P_.topLeftCorner(n, n);
  const Eigen::VectorXd Pa = heave.selfadjointView<Eigen::Lower>() * a;
  const DriftVector with_drift = F * (P_.block(n, 0, kDrift, n) * a);
  for (int j = n - 1; j > 0; --j) {  // each heave is one node older
    P_.col(j).segment(j, n - j) = P_.col(j - 1).segment(j - 1, n - j);
    P_.col(j).tail<kDrift>() = F * P_.col(j - 1).tail<kDrift>();
  }
  P_(0, 0) = a.dot(Pa) + (rests_ ? kRestVariance_m2 : surprise_ * model_.innovation_m2);
  P_.col(0).segment(1, n - 1) = Pa.head(n - 1);
  P_.col(0).tail<kDrift>() = with_drift;
  DriftMatrix D = F * drift() * F.transpose();
  // White acceleration noise over one interval, integrated once and twice.
  D(0, 0) += noise_m2ps3 * dt * dt * dt / 3;
  D(1, 0) += noise_m2ps3 * dt * dt / 2;
  D(1, 1) += noise_m2ps3 * dt;
  D(2, 2) += model_.bias_walk_m2ps5 * dt;
  D.diagonal().tail<2>().array() += kScaleWalk_ps * dt;
  P_.bottomRightCorner<kDrift, kDrift>().triangularView<Eigen::Lower>() = D;
}

void HeaveFilter::update() {
  const int n = model_.order();
  const double innovation = path_m_ - z_[0];
  Eigen::VectorXd PH = P_.col(0);
  PH.head(n) += P_.row(n).head(n).transpose();
  PH.tail<kDrift>() += P_.col(n).tail<kDrift>();
  double S = PH[0] + PH[n] + kMeasurementVariance_m2;
  const double ratio = innovation * innovation / S;
  const auto take_for_sea = [&](double times) {
    const double more = S * (times - 1);
    P_(0, 0) += more;
    PH[0] += more;
    S += more;
  };
  stirs_ = rests_ && ratio > kStirs.from;
  if (stirs_) {
    take_for_sea(ratio / kStirs.taken);
    quiet_ = 0;
  }
  onset_ = rests_ ? kOnset : std::max(onset_ - 1, 0);
  if (onset_ == 0) {
    usual_variance_m2_ = std::min(S, kUsualGrowth * usual_variance_m2_);
    roughness_ += kRoughShare * (innovation * innovation / usual_variance_m2_ - roughness_);
  }
  // A sea that rises faster than the model is learned anew: believe the motion, leave the drift as it is.
  if (!rests_) {
    restlessness_ += kRestlessShare * (std::min(ratio, kMostRestless) - restlessness_);
    const Surprise& surprise = restlessness_ > kRestlessFrom ? kRestless : kSteady;
    if (ratio > surprise.from) {
      take_for_sea(ratio / surprise.taken);
      surprise_ = std::min(surprise_ * std::min(ratio / surprise.taken, kFastestRise), kLargestSurprise);
    } else {
      surprise_ = 1 + kCalmDown * (surprise_ - 1);
    }
  }
  log_likelihood_ -= 0.5 * (std::log(S) + innovation * innovation / S);
  const Eigen::VectorXd gain = PH / S;
  z_ += innovation * gain.head(n);
  path_m_ -= innovation * gain[n];
  speed_mps_ -= innovation * gain[n + 1];
  drift_speed_mps_ += innovation * gain[n + 1];
  bias_mps2_ += innovation * gain[n + 2];
  gyro_scale_ += innovation * gain.tail<2>().array();
  P_.selfadjointView<Eigen::Lower>().rankUpdate(PH, -1 / S);
}

double HeaveFilter::drifted_from(const HeaveFilter& before, double t) const {
  const DriftMatrix D = before.drift();
  const double variance = D(1, 1) + 2 * t * D(2, 1) + t * t * D(2, 2) + t * before.model_.accel_noise_m2ps3;
  const double expected_mps = before.drift_speed_mps_ + t * before.bias_mps2_;
  return std::abs(drift_speed_mps_ - expected_mps) / std::sqrt(variance);
}

double HeaveFilter::variance_m2(const LevelIncrement& partial, double since_s) const {
  const DriftVector h = transition(partial, since_s).row(0);
  return std::max(h.dot(drift() * h), 0.0);
}

}  // namespace waverig::estimator
