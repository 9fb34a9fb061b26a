// PathIntegrator: vertical acceleration at any sample times, integrated twice between the nodes of an even
// time grid.
//
// Everything slow about heave (drift, bias, the sea's spectrum) is decided at the nodes; between them the
// path is the acceleration's own double integral, so that gain and lag at wave frequencies are exact. A node
// interval is told by its two increments, free of any initial speed or position:
//     speed_mps = int a dt,      path_m = int int a dt dt         (over one interval, from rest)
#pragma once
#include <cstdint>

namespace waverig::estimator {

struct PathIncrement {
  double speed_mps = 0, path_m = 0;

  // The increment over this interval and the next, which lasts next_s.
  PathIncrement then(const PathIncrement& next, double next_s) const {
    return {speed_mps + next.speed_mps, path_m + next_s * speed_mps + next.path_m};
  }
};

class PathIntegrator {
 public:
  explicit PathIntegrator(double node_interval_s)
      : node_us_(static_cast<std::int64_t>(node_interval_s * 1e6 + 0.5)) {}

  // Begins anew with a node at utime: at the start and after a gap.
  void start(std::int64_t utime, double a_mps2);

  // Takes the next sample. Calls node(node_utime, increment) for each node passed, in order; afterwards
  // partial() is the increment from the last node to this sample. Between samples the acceleration runs along
  // the parabola through the last three.
  template <class Node>
  void add(std::int64_t utime, double a_mps2, Node&& node) {
    const Segment segment = segment_to(utime, a_mps2);
    double from_s = 0;
    while (node_utime_ + node_us_ <= utime) {
      node_utime_ += node_us_;
      const double to_s = 1e-6 * static_cast<double>(node_utime_ - last_utime_);
      advance(segment, from_s, to_s);
      const PathIncrement whole = partial_;
      partial_ = {};
      from_s = to_s;
      node(node_utime_, whole);
    }
    advance(segment, from_s, segment.length_s);
    accept(utime, a_mps2, segment);
  }

  const PathIncrement& partial() const { return partial_; }
  double since_node_s() const { return 1e-6 * static_cast<double>(last_utime_ - node_utime_); }
  std::int64_t node_utime() const { return node_utime_; }
  std::int64_t last_utime() const { return last_utime_; }
  double node_interval_s() const { return 1e-6 * static_cast<double>(node_us_); }

 private:
  struct Segment {  // a(s) = c0 + c1 s + c2 s^2, s in seconds from the sample before
    double c0, c1, c2, length_s;
  };
  Segment segment_to(std::int64_t utime, double a_mps2) const;
  void advance(const Segment& segment, double from_s, double to_s);
  void accept(std::int64_t utime, double a_mps2, const Segment& segment);

  std::int64_t node_us_, node_utime_ = 0, last_utime_ = 0;
  double last_a_mps2_ = 0, last_slope_ = 0,
         last_length_s_ = 0;  // slope: of the secant before the last sample
  PathIncrement partial_;
};

}  // namespace waverig::estimator
