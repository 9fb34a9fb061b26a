#include "estimator/heave/spectral.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "estimator/heave/node_spectrum.h"
#include "estimator/heave/wave_counter.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kSpectrumInterval_s = 0.125;
constexpr int kLongestBlock = 2048;  // 256 s
constexpr int kShortestBlock = 64;   // 8 s
constexpr int kOverlap = 4;          // blocks begin every quarter of their length
constexpr int kPadding = 4;          // of a block, for the peak between its frequencies
constexpr double kFewWaves = 20;

// The nodes of one piece without a gap: second differences of the path, and smoothed heave and rate beside
// them.
struct Nodes {
  std::vector<double> second_difference_m, heave_m, rate_mps;
};

std::vector<Nodes> nodes_of(const Record& record, const SmoothedRecord& smoothed, double interval_s) {
  std::vector<Nodes> pieces;
  for (std::size_t p = 0; p < record.pieces().size(); ++p) {
    const std::size_t begin = record.pieces()[p];
    const std::size_t end = p + 1 < record.pieces().size() ? record.pieces()[p + 1] : record.samples().size();
    Nodes nodes;
    PathIntegrator integrator(interval_s);
    PathIncrement last;
    bool has_last = false;
    integrator.start(record.samples()[begin].utime, -smoothed.attitude[begin].a_N.z());
    for (std::size_t i = begin + 1; i < end; ++i)
      integrator.add(record.samples()[i].utime, -smoothed.attitude[i].a_N.z(),
                     [&](std::int64_t, const PathIncrement& whole) {
                       if (has_last) {
                         nodes.second_difference_m.push_back(second_difference_m(last, whole, interval_s));
                         nodes.heave_m.push_back(smoothed.heave[i].heave_m);
                         nodes.rate_mps.push_back(smoothed.heave[i].heave_rate_mps);
                       }
                       last = whole;
                       has_last = true;
                     });
    pieces.push_back(std::move(nodes));
  }
  return pieces;
}

// Density of the second differences by Welch's method, and mean squares of smoothed heave and rate over the
// whole record as multiples of those under the windows.
struct BlockAverage {
  Eigen::VectorXd density;
  Eigen::VectorXd fine_density;  // the same at kPadding times as many frequencies
  int blocks = 0;
  double heave_ratio = 1, rate_ratio = 1, mean_square_heave_m2 = 0;
};

BlockAverage average_blocks(const std::vector<Nodes>& pieces, int block, double interval_s) {
  BlockAverage average{Eigen::VectorXd::Zero(block / 2 + 1), Eigen::VectorXd::Zero(kPadding * block / 2 + 1)};
  Periodogram periodogram(block), fine_periodogram(kPadding * block);
  const auto length = static_cast<std::size_t>(block);
  double all = 0, all_z = 0, all_v = 0, windowed = 0, windowed_z = 0, windowed_v = 0;
  for (const Nodes& nodes : pieces) {
    const std::size_t n = nodes.heave_m.size();
    all += static_cast<double>(n);
    all_z += std::inner_product(nodes.heave_m.begin(), nodes.heave_m.end(), nodes.heave_m.begin(), 0.0);
    all_v += std::inner_product(nodes.rate_mps.begin(), nodes.rate_mps.end(), nodes.rate_mps.begin(), 0.0);
    if (n < length) continue;
    // Begins spread evenly, the first at the piece's begin and the last at its end.
    const std::size_t count = 1 + (n - length + length / kOverlap - 1) / (length / kOverlap);
    for (std::size_t b = 0; b < count; ++b) {
      const std::size_t first = count > 1 ? b * (n - length) / (count - 1) : 0;
      const auto values = std::span(nodes.second_difference_m).subspan(first, length);
      average.density += periodogram.of(values, interval_s);
      average.fine_density += fine_periodogram.of(values, interval_s);
      ++average.blocks;
      for (std::size_t i = 0; i < length; ++i) {
        const double weight = square(Periodogram::window(i, length));
        windowed += weight;
        windowed_z += weight * square(nodes.heave_m[first + i]);
        windowed_v += weight * square(nodes.rate_mps[first + i]);
      }
    }
  }
  if (average.blocks == 0) return average;
  average.density /= average.blocks;
  average.fine_density /= average.blocks;
  average.mean_square_heave_m2 = all_z / all;
  if (windowed_z > 0) average.heave_ratio = all_z / all / (windowed_z / windowed);
  if (windowed_v > 0) average.rate_ratio = all_v / all / (windowed_v / windowed);
  return average;
}

// A block has to fit the longest piece; several of them are better than a long one.
int block_length(const std::vector<Nodes>& pieces) {
  std::size_t longest = 0;
  for (const Nodes& nodes : pieces) longest = std::max(longest, nodes.heave_m.size());
  int block = kLongestBlock;
  while (block > kShortestBlock && static_cast<std::size_t>(3 * block) > longest) block /= 2;
  return block;
}

// The Hann window smears a density over a band of mean square width 1 / (3 L^2), L the block's length, and
// f^(n-4) is curved: on average (n-4)(n-5) / (6 L^2 f^2) of m_n is too much.
double smearing(int n, double f_hz, double block_s) {
  return (n - 4) * (n - 5) / (6 * square(block_s * f_hz));
}

// The centroid of Z^4 (Young 1995), from the sea's lowest frequency on.
double peak_period_s(const Eigen::VectorXd& fine_density, Eigen::Index first, double interval_s) {
  const double step = std::numbers::pi / static_cast<double>(fine_density.size() - 1);
  double peak = 0, peak_w = 0;
  for (Eigen::Index i = first; i < fine_density.size(); ++i) {
    const double w = step * static_cast<double>(i), z = fine_density[i] / square(2 - 2 * std::cos(w));
    peak += std::pow(z, 4);
    peak_w += std::pow(z, 4) * w;
  }
  return 2 * std::numbers::pi * interval_s * peak / peak_w;
}

void set_moments(const SeaAndNoise& split, double interval_s, int block, const BlockAverage& average,
                 SeaState& sea) {
  const double block_s = interval_s * block;
  double m[4] = {};  // m_-1, m_0, m_1, m_2
  for (Eigen::Index i = split.first_bin; i < split.heave_density_m2s.size(); ++i) {
    const double f = static_cast<double>(i) / block_s, z = 2 / block_s * split.heave_density_m2s[i];
    for (int n = -1; n <= 2; ++n)
      m[n + 1] += z * std::pow(f, n) * (1 - std::min(smearing(n, f, block_s), 1.0));
  }
  if (!(m[1] > 0)) return;
  // Heave's ratio goes with f^0 and its rate's with f^2; the others lie on the same power of frequency.
  const double per_f = std::sqrt(average.rate_ratio / average.heave_ratio);
  for (int n = 0; n < 4; ++n) m[n] *= average.heave_ratio * std::pow(per_f, n - 1);
  sea.hm0_m = 4 * std::sqrt(m[1]);
  sea.tm_10_s = m[0] / m[1];
  sea.tm01_s = m[1] / m[2];
  sea.tm02_s = std::sqrt(m[1] / m[3]);
  sea.tp_s = peak_period_s(average.fine_density, kPadding * split.first_bin, interval_s);
}

// Mean of the highest n-th part of the waves, the last of them with the fraction that is left.
double mean_of_highest(const std::vector<double>& descending, double n) {
  const double part = static_cast<double>(descending.size()) / n;
  double sum = 0, left = part;
  for (std::size_t i = 0; left > 0; ++i, left -= 1) sum += std::min(left, 1.0) * descending[i];
  return sum / part;
}

void set_heights(std::vector<double> heights, SeaState& sea) {
  if (heights.empty()) return;
  std::sort(heights.begin(), heights.end(), std::greater<>());
  sea.hmax_m = heights.front();
  sea.h110_m = mean_of_highest(heights, 10);
  sea.h13_m = mean_of_highest(heights, 3);
}

// Of Hm0 = 4 sqrt(mean z^2): an error e of heave with the stated sigma, uncorrelated with it over as many
// waves as there are; the systematic part goes with the heave itself.
double hm0_sigma(const SmoothedRecord& smoothed, const SensorKnowledge& sensor, const SeaState& sea) {
  double variance = 0;
  for (const HeaveSample& h : smoothed.heave) variance += square(h.heave_sigma_m);
  variance /= static_cast<double>(smoothed.heave.size());
  const double systematic = systematic_variance_m2(smoothed.sea, smoothed.motion, sensor);
  const double waves = std::max(1.0, sea.duration_s / sea.tm02_s);
  return 4 * std::sqrt(systematic + std::max(variance - systematic, 0.0) / waves);
}

}  // namespace

SeaState sea_state(const Record& record, const SmoothedRecord& smoothed, const SensorKnowledge& sensor) {
  SeaState sea;
  if (record.samples().empty()) {
    sea.flags = flag::kTooFewWaves;
    return sea;
  }
  const std::int64_t begin = record.samples().front().utime, end = record.samples().back().utime;
  sea.start_utime = begin;
  sea.duration_s = static_cast<double>(end - begin) * kMicrosecond;
  const double usual_s = sea.duration_s / static_cast<double>(record.samples().size());
  const double interval_s = std::max(kSpectrumInterval_s, usual_s);
  const std::vector<Nodes> pieces = nodes_of(record, smoothed, interval_s);
  const int block = block_length(pieces);
  const BlockAverage average = average_blocks(pieces, block, interval_s);
  sea.flags = flag::kTooFewWaves;
  if (average.blocks == 0) return sea;
  const double nominal =
      square(attitude_settings(sensor).accel_noise_mps2_rthz) / 2;  // one-sided to two-sided
  set_moments(split_sea_from_noise(average.density, interval_s, nominal, 2.5 / (interval_s * block)),
              interval_s, block, average, sea);
  if (sea.duration_s > kFewWaves * sea.tm02_s) sea.flags = 0;
  sea.hm0_sigma_m = hm0_sigma(smoothed, sensor, sea);
  return sea;
}

void Spectral::finish(Output& output) {
  const SmoothedRecord smoothed = smooth_record(record_, settings_.sensor);
  SeaState sea = sea_state(record_, smoothed, settings_.sensor);
  WaveCounter counter(settings_.sensor);
  std::vector<double> heights;
  for (std::size_t i = 0; i < smoothed.heave.size(); ++i) {
    output.heave(smoothed.heave[i]);
    if (const auto wave = counter.add(smoothed.heave[i], smoothed.attitude[i].tilt_sigma_rad)) {
      output.wave(*wave);
      heights.push_back(wave->height_m);
    }
  }
  set_heights(heights, sea);
  output.sea(sea);
}

}  // namespace waverig::estimator
