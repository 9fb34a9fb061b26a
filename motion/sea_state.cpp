#include "motion/sea_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "motion/tilt.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

constexpr double kLongestKnot_s = 0.05;
constexpr double kLargestKnotAngle_rad = 0.35;  // of the fastest component between two knots

void require(bool good, const char* key, double value, const char* expected) {
  if (!good) throw UserError(fmt::format("sea: {} = {} is not {}", key, value, expected));
}

// Directions against the mean: the middle of each of n equal shares of cos^2s(theta/2). Neighbours in
// frequency take shares a golden section of all apart, from a random start: the few components that carry a
// sea's energy then have its whole spreading, as they would not by chance.
std::vector<double> draw_directions(int n, double spreading_s, RandomStream& random) {
  std::vector<double> directions(static_cast<std::size_t>(n), 0);
  if (spreading_s == 0) return directions;
  constexpr int kGrid = 7200;
  const double step = 2 * pi / kGrid;
  const auto weight = [&](int i) {
    return std::pow(std::abs(std::cos(0.5 * (-pi + (i + 0.5) * step))), 2 * spreading_s);
  };
  double total = 0;
  for (int i = 0; i < kGrid; ++i) total += weight(i);
  double below = 0;
  int cell = 0;
  for (int k = 0; k < n; ++k) {
    const double wanted = (k + 0.5) / n * total;
    while (cell < kGrid - 1 && below + weight(cell) < wanted) below += weight(cell++);
    directions[static_cast<std::size_t>(k)] = -pi + (cell + (wanted - below) / weight(cell)) * step;
  }
  std::vector<double> place(directions.size());
  const double start = random.uniform();
  for (std::size_t i = 0; i < place.size(); ++i) {
    const double x = start + static_cast<double>(i) / std::numbers::phi;
    place[i] = x - std::floor(x);
  }
  std::vector<std::size_t> order(directions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
  std::vector<double> shared(directions.size());
  for (std::size_t k = 0; k < order.size(); ++k) shared[order[k]] = directions[k];
  return shared;
}

// Turns all directions together until the energy's mean lies where it shall.
void centre_directions(std::vector<WaveComponent>& components, double towards_rad) {
  double along = 0, across = 0;
  for (const auto& c : components) {
    const double e = c.amplitude_m * c.amplitude_m;
    along += e * std::cos(c.towards_rad - towards_rad);
    across += e * std::sin(c.towards_rad - towards_rad);
  }
  const double off_rad = std::atan2(across, along);
  for (auto& c : components) c.towards_rad -= off_rad;
}

}  // namespace

std::vector<WaveComponent> draw_components(const SeaSettings& s) {
  const WaveSpectrum spectrum(s.shape, s.hm0_m, s.tp_s, s.gamma);
  require(s.components >= 10 && s.components <= 100000, "components", s.components, "between 10 and 100000");
  require(s.lowest_relative >= 0 && s.lowest_relative < 1, "lowest_relative", s.lowest_relative, "in [0, 1)");
  require(s.highest_relative > 1 && s.highest_relative <= 20, "highest_relative", s.highest_relative,
          "in (1, 20]");
  require(s.spreading_s >= 0 && s.spreading_s <= 1000, "spreading_s", s.spreading_s, "between 0 and 1000");

  RandomStream frequency(s.seed, "sea frequency"), phase(s.seed, "sea phase"),
      direction(s.seed, "sea direction"), amplitude(s.seed, "sea amplitude");
  const std::vector<double> spread = draw_directions(s.components, s.spreading_s, direction);
  const double f0 = s.lowest_relative * spectrum.peak_Hz();
  const double band = (s.highest_relative * spectrum.peak_Hz() - f0) / s.components;
  std::vector<WaveComponent> components(static_cast<std::size_t>(s.components));
  double variance = 0;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const double low = f0 + static_cast<double>(i) * band;
    double share = spectrum.variance_between(low, low + band);
    if (s.random_amplitudes) share *= -std::log(1 - amplitude.uniform());
    components[i] = {.w_radps = 2 * pi * (low + band * frequency.uniform()),
                     .amplitude_m = std::sqrt(2 * share),
                     .phase_rad = 2 * pi * phase.uniform(),
                     .towards_rad = s.direction_from_rad + pi + spread[i]};
    variance += share;
  }
  if (s.exact_hm0) {
    const double scale = s.hm0_m / (4 * std::sqrt(variance));
    for (auto& c : components) c.amplitude_m *= scale;
  }
  if (s.spreading_s > 0) centre_directions(components, s.direction_from_rad + pi);
  return components;
}

SeaMoments moments_of(const std::vector<WaveComponent>& components) {
  SeaMoments m;
  double a1 = 0, b1 = 0;
  for (const auto& c : components) {
    const double f = c.w_radps / (2 * pi), e = 0.5 * c.amplitude_m * c.amplitude_m;
    m.m_minus1 += e / f;
    m.m0 += e;
    m.m1 += e * f;
    m.m2 += e * f * f;
    m.m4 += e * f * f * f * f;
    a1 += e * std::cos(c.towards_rad);
    b1 += e * std::sin(c.towards_rad);
  }
  const double from = std::atan2(-b1, -a1);
  m.mean_direction_from_rad = from < 0 ? from + 2 * pi : from;
  m.spread_rad = std::sqrt(std::max(0.0, 2 * (1 - std::hypot(a1, b1) / m.m0)));
  return m;
}

SeaMotion::SeaMotion(std::vector<WaveComponent> components, const FloatSettings& settings)
    : components_(std::move(components)), settings_(settings) {
  require(!components_.empty(), "components", 0, "at least one");
  double fastest = 0;
  for (const auto& c : components_) fastest = std::max(fastest, c.w_radps);
  require(std::isfinite(fastest) && fastest > 0 && fastest < 1000, "w_radps", fastest,
          "between 0 and 1000 rad/s");
  require(settings_.tilt_rad == 0 || settings_.tilt_period_s > 0, "tilt_period_s", settings_.tilt_period_s,
          "positive");
  require(settings_.heading_wander_rad == 0 || settings_.heading_wander_period_s > 0,
          "heading_wander_period_s", settings_.heading_wander_period_s, "positive");
  knot_us_ = std::llround(1e6 * std::min(kLongestKnot_s, kLargestKnotAngle_rad / fastest));
  knot_s_ = 1e-6 * static_cast<double>(knot_us_);
  RandomStream random(settings_.seed, "float tilt");
  tilt_phase_rad_ = 2 * pi * random.uniform();
  wander_phase_rad_ = 2 * pi * random.uniform();
}

void SeaMotion::fill_block(std::int64_t block) {
  for (auto& channel : knots_) channel.fill(0);
  const double t_s = static_cast<double>(block) * static_cast<double>(kKnots) * knot_s_;
  std::array<double, kKnots + 1> c{}, s{};
  for (const auto& component : components_) {
    const double w = component.w_radps;
    // The rotating phasor at all knots: begun afresh in every block, then doubled, so that errors do not
    // grow.
    c[0] = std::cos(w * t_s + component.phase_rad);
    s[0] = std::sin(w * t_s + component.phase_rad);
    for (std::size_t n = 1; n <= kKnots; n *= 2) {
      const double angle = w * knot_s_ * static_cast<double>(n), cosine = std::cos(angle),
                   sine = std::sin(angle);
      const std::size_t count = std::min(n, kKnots + 1 - n);
      for (std::size_t k = 0; k < count; ++k) {
        c[n + k] = c[k] * cosine - s[k] * sine;
        s[n + k] = s[k] * cosine + c[k] * sine;
      }
    }
    // Airy, deep water: surface a cos, drift along the way a sin: the crest runs forward.
    const double a = component.amplitude_m, w2 = w * w;
    const auto add = [&](std::size_t channel, double factor, const std::array<double, kKnots + 1>& x) {
      double* sum = knots_[channel].data();
      for (std::size_t k = 0; k <= kKnots; ++k) sum[k] += factor * x[k];
    };
    add(kUp, a, c);
    add(kUp1, -a * w, s);
    add(kUp2, -a * w2, c);
    for (const auto& [first, part] : {std::pair{kNorth, std::cos(component.towards_rad)},
                                      std::pair{kEast, std::sin(component.towards_rad)}}) {
      add(first, a * part, s);
      add(first + 1UL, a * part * w, c);
      add(first + 2UL, -a * part * w2, s);
      add(first + 3UL, -a * part * w2 * w, c);
      add(first + 4UL, a * part * w2 * w2, s);
    }
  }
  block_ = block;
}

// Through value, first and second derivative at both ends.
SeaMotion::Quintic SeaMotion::join(std::size_t i, Channel value, Channel first, Channel second,
                                   double factor) const {
  const double h = knot_s_;
  const double p0 = factor * knots_[value][i], p1 = factor * knots_[value][i + 1];
  const double v0 = factor * knots_[first][i], v1 = factor * knots_[first][i + 1];
  const double a0 = factor * knots_[second][i], a1 = factor * knots_[second][i + 1];
  const double d = p1 - p0 - v0 * h - 0.5 * a0 * h * h, e = (v1 - v0 - a0 * h) * h, g = (a1 - a0) * h * h;
  const double h3 = h * h * h;
  return {{p0, v0, 0.5 * a0, (10 * d - 4 * e + 0.5 * g) / h3, (-15 * d + 7 * e - g) / (h3 * h),
           (6 * d - 3 * e + 0.5 * g) / (h3 * h * h)}};
}

void SeaMotion::load_interval(std::int64_t interval) {
  const auto knots = static_cast<std::int64_t>(kKnots);
  std::int64_t block = interval / knots;
  if (block * knots > interval) --block;
  if (!filled_ || block != block_) fill_block(block);
  filled_ = true;
  interval_ = interval;
  const auto i = static_cast<std::size_t>(interval - block * knots);
  up_ = join(i, kUp, kUp1, kUp2, 1);
  north_ = join(i, kNorth, kNorth1, kNorth2, 1);
  east_ = join(i, kEast, kEast1, kEast2, 1);
  // k = w^2 / g: the slope a k sin is the horizontal acceleration over -g.
  north_slope_ = join(i, kNorth2, kNorth3, kNorth4, -1 / kStandardGravity);
  east_slope_ = join(i, kEast2, kEast3, kEast4, -1 / kStandardGravity);
}

BodyMotion SeaMotion::at(std::int64_t utime) {
  const std::int64_t since_us = utime - settings_.start_utime;
  std::int64_t interval = since_us / knot_us_;
  if (interval * knot_us_ > since_us) --interval;
  if (!filled_ || interval != interval_) load_interval(interval);

  const double t = 1e-6 * static_cast<double>(since_us - interval * knot_us_);
  const auto value = [t](const Quintic& q) {
    return q.c[0] + t * (q.c[1] + t * (q.c[2] + t * (q.c[3] + t * (q.c[4] + t * q.c[5]))));
  };
  const auto first = [t](const Quintic& q) {
    return q.c[1] + t * (2 * q.c[2] + t * (3 * q.c[3] + t * (4 * q.c[4] + t * 5 * q.c[5])));
  };
  const auto second = [t](const Quintic& q) {
    return 2 * q.c[2] + t * (6 * q.c[3] + t * (12 * q.c[4] + t * 20 * q.c[5]));
  };
  BodyMotion motion;
  motion.utime = utime;
  motion.position_N = {value(north_), value(east_), -value(up_)};
  motion.velocity_N = {first(north_), first(east_), -first(up_)};
  motion.acceleration_N = {second(north_), second(east_), -second(up_)};

  const auto& s = settings_;
  Tilt tilt{.heading_rad = s.heading_rad};
  if (s.slope_following != 0) {  // surface higher in the east lifts the right side: roll is negative
    tilt.phi_N = s.slope_following * Vector3d(-value(east_slope_), value(north_slope_), 0);
    tilt.phi_rate_N = s.slope_following * Vector3d(-first(east_slope_), first(north_slope_), 0);
  }
  const double since_s = 1e-6 * static_cast<double>(since_us);
  if (s.tilt_rad != 0) {
    const double w = 2 * pi / s.tilt_period_s, sine = std::sin(w * since_s + tilt_phase_rad_),
                 cosine = std::cos(w * since_s + tilt_phase_rad_);
    tilt.phi_N += s.tilt_rad * Vector3d(sine, cosine, 0);
    tilt.phi_rate_N += s.tilt_rad * w * Vector3d(cosine, -sine, 0);
  }
  if (s.heading_wander_rad != 0) {
    const double w = 2 * pi / s.heading_wander_period_s;
    tilt.heading_rad += s.heading_wander_rad * std::sin(w * since_s + wander_phase_rad_);
    tilt.heading_rate_radps = s.heading_wander_rad * w * std::cos(w * since_s + wander_phase_rad_);
  }
  set_attitude(motion, tilt);
  return motion;
}

}  // namespace waverig::motion
