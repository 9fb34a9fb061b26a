// The figures of a bench run: temperature profile, procedure, results a channel; and what the live view
// shows.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "render/figure.h"
#include "rig/bench/analysis.h"
#include "rig/bench/report/traces.h"

namespace waverig::rig::bench {

// A window a panel, over the run so far.
render::Figure windows_figure(const std::vector<LiveWindow>& windows, const Traces& traces,
                              const std::string& title, const std::string& subtitle);

render::Figure temperature_figure(const Sequence& sequence, const Store& store, const Traces& traces);
render::Figure procedure_figure(const Sequence& sequence, const Store& store);
render::Figure scale_factor_figure(const Analysis& analysis);
render::Figure closure_figure(const Analysis& analysis);  // what the fits leave over, level by level
render::Figure bias_figure(const Analysis& analysis);
render::Figure oscillator_figure(const Analysis& analysis);

// All that a run has, each with the stem of its file and its caption.
struct BenchFigure {
  std::string stem, caption;
  render::Figure figure;
};
std::vector<BenchFigure> bench_figures(const Sequence& sequence, const Store& store,
                                       const Analysis* analysis);

// Sequence files are written in ASCII: their units as people read them.
std::string as_read(std::string text);

}  // namespace waverig::rig::bench
