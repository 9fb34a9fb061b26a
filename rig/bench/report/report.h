// The report of a bench run: one self-contained HTML page with the figures of the document and every result.
#pragma once
#include <filesystem>
#include <string>

#include "rig/bench/report/figures.h"
#include "rig/bench/results.h"

namespace waverig::rig::bench {

// Draws figures/STEM.png below out. Throws UserError where that cannot be written.
void draw_figures(const std::vector<BenchFigure>& figures, const std::filesystem::path& out,
                  const std::string& version);

// analysis: nullptr where the run did not come to its end. The pictures are taken from out/figures.
std::string bench_report_html(const Sequence& sequence, const Store& store, const Analysis* analysis,
                              const std::vector<Verdict>& verdicts, const std::vector<BenchFigure>& figures,
                              const std::filesystem::path& out, const std::string& command);

}  // namespace waverig::rig::bench
