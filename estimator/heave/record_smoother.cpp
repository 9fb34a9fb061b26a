#include "estimator/heave/record_smoother.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "estimator/heave/heave_smoother.h"
#include "estimator/heave/path_integrator.h"
#include "estimator/heave/sea_identifier.h"
#include "estimator/heave/wave_counter.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr int kOrder = 48;    // of the autoregression: 24 s
constexpr int kBlock = 1024;  // fine nodes of a periodogram: 256 s
constexpr double kAbout = 2;  // standard deviations

// One piece without a gap, seen from the nodes.
struct Piece {
  std::size_t begin = 0, end = 0;  // samples
  std::vector<LevelIncrement> increments;
  std::vector<double> disturbance_m2ps3;  // mean in each interval
  std::vector<PathIncrement> partial;     // one a sample, from the node before it
  std::vector<double> since_node_s;
  std::vector<std::size_t> node;  // that node's number
};

// When an offset changed is not known to the instant.
bool about(const OffsetChange& change, std::int64_t utime) {
  return std::abs(static_cast<double>(utime - change.utime)) * kMicrosecond < kAbout * change.sigma_s;
}

// Takes them off the vertical acceleration.
void correct(const std::vector<OffsetChange>& changes, std::span<AttitudeSample> attitude) {
  for (const OffsetChange& change : changes)
    for (AttitudeSample& a : attitude)
      if (a.utime >= change.utime) a.a_N.z() += change.mps2;
}

Piece integrate(const Record& record, const SmoothedRecord& smoothed, std::size_t begin, std::size_t end,
                double interval_s, double gravity_mps2) {
  Piece piece{begin, end, {}, {}, {}, {}, {}};
  Integrator<Eigen::Array3d> integrator(interval_s);
  MeanDisturbance disturbance;
  for (std::size_t i = begin; i < end; ++i) {
    const ImuSample& sample = record.samples()[i];
    const AttitudeSample& attitude = smoothed.attitude[i];
    Eigen::Array3d a_up;
    a_up << -attitude.a_N.z(), gyro_scale_leaks_mps2(attitude, smoothed.motion, sample.f_B);
    double density_m2ps3 = disturbance_m2ps3(attitude, sample.flags, gravity_mps2);
    for (const OffsetChange& change : smoothed.offset_changes)
      if (about(change, sample.utime)) density_m2ps3 += square(change.mps2) * change.sigma_s;
    disturbance.add(density_m2ps3);
    if (i > begin && (sample.flags & flag::kGap))
      disturbance.add_gap(
          unseen_speed_mps(static_cast<double>(sample.utime - record.samples()[i - 1].utime) * kMicrosecond),
          interval_s);
    if (i == begin) {
      integrator.start(sample.utime, a_up);
    } else {
      integrator.add(sample.utime, a_up, [&](std::int64_t, const LevelIncrement& whole) {
        piece.increments.push_back(whole);
        piece.disturbance_m2ps3.push_back(disturbance.mean());
        disturbance = {};
      });
    }
    piece.partial.push_back(up(integrator.partial()));
    piece.since_node_s.push_back(integrator.since_node_s());
    piece.node.push_back(piece.increments.size());
  }
  return piece;
}

SeaModel identify(std::span<const Piece> pieces, const SensorKnowledge& sensor) {
  SeaIdentifierSettings settings;
  settings.order = kOrder;
  settings.interval_s = 0;  // as suits the sea
  settings.block = kBlock;
  settings.memory_s = 0;
  settings.accel_noise_m2ps3 = accel_noise_m2ps3(sensor);
  settings.offset_sigma_mps2 = offset_sigma_mps2(sensor);
  SeaIdentifier identifier(settings);
  for (const Piece& piece : pieces) {
    identifier.gap();
    for (const LevelIncrement& increment : piece.increments) identifier.add(up(increment));
  }
  return identifier.identify();
}

// Heave between the nodes: the double integral from the node on, plus what brings it to the next node's
// estimate, as a cubic in time (Hermite), so that heave and its rate agree with both.
void interpolate(const Piece& piece, std::span<const SmoothedNode> nodes, double dt,
                 std::span<HeaveSample> out) {
  for (std::size_t i = 0; i < piece.partial.size(); ++i) {
    const std::size_t k = piece.node[i];
    const double t = piece.since_node_s[i], x = t / dt;
    double heave = nodes[k].heave_m + t * nodes[k].heave_rate_mps + piece.partial[i].path_m;
    double rate = nodes[k].heave_rate_mps + piece.partial[i].speed_mps;
    double variance = nodes[k].variance_m2;
    if (k + 1 < nodes.size()) {
      const PathIncrement whole = up(piece.increments[k]);
      const double p = nodes[k + 1].heave_m - nodes[k].heave_m - dt * nodes[k].heave_rate_mps - whole.path_m;
      const double v = nodes[k + 1].heave_rate_mps - nodes[k].heave_rate_mps - whole.speed_mps;
      heave += x * x * ((3 - 2 * x) * p + (x - 1) * dt * v);
      rate += x * (6 * (1 - x) * p / dt + (3 * x - 2) * v);
      variance += x * (nodes[k + 1].variance_m2 - nodes[k].variance_m2);
    } else {
      heave -= nodes[k].bias_mps2 * t * t / 2;
      rate -= nodes[k].bias_mps2 * t;
    }
    out[i].heave_m = heave;
    out[i].heave_rate_mps = rate;
    out[i].heave_sigma_m = std::sqrt(variance);
  }
}

}  // namespace

void Record::add(const ImuSample& sample) {
  const GuardVerdict verdict = guard_.check(sample);
  if (!verdict.usable) {
    pending_flags_ |= verdict.flags & ~flag::kGap;
    return;
  }
  if (verdict.anew || pieces_.empty()) pieces_.push_back({samples_.size(), samples_.size()});
  samples_.push_back(sample);
  ++pieces_.back().end;
  samples_.back().flags = verdict.flags | pending_flags_;
  pending_flags_ = 0;
}

SmoothedRecord smooth_record(const Record& record, const SensorKnowledge& sensor) {
  const std::vector<ImuSample>& samples = record.samples();
  const AttitudeSettings settings = attitude_settings(sensor);
  SmoothedRecord smoothed;
  smoothed.attitude = smooth_attitude(samples, settings);
  for (std::size_t i = 0; i < samples.size(); ++i)
    smoothed.motion.follow(smoothed.attitude[i], 1.0 / static_cast<double>(i + 1));
  const auto pieces_with = [&](double interval_s) {
    std::vector<Piece> pieces;
    for (const auto [begin, end] : record.pieces())
      pieces.push_back(integrate(record, smoothed, begin, end, interval_s, sensor.gravity_mps2));
    return pieces;
  };
  std::vector<Piece> pieces = pieces_with(kFineInterval_s);
  for (const Piece& piece : pieces) {
    const auto changes = find_offset_changes(piece.increments, samples[piece.begin].utime, kFineInterval_s);
    correct(changes, std::span(smoothed.attitude).subspan(piece.begin, piece.end - piece.begin));
    smoothed.offset_changes.insert(smoothed.offset_changes.end(), changes.begin(), changes.end());
  }
  if (!smoothed.offset_changes.empty()) pieces = pieces_with(kFineInterval_s);
  smoothed.sea = identify(pieces, sensor);
  const double interval_s = smoothed.sea.interval_s;
  if (interval_s != kFineInterval_s) pieces = pieces_with(interval_s);
  const SensorDrift drift{accel_noise_m2ps3(sensor), sensor.gyro_scale_sigma};
  smoothed.heave.resize(samples.size());
  for (const Piece& piece : pieces)
    interpolate(piece, smooth_heave(piece.increments, smoothed.sea, drift, piece.disturbance_m2ps3),
                interval_s, std::span(smoothed.heave).subspan(piece.begin, piece.end - piece.begin));
  const double systematic = systematic_variance_m2(smoothed.sea, smoothed.motion, sensor);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    HeaveSample& h = smoothed.heave[i];
    h.utime = samples[i].utime;
    h.seq = samples[i].seq;
    h.flags = samples[i].flags;
    for (const OffsetChange& change : smoothed.offset_changes)
      if (about(change, h.utime)) h.flags |= flag::kSpike;
    h.q_NB = smoothed.attitude[i].q_NB;
    h.heave_sigma_m = std::sqrt(square(h.heave_sigma_m) + systematic);
  }
  return smoothed;
}

std::vector<Wave> tell(const Record& record, const SmoothedRecord& smoothed, const SensorKnowledge& sensor,
                       Output& output) {
  for (const OffsetChange& change : smoothed.offset_changes) output.offset_change(change);
  std::vector<Wave> waves;
  WaveCounter counter(sensor);
  const double systematic_m = std::sqrt(systematic_variance_m2(smoothed.sea, smoothed.motion, sensor));
  for (const auto [begin, end] : record.pieces()) {
    counter.gap();
    for (std::size_t i = begin; i < end; ++i) {
      const HeaveSample& heave = smoothed.heave[i];
      output.heave(heave);
      if (const auto wave = counter.add(heave, systematic_m, smoothed.attitude[i].tilt_sigma_rad)) {
        output.wave(*wave);
        waves.push_back(*wave);
      }
    }
  }
  return waves;
}

}  // namespace waverig::estimator
