#include "render/campaign_figures.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <tuple>

#include "render/figures/accuracy.h"
#include "render/figures/calibration.h"
#include "render/figures/direction.h"
#include "render/figures/methods.h"
#include "render/figures/noise.h"
#include "render/figures/run_time.h"
#include "render/figures/sea.h"
#include "render/figures/settings.h"
#include "render/scene/film.h"

namespace waverig::render {
namespace {

// work(canvas, i) for i = 0 … n - 1, each on one of the threads with a canvas
// of its own.
template <class Work>
void on_threads(int threads, std::size_t n, Work work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto worker = [&] {
    try {
      Canvas canvas;
      for (std::size_t i = next++; i < n; i = next++) work(canvas, i);
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = std::current_exception();
      next = n;
    }
  };
  std::vector<std::jthread> pool;
  for (std::size_t t = 1; t < std::min(static_cast<std::size_t>(std::max(1, threads)), n); ++t)
    pool.emplace_back(worker);
  worker();
  pool.clear();
  if (failure) std::rethrow_exception(failure);
}

// One file to be drawn; what it draws must outlive it.
struct Task {
  std::filesystem::path path;
  std::function<void(Canvas&, const std::filesystem::path&)> draw;
};

std::vector<Task> tasks_of(const std::vector<NamedFigure>& figures, const std::filesystem::path& out,
                           const FigureOptions& options) {
  std::vector<Task> tasks;
  for (const NamedFigure& named : figures) {
    tasks.push_back(
        {out / (named.stem + ".png"), [&named, &options](Canvas& canvas, const std::filesystem::path& path) {
           Figure figure = named.figure;
           figure.theme = options.theme;
           save_png(figure, canvas, path, options.provenance);
           if (!options.svg) return;
           std::filesystem::path vectors = path;
           save_svg(figure, canvas.fonts(), vectors.replace_extension("svg"), options.provenance);
         }});
  }
  return tasks;
}

std::vector<std::filesystem::path> drawn(const std::vector<Task>& tasks, const std::filesystem::path& out,
                                         int threads) {
  std::filesystem::create_directories(out);
  on_threads(threads, tasks.size(),
             [&](Canvas& canvas, std::size_t i) { tasks[i].draw(canvas, tasks[i].path); });
  std::vector<std::filesystem::path> paths;
  for (const Task& task : tasks) paths.push_back(task.path);
  return paths;
}

}  // namespace

const evaluation::RunResult* paper_run(const evaluation::CampaignResults& results) {
  const evaluation::RunResult* best = nullptr;
  for (const evaluation::RunResult& run : results.runs) {
    const auto rank = [](const evaluation::RunResult& r) {
      return std::tuple(r.period_s, r.height_m, -r.repeat);
    };
    if (best == nullptr || rank(run) > rank(*best)) best = &run;
  }
  return best;
}

std::vector<NamedFigure> result_figures(const evaluation::CampaignResults& results) {
  std::vector<NamedFigure> figures;
  const auto add = [&figures](const char* stem, Figure figure) {
    if (!figure.panels.empty()) figures.push_back({stem, std::move(figure)});
  };
  if (are_seas(results)) {
    add("sea-states", sea_states_figure(results));
    add("sea-heave-map", sea_heave_map_figure(results));
  } else {
    add(shows_published(results) ? "paper-table-2" : "mean-heights", table2_figure(results));
    add("error-map", error_map_figure(results));
    add("std-map", std_map_figure(results));
  }
  add("frequency-response", frequency_response_figure(results));
  add("single-waves", single_waves_figure(results));
  add("uncertainty-budget", uncertainty_budget_figure(results));
  if (auto figure = calibration_figure(results.calibration_json))
    figures.push_back({"calibration", std::move(*figure)});
  if (auto figure = direction_figure(results)) figures.push_back({"directions", std::move(*figure)});
  return figures;
}

std::vector<NamedFigure> run_figures(const evaluation::CampaignResults& results,
                                     const evaluation::RunRecord& run, const FigureOptions& options,
                                     RestRecords rest_of_repeats) {
  std::vector<NamedFigure> figures;
  const std::vector<std::string> methods = all_methods_of(results);
  const PaperTraces calibrated = recorded_traces(run, kBaselineMethod);
  const PaperTraces raw = options.uncalibrated ? options.uncalibrated(run) : PaperTraces{};
  const PaperTraces& shown = raw.empty() ? calibrated : raw;
  if (!shown.heave.empty()) {
    figures.push_back({"paper-4-inertial-data", inertial_data_figure(run, shown, raw.empty())});
    figures.push_back({"paper-5-uncorrected-trace", uncorrected_trace_figure(run, shown, raw.empty())});
  }
  if (!raw.empty())
    figures.push_back({"paper-6-without-calibration", corrected_trace_figure(run, raw, false)});
  if (!calibrated.heave.empty())
    figures.push_back({"paper-7-with-calibration", corrected_trace_figure(run, calibrated, true)});
  if (is_on_sea(run)) figures.push_back({"sea-trace", sea_trace_figure(run, methods)});
  double noise = kAuto;
  for (const evaluation::RunResult& result : results.runs) {
    if (result.run == run.run) noise = result.noise_density_mps2_rthz;
  }
  figures.push_back({"spectra", spectra_figure(run, noise, methods)});
  RestRecords rest = rest_of(run);
  append(rest, std::move(rest_of_repeats));
  if (!rest.empty())
    figures.push_back({"allan-deviation", allan_figure(rest, !results.calibration_json.empty())});
  return figures;
}

std::vector<std::filesystem::path> write_figures(const std::vector<NamedFigure>& figures,
                                                 const std::filesystem::path& out,
                                                 const FigureOptions& options) {
  return drawn(tasks_of(figures, out, options), out, options.threads);
}

namespace {

// What the sensor told at rest in the other runs of the chosen setting; a log at a time.
RestRecords rest_of_repeats(const evaluation::CampaignResults& results, const evaluation::RunResult& chosen,
                            const std::filesystem::path& runs) {
  RestRecords rest;
  std::set<std::string> seen{chosen.run};
  for (const evaluation::RunResult& other : results.runs) {
    const bool repeat = other.period_s == chosen.period_s && other.height_m == chosen.height_m;
    const std::filesystem::path log = runs / (other.run + ".lcm");
    if (repeat && seen.insert(other.run).second && std::filesystem::exists(log))
      append(rest, rest_of(evaluation::load_run(log)));
  }
  return rest;
}

// A figure that an earlier call drew and this one has nothing to draw for would be shown beside the new ones.
void remove_others(const std::vector<std::filesystem::path>& drawn, const std::filesystem::path& out) {
  for (const FigureInfo& info : kFigureOrder) {
    std::filesystem::path path = out / (std::string(info.stem) + ".png");
    if (std::ranges::find(drawn, path) != drawn.end()) continue;
    std::filesystem::remove(path);
    std::filesystem::remove(path.replace_extension("svg"));
  }
}

}  // namespace

std::vector<std::filesystem::path> draw_campaign_figures(const evaluation::CampaignResults& results,
                                                         const std::filesystem::path& runs,
                                                         const std::filesystem::path& out,
                                                         const FigureOptions& options) {
  const evaluation::RunResult* chosen = paper_run(results);
  const evaluation::RunRecord run =
      chosen != nullptr ? evaluation::load_run(runs / (chosen->run + ".lcm")) : evaluation::RunRecord{};
  std::vector<NamedFigure> figures;
  if (chosen != nullptr)
    figures = run_figures(results, run, options, rest_of_repeats(results, *chosen, runs));
  for (NamedFigure& figure : result_figures(results)) figures.push_back(std::move(figure));
  std::vector<Task> tasks = tasks_of(figures, out, options);

  std::optional<RigMotion> motion;
  if (const std::string shown = nearest_method(run); !run.truth.empty())
    motion.emplace(run, shown, method_color(all_methods_of(results), shown));
  if (motion) {
    tasks.insert(tasks.begin(),
                 {out / (motion->on_sea() ? "buoy.png" : "rig.png"),
                  [&](Canvas& canvas, const std::filesystem::path& path) {
                    const double shown_s =
                        motion->crest_near_s(motion->begin_s() + 0.7 * (motion->end_s() - motion->begin_s()));
                    save_rig_picture(*motion, shown_s, canvas, path, options.theme, options.provenance);
                  }});
  }
  const std::vector<std::filesystem::path> paths = drawn(tasks, out, options.threads);
  remove_others(paths, out);
  return paths;
}

}  // namespace waverig::render
