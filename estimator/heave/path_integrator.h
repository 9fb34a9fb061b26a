// PathIntegrator: vertical acceleration at any sample times, integrated twice between the nodes of an even
// time grid.
//
// Everything slow about heave (drift, bias, the sea's spectrum) is decided at the nodes; between them the
// path is the acceleration's own double integral, so that gain and lag at wave frequencies are exact. A node
// interval is told by its two increments, free of any initial speed or position:
//     speed_mps = int a dt,      path_m = int int a dt dt         (over one interval, from rest)
// Value: double, or an Eigen array of what goes the same way.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "motion/kinematics/frames.h"

namespace waverig::estimator {

template <class Value>
struct Increment {
  Value speed_mps = Value(0.0), path_m = Value(0.0);

  // The increment over this interval and the next, which lasts next_s.
  Increment then(const Increment& next, double next_s) const {
    return {speed_mps + next.speed_mps, path_m + next_s * speed_mps + next.path_m};
  }
};
using PathIncrement = Increment<double>;
// Of the levelled vertical acceleration, up, and of the two leaks into it (disturbance.h).
using LevelIncrement = Increment<Eigen::Array3d>;
inline PathIncrement up(const LevelIncrement& increment) {
  return {increment.speed_mps[0], increment.path_m[0]};
}

template <class Value>
class Integrator {
 public:
  explicit Integrator(double node_interval_s) : node_us_(std::llround(node_interval_s / kMicrosecond)) {}

  // Begins anew with a node at utime: at the start and after a gap.
  void start(std::int64_t utime, const Value& a_mps2) {
    node_utime_ = last_utime_ = utime;
    last_a_mps2_ = a_mps2;
    last_length_s_ = 0;
    partial_ = {};
  }

  // Takes the next sample. Calls node(node_utime, increment) for each node passed, in order; afterwards
  // partial() is the increment from the last node to this sample. Between samples the acceleration runs along
  // the parabola through the last three, where they are evenly spaced.
  template <class Node>
  void add(std::int64_t utime, const Value& a_mps2, Node&& node) {
    const Segment segment = segment_to(utime, a_mps2);
    double from_s = 0;
    while (utime - node_utime_ >= node_us_) {
      node_utime_ += node_us_;
      const double to_s = kMicrosecond * static_cast<double>(node_utime_ - last_utime_);
      advance(segment, from_s, to_s);
      const Increment<Value> whole = partial_;
      partial_ = {};
      from_s = to_s;
      node(node_utime_, whole);
    }
    advance(segment, from_s, segment.length_s);
    accept(utime, a_mps2, segment);
  }

  const Increment<Value>& partial() const { return partial_; }
  double since_node_s() const { return kMicrosecond * static_cast<double>(last_utime_ - node_utime_); }
  std::int64_t last_utime() const { return last_utime_; }

 private:
  static constexpr double kAlike = 3;
  struct Segment {  // a(s) = c0 + c1 s + c2 s^2, s in seconds from the sample before
    Value c0, c1, c2;
    double length_s;
  };
  Segment segment_to(std::int64_t utime, const Value& a_mps2) const {
    const double h = kMicrosecond * static_cast<double>(utime - last_utime_);
    const Value slope = (a_mps2 - last_a_mps2_) / h;
    // Newton's divided differences; a straight line while there are only two samples, and after an interval
    // of quite another length, whose secant would carry the noise of its samples far.
    const bool alike = last_length_s_ > h / kAlike && last_length_s_ < kAlike * h;
    const Value c2 = alike ? Value((slope - last_slope_) / (h + last_length_s_)) : Value(0.0);
    return {last_a_mps2_, slope - c2 * h, c2, h};
  }
  void advance(const Segment& g, double from_s, double to_s) {
    const double h = to_s - from_s;
    const Value a = g.c0 + from_s * (g.c1 + from_s * g.c2), b = g.c1 + 2 * g.c2 * from_s;  // about from_s
    partial_.path_m += h * (partial_.speed_mps + h * (a / 2 + h * (b / 6 + h * g.c2 / 12)));
    partial_.speed_mps += h * (a + h * (b / 2 + h * g.c2 / 3));
  }
  void accept(std::int64_t utime, const Value& a_mps2, const Segment& g) {
    last_slope_ = (a_mps2 - last_a_mps2_) / g.length_s;
    last_length_s_ = g.length_s;
    last_a_mps2_ = a_mps2;
    last_utime_ = utime;
  }

  std::int64_t node_us_, node_utime_ = 0, last_utime_ = 0;
  Value last_a_mps2_ = Value(0.0), last_slope_ = Value(0.0);  // slope: of the secant before the last sample
  double last_length_s_ = 0;
  Increment<Value> partial_;
};
using PathIntegrator = Integrator<double>;

}  // namespace waverig::estimator
