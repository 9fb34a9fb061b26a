#include "estimator/heave/spectral.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "estimator/heave/node_spectrum.h"
#include "lcmtypes/flags.h"

namespace waverig::estimator {
namespace {

constexpr double kSpectrumInterval_s = 0.125;
constexpr int kLongestBlock = 2048;      // 256 s
constexpr int kShortestBlock = 64;       // 8 s
constexpr int kOverlap = 4;              // blocks begin every quarter of their length
constexpr int kPadding = 4;              // of a block, for the peak between its frequencies
constexpr int kSeveral = 3;              // blocks are better than a long one
constexpr double kLowestResolved = 2.5;  // waves in a block
constexpr double kFewWaves = 20;

// Heave and its rate between two samples, as a cubic in time (Hermite).
PathIncrement between(const HeaveSample& from, const HeaveSample& to, std::int64_t utime) {
  const double dt = static_cast<double>(to.utime - from.utime) * kMicrosecond;
  const double x = static_cast<double>(utime - from.utime) * kMicrosecond / dt;
  const double p = to.heave_m - from.heave_m - dt * from.heave_rate_mps;
  const double v = to.heave_rate_mps - from.heave_rate_mps;
  return {
      .speed_mps = from.heave_rate_mps + x * (6 * (1 - x) * p / dt + (3 * x - 2) * v),
      .path_m = from.heave_m + x * dt * from.heave_rate_mps + x * x * ((3 - 2 * x) * p + (x - 1) * dt * v)};
}

// The nodes of one piece without a gap: second differences of the path, and smoothed heave and rate beside
// them.
struct Nodes {
  std::vector<double> second_difference_m, heave_m, rate_mps;
};

std::vector<Nodes> nodes_of(const Record& record, const SmoothedRecord& smoothed, double interval_s) {
  std::vector<Nodes> pieces;
  for (const auto [begin, end] : record.pieces()) {
    Nodes nodes;
    PathIntegrator integrator(interval_s);
    PathIncrement last;
    bool has_last = false;
    integrator.start(record.samples()[begin].utime, -smoothed.attitude[begin].a_N.z());
    for (std::size_t i = begin + 1; i < end; ++i)
      integrator.add(record.samples()[i].utime, -smoothed.attitude[i].a_N.z(),
                     [&](std::int64_t utime, const PathIncrement& whole) {
                       if (has_last) {
                         const PathIncrement node = between(smoothed.heave[i - 1], smoothed.heave[i], utime);
                         nodes.second_difference_m.push_back(second_difference_m(last, whole, interval_s));
                         nodes.heave_m.push_back(node.path_m);
                         nodes.rate_mps.push_back(node.speed_mps);
                       }
                       last = whole;
                       has_last = true;
                     });
    pieces.push_back(std::move(nodes));
  }
  return pieces;
}

// Duration of the pieces without a gap.
double seen_s(const Record& record) {
  double seen_s = 0;
  for (const auto [begin, end] : record.pieces())
    seen_s +=
        static_cast<double>(record.samples()[end - 1].utime - record.samples()[begin].utime) * kMicrosecond;
  return seen_s;
}

// Density of one of the nodes' series by Welch's method, and mean squares of smoothed heave and rate over the
// whole record as multiples of those under the windows.
struct BlockAverage {
  Eigen::VectorXd density;
  Eigen::VectorXd fine_density;  // the same at kPadding times as many frequencies
  int blocks = 0;
  double heave_ratio = 1, rate_ratio = 1;
};

BlockAverage average_blocks(const std::vector<Nodes>& pieces, std::vector<double> Nodes::*series, int block,
                            double interval_s) {
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
      const auto values = std::span(nodes.*series).subspan(first, length);
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
  if (windowed_z > 0) average.heave_ratio = all_z / all / (windowed_z / windowed);
  if (windowed_v > 0) average.rate_ratio = all_v / all / (windowed_v / windowed);
  return average;
}

// A block has to fit the longest piece `times` over.
int block_length(const std::vector<Nodes>& pieces, int times) {
  std::size_t longest = 0;
  for (const Nodes& nodes : pieces) longest = std::max(longest, nodes.heave_m.size());
  int block = kLongestBlock;
  while (block > kShortestBlock && static_cast<std::size_t>(times * block) > longest) block /= 2;
  return block;
}

// Density of heave, and what the blocks have seen of it.
struct SeaSpectrum {
  Eigen::VectorXd density_m2s, fine_density_m2s;
  Eigen::Index first_bin = 1;
  int power = 0;  // of frequency by which the blocks' density was divided
  double block_s = 0, heave_ratio = 1, rate_ratio = 1;
};

// Of the levelled acceleration; of the smoothed heave where the sea's longest waves are too long for blocks
// that the record holds several of: nothing there is divided by w^4, so that no window's skirt grows. Nothing
// where no sea is found, or the record is shorter than a block.
std::optional<SeaSpectrum> sea_spectrum(const std::vector<Nodes>& pieces, double interval_s,
                                        double nominal_noise_m2ps3) {
  const auto split = [&](const BlockAverage& average, int block) {
    return split_sea_from_noise(average.density, interval_s, nominal_noise_m2ps3,
                                kLowestResolved / (interval_s * block));
  };
  int block = block_length(pieces, kSeveral);
  BlockAverage average = average_blocks(pieces, &Nodes::second_difference_m, block, interval_s);
  if (average.blocks == 0) return std::nullopt;
  SeaSpectrum sea;
  const SeaAndNoise seen = split(average, block);
  if (seen.found && !seen.cut_off) {
    sea.density_m2s = seen.heave_density_m2s;
    sea.first_bin = seen.first_bin;
    sea.power = 4;
    sea.fine_density_m2s = average.fine_density;
    const double step = std::numbers::pi / static_cast<double>(sea.fine_density_m2s.size() - 1);
    for (Eigen::Index i = 1; i < sea.fine_density_m2s.size(); ++i)
      sea.fine_density_m2s[i] /= square(2 - 2 * std::cos(step * static_cast<double>(i)));
  } else {
    block = block_length(pieces, 1);
    if (!seen.found &&
        !split(average_blocks(pieces, &Nodes::second_difference_m, block, interval_s), block).found)
      return std::nullopt;
    average = average_blocks(pieces, &Nodes::heave_m, block, interval_s);
    sea.density_m2s = average.density;
    sea.fine_density_m2s = average.fine_density;
  }
  sea.block_s = interval_s * block;
  sea.heave_ratio = average.heave_ratio;
  sea.rate_ratio = average.rate_ratio;
  return sea;
}

// The Hann window smears a density over a band of mean square width 1 / (3 L^2), L the block's length, and
// f^(n-p), p the power that the density was divided by, is curved: on average (n-p)(n-p-1) / (6 L^2 f^2) of
// m_n is too much.
double smearing(int n, double cycles_a_block) { return n * (n - 1) / (6 * square(cycles_a_block)); }

// The centroid of Z^4 (Young 1995), from the sea's lowest frequency on.
double peak_period_s(const SeaSpectrum& sea) {
  double peak = 0, peak_f = 0;
  for (Eigen::Index i = kPadding * sea.first_bin; i < sea.fine_density_m2s.size(); ++i) {
    const double z4 = std::pow(sea.fine_density_m2s[i], 4);
    peak += z4;
    peak_f += z4 * static_cast<double>(i) / (kPadding * sea.block_s);
  }
  return peak / peak_f;
}

void set_moments(const SeaSpectrum& spectrum, SeaState& sea) {
  double m[4] = {};  // m_-1, m_0, m_1, m_2
  for (Eigen::Index i = spectrum.first_bin; i < spectrum.density_m2s.size(); ++i) {
    const auto cycles = static_cast<double>(i);
    const double z = 2 / spectrum.block_s * spectrum.density_m2s[i];
    for (int n = -1; n <= 2; ++n)
      m[n + 1] += z * std::pow(cycles / spectrum.block_s, n) *
                  (1 - std::min(smearing(n - spectrum.power, cycles), 1.0));
  }
  if (!(m[1] > 0)) return;
  // Heave's ratio goes with f^0 and its rate's with f^2; the others lie on the same power of frequency.
  const double per_f = std::sqrt(spectrum.rate_ratio / spectrum.heave_ratio);
  for (int n = 0; n < 4; ++n) m[n] *= spectrum.heave_ratio * std::pow(per_f, n - 1);
  sea.hm0_m = 4 * std::sqrt(m[1]);
  sea.tm_10_s = m[0] / m[1];
  sea.tm01_s = m[1] / m[2];
  sea.tm02_s = std::sqrt(m[1] / m[3]);
  sea.tp_s = peak_period_s(spectrum);
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
// waves as there are; the systematic part goes with the heave itself, in all records of the sensor.
void set_hm0_sigma(const SmoothedRecord& smoothed, const SensorKnowledge& sensor, SeaState& sea) {
  double variance = 0;
  for (const HeaveSample& h : smoothed.heave) variance += square(h.heave_sigma_m);
  variance /= static_cast<double>(smoothed.heave.size());
  const double systematic = systematic_variance_m2(smoothed.sea, smoothed.motion, sensor);
  const double waves = std::max(1.0, sea.duration_s / sea.tm02_s);
  sea.hm0_sigma_m = 4 * std::sqrt(systematic + std::max(variance - systematic, 0.0) / waves);
  sea.hm0_systematic_sigma_m = 4 * std::sqrt(systematic);
}

}  // namespace

SeaState sea_state(const Record& record, const SmoothedRecord& smoothed, const SensorKnowledge& sensor) {
  SeaState sea;
  if (record.samples().empty()) {
    sea.flags = flag::kTooFewWaves;
    return sea;
  }
  sea.start_utime = record.samples().front().utime;
  sea.duration_s = seen_s(record);
  const double usual_s = sea.duration_s / static_cast<double>(record.samples().size());
  const double interval_s = std::max(kSpectrumInterval_s, usual_s);
  const std::vector<Nodes> pieces = nodes_of(record, smoothed, interval_s);
  sea.flags = flag::kTooFewWaves;
  const auto spectrum = sea_spectrum(pieces, interval_s, accel_noise_m2ps3(sensor));
  if (!spectrum) return sea;
  set_moments(*spectrum, sea);
  if (sea.duration_s > kFewWaves * sea.tm02_s) sea.flags = 0;
  set_hm0_sigma(smoothed, sensor, sea);
  return sea;
}

void Spectral::finish(Output& output) {
  const SmoothedRecord smoothed = smooth_record(record_, settings_.sensor);
  SeaState sea = sea_state(record_, smoothed, settings_.sensor);
  std::vector<double> heights;
  for (const Wave& wave : tell(record_, smoothed, settings_.sensor, output)) heights.push_back(wave.height_m);
  set_heights(heights, sea);
  output.sea(sea);
}

}  // namespace waverig::estimator
