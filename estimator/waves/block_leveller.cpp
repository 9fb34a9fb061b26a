#include "estimator/waves/block_leveller.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr int kMostIterations = 15;
constexpr double kConverged_rad = 1e-6;
constexpr double kNode_s = 0.1;
constexpr double kGiven = 0.8,
                 kDropped = 0.6;  // of a full block: what is good enough to give, what is done with
constexpr double kFixed = 1e6;    // weight of what is not to be estimated, in those of the data
constexpr double kMotionCorrelation_s =
    3;  // in a block of ten seconds waves count as noise that lasts so long

// Rotation by a small vector (a few degrees): exact to the fifth power, without trigonometry.
Quaterniond small_rotation(const Vector3d& phi) {
  const double x = phi.squaredNorm();
  const double k = 0.5 - x / 48;
  return {1 - x / 8 + x * x / 384, k * phi.x(), k * phi.y(), k * phi.z()};
}

double taper(double t_s, double duration_s, double taper_s) {
  const double edge = std::min({t_s, duration_s - t_s, taper_s});
  return 0.5 - 0.5 * std::cos(std::numbers::pi * (edge + 1e-3) / (taper_s + 1e-3));
}

}  // namespace

void BlockLeveller::restart() {
  first_raw_ += raw_.size();
  given_ = first_raw_;
  raw_.clear();
  nodes_.clear();
  has_rate_ = has_attitude_ = false;
}

void BlockLeveller::add(const ImuSample& s, const GuardVerdict& verdict, std::deque<LevelledSample>& out) {
  if (verdict.usable && !started_) {
    started_ = true;
    first_utime_ = s.utime;
  }
  // A block begins with a usable sample: those before it have no time to begin with.
  if (verdict.usable && (!has_rate_ || verdict.dt_s > settings_.longest_gap_s)) finish(out);
  if (verdict.usable) last_t_s_ = static_cast<double>(s.utime - first_utime_) * kMicrosecond;
  if (nodes_.empty() || nodes_.back().duration_s >= kNode_s) {
    Node node;
    node.first = first_raw_ + raw_.size();
    node.begin_s = nodes_.empty() ? last_t_s_ : nodes_.back().begin_s + nodes_.back().duration_s;
    nodes_.push_back(node);
  }
  Node& node = nodes_.back();
  Raw raw;
  LevelledSample& l = raw.levelled;
  l.utime = s.utime;
  l.seq = s.seq;
  l.flags = verdict.flags;
  l.usable = verdict.usable && !(verdict.flags & flag::kSaturation);
  l.t_s = last_t_s_;
  l.f_B = s.f_B;
  if (verdict.usable) {
    if (has_rate_) {
      raw.turn_B = 0.5 * (last_w_B_ + s.w_NB_B) * verdict.dt_s;
      raw.dt_s = verdict.dt_s;
      node.turn = node.turn * small_rotation(raw.turn_B);
      node.duration_s += verdict.dt_s;
    }
    last_w_B_ = s.w_NB_B;
    has_rate_ = true;
    if (l.usable) {
      node.force_sum += node.turn * s.f_B;
      node.forces += 1;
    }
  }
  raw_.push_back(raw);

  const double begin_s = nodes_.front().begin_s;
  if (l.t_s - begin_s < settings_.block_s) return;
  const auto node_at = [&](double part) {
    return std::find_if(nodes_.begin(), nodes_.end(),
                        [&](const Node& n) { return n.begin_s >= begin_s + part * settings_.block_s; });
  };
  const auto given = node_at(kGiven), keep = node_at(kDropped);
  if (given == nodes_.end() || keep == nodes_.end()) {  // a block hardly longer than a node
    finish(out);
    return;
  }
  level(given->first, out);
  q_start_ = keep->q_NB;
  raw_.erase(raw_.begin(), raw_.begin() + static_cast<std::ptrdiff_t>(keep->first - first_raw_));
  first_raw_ = keep->first;
  nodes_.erase(nodes_.begin(), keep);
}

void BlockLeveller::finish(std::deque<LevelledSample>& out) {
  level(first_raw_ + raw_.size(), out);
  restart();
}

bool BlockLeveller::iterate() {
  const double begin_s = nodes_.front().begin_s, g = settings_.gravity_mps2;
  const double duration_s = nodes_.back().begin_s + nodes_.back().duration_s - begin_s;
  const double taper_s = std::min(settings_.taper_s, 0.4 * duration_s);

  // Rows, small phi and f_N near (0, 0, -g): f_x - g phi_y = 0, f_y + g phi_x = 0; unknowns phi_x, phi_y, db.
  Matrix5 N = Matrix5::Zero();
  Vector5 b = Vector5::Zero();
  double weights = 0, squares = 0;
  Matrix3d turned = Matrix3d::Zero();  // integral of R dt
  Vector3d up_B = Vector3d::Zero();    // mean
  Quaterniond q = q_start_;
  for (Node& node : nodes_) {
    node.q_NB = q;
    const Matrix3d R_NB = q.toRotationMatrix();
    const Matrix3d half_turned = 0.5 * node.duration_s * R_NB;
    turned += half_turned;
    up_B -= R_NB.row(2).transpose();
    if (node.forces > 0) {
      const Vector3d f = node.force_sum / node.forces;
      const Vector3d f_N = R_NB * (f - 0.5 * node.duration_s * bias_B_.cross(f));
      const double w = taper(node.begin_s - begin_s + 0.5 * node.duration_s, duration_s, taper_s);
      Eigen::Matrix<double, 2, 5> H;
      H << 0, -g, g * turned.row(1), g, 0, -g * turned.row(0);
      N.noalias() += w * (H.transpose() * H);
      b.noalias() -= w * (H.transpose() * f_N.head<2>());
      weights += w;
      squares += w * f_N.head<2>().squaredNorm();
    }
    turned += half_turned;
    q = q * node.turn * small_rotation(-bias_B_ * node.duration_s);
  }
  if (weights <= 0) return true;

  // The prior of the bias against the block's own horizontal motion, taken as noise; the longer the block,
  // the less of the waves is left near zero frequency.
  const double variance = std::max(0.5 * squares / weights, 1e-6);
  const double shorter = std::min(1.0, 10 / std::max(duration_s, kNode_s));
  const double prior = variance * kMotionCorrelation_s * shorter * shorter / kNode_s /
                       std::max(settings_.gyro_bias_sigma_radps * settings_.gyro_bias_sigma_radps, 1e-16);
  // The bias about the vertical turns the frame but does not lean it. Left free it would lend a tilting
  // body's waves a tilt error of their own frequency, to explain their horizontal acceleration away: it stays
  // as guessed.
  up_B.normalize();
  const Matrix3d across = Matrix3d::Identity() - up_B * up_B.transpose();
  N.bottomRightCorner<3, 3>() += prior * across + kFixed * N.trace() * up_B * up_B.transpose();
  b.tail<3>() -= prior * across * bias_B_;
  N.diagonal().head<2>().array() += 1e-12 * g * g;
  const Vector5 x = N.ldlt().solve(b);
  if (!x.allFinite()) return true;
  q_start_ = (quaternion_exp(Vector3d(x(0), x(1), 0)) * q_start_).normalized();
  bias_B_ += x.tail<3>();
  return x.head<2>().norm() < kConverged_rad && x.tail<3>().norm() * duration_s < kConverged_rad;
}

// Start: the mean rate is the bias (a platform keeps its attitude), the mean of the first seconds is up.
void BlockLeveller::guess_attitude() {
  Vector3d turn = Vector3d::Zero(), force = Vector3d::Zero();
  double duration_s = 0;
  for (const Raw& r : raw_) {
    turn += r.turn_B;
    duration_s += r.dt_s;
    if (r.levelled.usable && r.levelled.t_s < nodes_.front().begin_s + 0.1 * settings_.block_s) {
      force += r.levelled.f_B;
    }
  }
  if (force.norm() <= 0) return;
  bias_B_ = duration_s > 0 ? Vector3d(turn / duration_s) : Vector3d::Zero();
  q_start_ = Quaterniond::FromTwoVectors(force, -Vector3d::UnitZ());
  has_attitude_ = true;
}

void BlockLeveller::level(std::size_t until, std::deque<LevelledSample>& out) {
  if (raw_.empty()) return;
  if (!has_attitude_) guess_attitude();
  for (int i = 0; has_attitude_ && i < kMostIterations && !iterate(); ++i) {
  }
  for (std::size_t n = 0; n < nodes_.size() && nodes_[n].first < until; ++n) {
    const std::size_t end = n + 1 < nodes_.size() ? nodes_[n + 1].first : first_raw_ + raw_.size();
    if (end <= given_) continue;
    Quaterniond q = nodes_[n].q_NB;
    for (std::size_t i = nodes_[n].first; i < std::min(end, until); ++i) {
      Raw& r = raw_[i - first_raw_];
      if (r.dt_s > 0) q = q * small_rotation(r.turn_B - bias_B_ * r.dt_s);
      if (i < given_) continue;
      LevelledSample& l = r.levelled;
      l.q_NB = q;
      l.up_mps2 = -(q * l.f_B).z() - settings_.gravity_mps2;
      out.push_back(l);
    }
  }
  given_ = std::max(given_, until);
}

}  // namespace waverig::estimator
