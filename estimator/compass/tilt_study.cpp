#include "estimator/compass/tilt_study.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <thread>

#include "estimator/compass/tilt_simulation.h"
#include "lcmtypes/error.h"

namespace waverig::estimator {
namespace {

constexpr int kPublishedRuns = 100;
constexpr double kNormal95 = 1.959964;

// Sums of the first four powers of each quantity at each point, over runs.
struct Moments {
  double runs = 0;
  std::array<std::array<Column, 4>, kQuantities> sums;
  std::array<double, kQuantities> largest{};

  explicit Moments(std::size_t points) {
    for (auto& powers : sums)
      for (Column& sum : powers) sum.assign(points, 0);
  }
  void add(const TiltRun& run) {
    runs += 1;
    for (std::size_t q = 0; q < kQuantities; ++q) {
      auto& [s1, s2, s3, s4] = sums[q];
      const Column& error = run.error[q];
      double greatest = largest[q];
      for (std::size_t i = 0; i < error.size(); ++i) {
        const double e = error[i], e2 = e * e;
        s1[i] += e;
        s2[i] += e2;
        s3[i] += e2 * e;
        s4[i] += e2 * e2;
        greatest = std::max(greatest, std::abs(e));
      }
      largest[q] = greatest;
    }
  }
  void add(const Moments& other) {
    runs += other.runs;
    for (std::size_t q = 0; q < kQuantities; ++q) {
      for (std::size_t p = 0; p < 4; ++p)
        for (std::size_t i = 0; i < sums[q][p].size(); ++i) sums[q][p][i] += other.sums[q][p][i];
      largest[q] = std::max(largest[q], other.largest[q]);
    }
  }
  Curve curve(Quantity quantity) const {
    const auto& [s1, s2, s3, s4] = sums[static_cast<std::size_t>(quantity)];
    Curve curve;
    for (std::size_t i = 0; i < s1.size(); ++i) {
      const double mean = s1[i] / runs, raw2 = s2[i] / runs, raw3 = s3[i] / runs, raw4 = s4[i] / runs;
      const double m2 = std::max(0.0, raw2 - mean * mean);
      const double m4 = raw4 - 4 * mean * raw3 + 6 * mean * mean * raw2 - 3 * mean * mean * mean * mean;
      const double variance = m2 * runs / (runs - 1);
      curve.mean.push_back(mean);
      curve.std.push_back(std::sqrt(variance));
      curve.mean_sigma.push_back(std::sqrt(variance / runs));
      // Var(s^2) = (m4 - s^4) / n for any distribution, so sigma(s) is that root over 2 s.
      curve.std_sigma.push_back(m2 > 0 ? std::sqrt(std::max(0.0, m4 - m2 * m2) / runs) / (2 * std::sqrt(m2))
                                       : 0);
    }
    return curve;
  }
};

// The document's figures of one experiment.
struct Peak {
  double value = 0, sigma = 0;
};
Peak largest_std(const Curve& curve) {
  const auto i =
      static_cast<std::size_t>(std::max_element(curve.std.begin(), curve.std.end()) - curve.std.begin());
  return {curve.std[i], curve.std_sigma[i]};
}
Peak largest_mean(const Curve& curve) {
  Peak peak;
  for (std::size_t i = 0; i < curve.mean.size(); ++i)
    if (std::abs(curve.mean[i]) > peak.value) peak = {std::abs(curve.mean[i]), curve.mean_sigma[i]};
  return peak;
}

struct Batch {
  Moments moments;
  std::vector<TiltRunFigures> runs;
};

// A piece of the work: runs [begin, end); whole experiments of the document's size tell of repeats, and those
// below the number of runs asked for count for the value.
struct Task {
  std::int64_t begin, end;
  bool counts, repeats;
};

std::vector<Task> tasks_of(std::int64_t runs, int least_repeats) {
  std::vector<Task> tasks;
  std::int64_t at = 0;
  int repeats = 0;
  for (; at + kPublishedRuns <= runs; at += kPublishedRuns, ++repeats)
    tasks.push_back({at, at + kPublishedRuns, true, true});
  if (at < runs) tasks.push_back({at, runs, true, false});
  for (at = runs; repeats < least_repeats; at += kPublishedRuns, ++repeats)
    tasks.push_back({at, at + kPublishedRuns, false, true});
  return tasks;
}

// Works through the tasks on all threads and hands each batch over in the order of the tasks, so that sums
// round the same way however many threads there are.
template <typename Consume>
void in_order(const TiltSimulation& simulation, const std::vector<Task>& tasks, int threads,
              Consume consume) {
  std::atomic<std::size_t> next_task = 0;
  std::mutex mutex;
  std::map<std::size_t, Batch> waiting;
  std::size_t next_result = 0;
  const auto work = [&] {
    TiltRun run;
    for (std::size_t t; (t = next_task++) < tasks.size();) {
      Batch batch{Moments(simulation.sweep().points()), {}};
      for (std::int64_t index = tasks[t].begin; index < tasks[t].end; ++index) {
        simulation.run(index, run);
        batch.moments.add(run);
        batch.runs.push_back(run.figures);
      }
      const std::lock_guard lock(mutex);
      waiting.emplace(t, std::move(batch));
      for (auto ready = waiting.find(next_result); ready != waiting.end();
           ready = waiting.find(++next_result)) {
        consume(tasks[next_result], ready->second);
        waiting.erase(ready);
      }
    }
  };
  std::vector<std::jthread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(work);
  work();
}

double quantile(Column values, double p) {
  std::sort(values.begin(), values.end());
  const double at = p * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  const double next = values[std::min(i + 1, values.size() - 1)];
  return values[i] + (at - static_cast<double>(i)) * (next - values[i]);
}

Interval central95(const Column& values) { return {quantile(values, 0.025), quantile(values, 0.975)}; }
Interval around(double value, double sigma) { return {value - kNormal95 * sigma, value + kNormal95 * sigma}; }

// Collects one figure over experiments, then states it. A figure of a single run or experiment (how:
// kTypical) is stated by its mean over them; a figure that needs many runs comes from all of them.
class FigureBook {
 public:
  void repeat(const std::string& name, double value) { repeats_[name].push_back(value); }
  StudyFigure typical(const std::string& name, const std::string& unit, double published,
                      double scale) const {
    const Column& values = repeats_.at(name);
    const MeanStd m = mean_std(values);
    return state(name, unit, published, scale, m.mean, m.std / std::sqrt(static_cast<double>(values.size())));
  }
  StudyFigure of_all(const std::string& name, const std::string& unit, double published, double scale,
                     const Peak& peak) const {
    return state(name, unit, published, scale, peak.value, peak.sigma);
  }

 private:
  StudyFigure state(const std::string& name, const std::string& unit, double published, double scale,
                    double value, double sigma) const {
    const Interval repeats = central95(repeats_.at(name)), confidence = around(value, sigma);
    return {name,          unit,
            published,     {scale * repeats.low, scale * repeats.high},
            scale * value, {scale * confidence.low, scale * confidence.high}};
  }
  std::map<std::string, Column> repeats_;
};

// The document's figures, in its order. Angles in degrees.
struct CurveFigure {
  const char* name;
  Quantity quantity;
  enum class Kind { kLargestStd, kLargestMean, kLargestError } kind;
  double published;
};
using Kind = CurveFigure::Kind;
constexpr CurveFigure kCurveFigures[] = {
    {"roll error, largest std", Quantity::kRoll, Kind::kLargestStd, 9.3696},
    {"roll, linear formula's miss, largest mean", Quantity::kRollMiss, Kind::kLargestMean, 0.0651},
    {"roll, linear formula's miss, largest std", Quantity::kRollMiss, Kind::kLargestStd, 1.5147},
    {"pitch error, largest std", Quantity::kPitch, Kind::kLargestStd, 6.1836},
    {"pitch, linear formula's miss, largest mean", Quantity::kPitchMiss, Kind::kLargestMean, 0.3589},
    {"pitch, linear formula's miss, largest std", Quantity::kPitchMiss, Kind::kLargestStd, 0.8115},
    {"heading I, linear formula's miss, largest mean", Quantity::kHeading1Miss, Kind::kLargestMean, 0.3351},
    {"heading I, linear formula's miss, largest std", Quantity::kHeading1Miss, Kind::kLargestStd, 1.5948},
    {"heading I, largest error", Quantity::kHeading1, Kind::kLargestError, 30.8672},
    {"heading II, linear formula's miss, largest mean", Quantity::kHeading2Miss, Kind::kLargestMean, 0.3797},
    {"heading II, linear formula's miss, largest std", Quantity::kHeading2Miss, Kind::kLargestStd, 1.3485},
    {"heading II, largest error", Quantity::kHeading2, Kind::kLargestError, 31.4528},
};
constexpr double kPublishedDipMean_deg = 49.9966, kPublishedDipStd_deg = 0.0572;
constexpr double kPublishedZMean = 0.0022, kPublishedZStd = 0.0726;
constexpr const char* kDipMean = "dip of a level turn, mean";
constexpr const char* kDipStd = "dip of a level turn, std";
constexpr const char* kUnitDipStd = "dip of a level turn, field normalised first, std";
constexpr const char* kZMean = "z of two axes in one run, mean error";
constexpr const char* kZStd = "z of two axes in one run, std";

Peak peak_of(const CurveFigure& figure, const Moments& moments) {
  if (figure.kind == Kind::kLargestError)
    return {moments.largest[static_cast<std::size_t>(figure.quantity)], 0};
  const Curve curve = moments.curve(figure.quantity);
  return figure.kind == Kind::kLargestStd ? largest_std(curve) : largest_mean(curve);
}

ExampleRun example_of(const TiltSimulation& simulation, const TiltStudySettings& s) {
  TiltRun run;
  simulation.run(0, run);
  ExampleRun example;
  const TiltSweep& sweep = simulation.sweep();
  for (std::size_t a = 0; a < 4; ++a) {
    example.error[a] = run.error[a];
    example.predicted[a] = run.predicted[a];
    for (std::size_t i = 0; i < sweep.points(); ++i)
      example.computed[a].push_back((a < 2 ? sweep.tilt[i] : s.heading_rad[a - 2]) + run.error[a][i]);
  }
  example.z_true = sweep.cases[0].z;
  for (std::size_t i = 0; i < sweep.points(); ++i)
    example.z_estimated.push_back(sweep.cases[0].z[i] + run.z_error[i]);
  for (int i = 0; i < s.turn_points; ++i)
    example.turn_heading.push_back(2 * std::numbers::pi * i / (s.turn_points - 1));
  example.turn_dip = run.turn_dip;
  return example;
}

void check(const TiltStudySettings& s) {
  if (s.runs < 2) throw UserError("runs = " + std::to_string(s.runs) + ": expected at least 2");
  if (s.least_repeats < 2)
    throw UserError("repeats = " + std::to_string(s.least_repeats) + ": expected at least 2");
  if (s.sweep_points < 2 || s.turn_points < 2) throw UserError("sweep and turn need at least 2 points");
  if (!(s.accel_error_sigma_mps2 >= 0 && s.accel_noise_mps2 >= 0 && s.field_noise >= 0))
    throw UserError(
        "accelerometer error, accelerometer noise and field noise: expected standard deviations >= 0");
  if (!(std::abs(s.sweep_rad) < 90 * kDegree)) throw UserError("sweep: expected less than 90 deg");
}

}  // namespace

TiltStudy run_tilt_study(const TiltStudySettings& settings) {
  check(settings);
  const TiltSimulation simulation(settings);
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  const int threads = settings.threads > 0 ? settings.threads : cores;

  Moments all(simulation.sweep().points());
  FigureBook book;
  in_order(simulation, tasks_of(settings.runs, settings.least_repeats), threads,
           [&](const Task& task, const Batch& batch) {
             if (task.counts) all.add(batch.moments);
             if (!task.repeats) return;
             for (const CurveFigure& figure : kCurveFigures)
               book.repeat(figure.name, peak_of(figure, batch.moments).value);
             for (const TiltRunFigures& run : batch.runs) {
               book.repeat(kDipMean, run.dip.mean);
               book.repeat(kDipStd, run.dip.std);
               book.repeat(kUnitDipStd, run.unit_dip.std);
               book.repeat(kZMean, run.z.mean);
               book.repeat(kZStd, run.z.std);
             }
           });

  TiltStudy study;
  study.settings = settings;
  study.tilt_rad = simulation.sweep().tilt;
  study.example = example_of(simulation, settings);
  for (int q = 0; q < kQuantities; ++q)
    study.curves[static_cast<std::size_t>(q)] = all.curve(static_cast<Quantity>(q));
  constexpr double kPerDegree = 1 / kDegree;
  for (const CurveFigure& figure : kCurveFigures)
    study.figures.push_back(
        figure.kind == Kind::kLargestError
            ? book.typical(figure.name, "deg", figure.published, kPerDegree)
            : book.of_all(figure.name, "deg", figure.published, kPerDegree, peak_of(figure, all)));
  study.figures.push_back(book.typical(kDipMean, "deg", kPublishedDipMean_deg, kPerDegree));
  study.figures.push_back(book.typical(kDipStd, "deg", kPublishedDipStd_deg, kPerDegree));
  study.figures.push_back(book.typical(kUnitDipStd, "deg", kPublishedDipStd_deg, kPerDegree));
  study.figures.push_back(book.typical(kZMean, "1", kPublishedZMean, 1));
  study.figures.push_back(book.typical(kZStd, "1", kPublishedZStd, 1));
  return study;
}

}  // namespace waverig::estimator
