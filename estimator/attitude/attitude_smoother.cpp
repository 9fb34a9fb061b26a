#include "estimator/attitude/attitude_smoother.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace waverig::estimator {
namespace {

struct Forward {
  std::vector<AttitudeSample> samples;
  std::vector<AttitudeCorrection> nodes;
};

Forward run(AttitudeFilter& filter, const std::vector<ImuSample>& samples) {
  Forward forward;
  forward.samples.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    forward.samples.push_back(filter.update(sample));
    if (const AttitudeCorrection* correction = filter.correction()) forward.nodes.push_back(*correction);
  }
  return forward;
}

// Rauch, Tung, Striebel 1965, on changes instead of states: with d(k) the smoothed state less the filtered
// one just before the correction at node k, and C(k) = P+(k) F' P-(k+1)^-1,
//     d(k) = applied(k) + C(k) d(k+1).
struct Smoothed {
  std::vector<TiltState> after;   // smoothed less filtered, just after the correction of each node
  std::vector<TiltState> before;  // the same just before it
  std::vector<double> tilt_variance;
};

Smoothed backward(const std::vector<AttitudeCorrection>& nodes, double g) {
  const std::size_t n = nodes.size();
  Smoothed smoothed{std::vector<TiltState>(n, TiltState::Zero()), std::vector<TiltState>(n),
                    std::vector<double>(n)};
  if (n == 0) return smoothed;
  Eigen::Matrix4cd P = nodes.back().updated_P;
  for (std::size_t k = n; k-- > 0;) {
    if (k + 1 < n && nodes[k + 1].restarted) P = nodes[k].updated_P;
    if (k + 1 < n && !nodes[k + 1].restarted) {
      const Eigen::Matrix4cd F = TiltChain::transition(nodes[k + 1].dt_s, nodes[k + 1].turn, g);
      const Eigen::Matrix4cd C =
          nodes[k + 1].predicted_P.ldlt().solve(F * nodes[k].updated_P).adjoint();  // P is Hermitian
      smoothed.after[k] = C * smoothed.before[k + 1];
      P = (nodes[k].updated_P + C * (P - nodes[k + 1].predicted_P) * C.adjoint()).eval();
    }
    smoothed.before[k] = nodes[k].applied + smoothed.after[k];
    smoothed.tilt_variance[k] = P(2, 2).real();
  }
  return smoothed;
}

void apply(const TiltState& change, double tilt_variance, const AttitudeSettings& settings,
           const Vector3d& f_B, AttitudeSample& sample) {
  sample.q_NB = (quaternion_exp(tilt_rotation_N(change)) * sample.q_NB).normalized();
  sample.gyro_bias_B += sample.q_NB.conjugate() * bias_change_N(change);
  sample.a_N = sample.q_NB * f_B + Vector3d(0, 0, settings.gravity_mps2);
  sample.tilt_sigma_rad = std::hypot(std::sqrt(std::max(tilt_variance, 0.0)),
                                     settings.accel_bias_sigma_mps2 / settings.gravity_mps2);
  sample.settled = true;
}

// Between two nodes the change runs linearly: the filter's own error there is its noise, integrated.
void correct_samples(const std::vector<ImuSample>& imu, const std::vector<AttitudeCorrection>& nodes,
                     const Smoothed& smoothed, const AttitudeSettings& settings,
                     std::vector<AttitudeSample>& samples) {
  std::size_t k = 0;  // the first node not before the sample
  for (std::size_t i = 0; i < samples.size(); ++i) {
    while (k < nodes.size() && nodes[k].utime < samples[i].utime) ++k;
    TiltState change;
    double variance;
    if (k == nodes.size() || (k > 0 && nodes[k].restarted && samples[i].utime < nodes[k].restart_utime)) {
      change = smoothed.after[k - 1];
      variance = smoothed.tilt_variance[k - 1];
    } else if (nodes[k].utime == samples[i].utime) {
      change = smoothed.after[k];
      variance = smoothed.tilt_variance[k];
    } else if (k == 0 || nodes[k].restarted) {
      // Before the first correction since a start: undo, as it were, what the correction found.
      const double back_s = static_cast<double>(nodes[k].utime - samples[i].utime) * kMicrosecond;
      change = TiltChain::transition(-back_s, 1, settings.gravity_mps2) * smoothed.before[k];
      variance = smoothed.tilt_variance[k];
    } else {
      const double x = static_cast<double>(samples[i].utime - nodes[k - 1].utime) /
                       static_cast<double>(nodes[k].utime - nodes[k - 1].utime);
      change = (1 - x) * smoothed.after[k - 1] + x * smoothed.before[k];
      variance = (1 - x) * smoothed.tilt_variance[k - 1] + x * smoothed.tilt_variance[k];
    }
    apply(change, variance, settings, imu[i].f_B, samples[i]);
  }
}

}  // namespace

std::vector<AttitudeSample> smooth_attitude(const std::vector<ImuSample>& imu,
                                            const AttitudeSettings& settings, AttitudeFilter* live,
                                            const AttitudeSample* start) {
  if (imu.empty()) return {};
  AttitudeFilter filter =
      start ? AttitudeFilter(settings, start->q_NB, start->gyro_bias_B) : AttitudeFilter(settings);
  for (int pass = start ? 1 : 0;; ++pass) {
    Forward forward = run(filter, imu);
    if (live) *live = filter;
    if (forward.nodes.empty()) return forward.samples;  // shorter than one correction
    correct_samples(imu, forward.nodes, backward(forward.nodes, settings.gravity_mps2), settings,
                    forward.samples);
    if (pass == 1) return forward.samples;
    filter = AttitudeFilter(settings, forward.samples.front().q_NB, forward.samples.front().gyro_bias_B);
  }
}

}  // namespace waverig::estimator
