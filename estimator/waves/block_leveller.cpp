#include "estimator/waves/block_leveller.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

constexpr int kMostIterations = 12;
constexpr double kConverged_rad = 2e-5;        // a_h times this is nothing
constexpr double kMotionCorrelation_s = 3;     // in a block of ten seconds waves count as noise that lasts so long
constexpr double kNodeInterval_s = 0.1;        // the horizontal residual is gathered over so long

// Rotation by a small vector (a degree or so): exact to the fifth power, without trigonometry.
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

void BlockLeveller::add(const ImuSample& s, const GuardVerdict& verdict, std::deque<LevelledSample>& out) {
  if (!started_) {
    started_ = true;
    first_utime_ = s.utime;
  }
  if (verdict.usable && verdict.dt_s > settings_.longest_gap_s) {
    level(raw_.size(), out);
    raw_.clear();
    given_ = 0;
    has_attitude_ = false;
  }
  Raw raw;
  raw.rotates = verdict.usable;
  raw.dt_s = verdict.dt_s;
  raw.w_B = s.w_NB_B;
  LevelledSample& l = raw.levelled;
  l.utime = s.utime;
  l.seq = s.seq;
  l.flags = verdict.flags;
  l.usable = verdict.usable && !(verdict.flags & flag::kSaturation);
  if (verdict.usable) last_t_s_ = static_cast<double>(s.utime - first_utime_) * kMicrosecond;
  l.t_s = last_t_s_;
  l.f_B = s.f_B;
  raw_.push_back(raw);

  if (l.t_s - raw_.front().levelled.t_s < settings_.block_s) return;
  // A full block: its first three quarters are good enough to give; the first half is then no longer needed.
  const double begin_s = raw_.front().levelled.t_s;
  std::size_t give = 0, drop = 0;
  for (const Raw& r : raw_) {
    if (r.levelled.t_s < begin_s + 0.5 * settings_.block_s) ++drop;
    if (r.levelled.t_s < begin_s + 0.75 * settings_.block_s) ++give;
  }
  level(give, out);
  q_start_ = raw_[drop].levelled.q_NB;
  raw_.erase(raw_.begin(), raw_.begin() + static_cast<std::ptrdiff_t>(drop));
  given_ = give - drop;
}

void BlockLeveller::finish(std::deque<LevelledSample>& out) {
  level(raw_.size(), out);
  raw_.clear();
  given_ = 0;
}

double BlockLeveller::integrate() {
  Quaterniond q = q_start_;
  const Vector3d* last_w = nullptr;
  for (Raw& r : raw_) {
    if (r.rotates) {
      if (last_w) q = q * small_rotation((0.5 * (*last_w + r.w_B) - bias_B_) * r.dt_s);
      last_w = &r.w_B;
    }
    r.levelled.q_NB = q;
  }
  return raw_.back().levelled.t_s - raw_.front().levelled.t_s;
}

bool BlockLeveller::iterate() {
  const double duration_s = integrate();
  const double begin_s = raw_.front().levelled.t_s, taper_s = std::min(settings_.taper_s, 0.4 * duration_s);
  const double g = settings_.gravity_mps2;

  // Rows, small phi and f_N near (0, 0, -g): f_x - g phi_y = 0, f_y + g phi_x = 0; unknowns phi_x, phi_y, db.
  Matrix5 N = Matrix5::Zero();
  Vector5 b = Vector5::Zero();
  double weights = 0, squares = 0;
  Matrix3d turned = Matrix3d::Zero();                    // integral of R dt
  Vector3d force_sum = Vector3d::Zero();
  double count = 0, last_t_s = begin_s, node_s = begin_s;
  const auto close_node = [&](double t_s) {
    const Vector3d f_N = force_sum / count;
    const double w = taper(t_s - begin_s, duration_s, taper_s);
    Eigen::Matrix<double, 2, 5> H;
    H << 0, -g, g * turned.row(1), g, 0, -g * turned.row(0);
    N.noalias() += w * (H.transpose() * H);
    b.noalias() -= w * (H.transpose() * f_N.head<2>());
    weights += w;
    squares += w * f_N.head<2>().squaredNorm();
    force_sum.setZero();
    count = 0;
    node_s = t_s;
  };
  for (const Raw& r : raw_) {
    if (!r.rotates) continue;
    const Matrix3d R_NB = r.levelled.q_NB.toRotationMatrix();
    turned += R_NB * (r.levelled.t_s - last_t_s);
    last_t_s = r.levelled.t_s;
    if (!r.levelled.usable) continue;
    force_sum += R_NB * r.levelled.f_B;
    ++count;
    if (r.levelled.t_s - node_s >= kNodeInterval_s) close_node(r.levelled.t_s);
  }
  if (count > 0) close_node(last_t_s);
  if (weights <= 0) return true;

  // The prior of the bias against the block's own horizontal motion, taken as noise; the longer the block, the less
  // of the waves is left near zero frequency.
  const double variance = std::max(0.5 * squares / weights, 1e-6), shorter = std::min(1.0, 10 / duration_s);
  const double prior = variance * kMotionCorrelation_s * shorter * shorter / std::max(kNodeInterval_s, duration_s / weights) /
                       std::max(settings_.gyro_bias_sigma_radps * settings_.gyro_bias_sigma_radps, 1e-16);
  N.diagonal().tail<3>().array() += prior;
  b.tail<3>() -= prior * bias_B_;
  N.diagonal().head<2>().array() += 1e-12 * g * g;
  const Vector5 x = N.ldlt().solve(b);
  if (!x.allFinite()) return true;
  q_start_ = (quaternion_exp(Vector3d(x(0), x(1), 0)) * q_start_).normalized();
  bias_B_ += x.tail<3>();
  return x.head<2>().norm() < kConverged_rad && x.tail<3>().norm() * duration_s < kConverged_rad;
}

void BlockLeveller::level(std::size_t count, std::deque<LevelledSample>& out) {
  if (raw_.empty()) return;
  if (!has_attitude_) {
    // Start: the mean rate is the bias (a platform keeps its attitude), the mean of the first seconds is up.
    Vector3d rate = Vector3d::Zero(), force = Vector3d::Zero();
    double rates = 0;
    for (const Raw& r : raw_) {
      if (!r.rotates) continue;
      rate += r.w_B;
      ++rates;
      if (r.levelled.usable && r.levelled.t_s < raw_.front().levelled.t_s + 0.1 * settings_.block_s) {
        force += r.levelled.f_B;
      }
    }
    if (rates > 0 && force.norm() > 0) {
      bias_B_ = rate / rates;
      q_start_ = Quaterniond::FromTwoVectors(force, -Vector3d::UnitZ());
      has_attitude_ = true;
    }
  }
  for (int i = 0; has_attitude_ && i < kMostIterations && !iterate(); ++i) {
  }
  integrate();
  for (std::size_t i = given_; i < count; ++i) {
    LevelledSample& l = raw_[i].levelled;
    l.up_mps2 = -(l.q_NB * l.f_B).z() - settings_.gravity_mps2;
    out.push_back(l);
  }
  given_ = count;
}

}  // namespace waverig::estimator
