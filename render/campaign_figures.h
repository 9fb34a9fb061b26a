// All figures of a campaign, drawn by several threads from its results and recorded runs.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"
#include "render/figure_writer.h"
#include "render/figures/paper.h"

namespace waverig::render {

struct FigureOptions {
  int threads = 1;                     // any number gives the same bytes
  Theme theme = Theme::kPrint;
  bool svg = false;                    // beside each PNG the same figure as vectors
  Provenance provenance;
  // The paper's method on the run's counts at nominal sensitivities; without it figures 4 and 5 show the calibrated
  // samples, and figure 6 is left out.
  std::function<PaperTraces(const evaluation::RunRecord&)> uncalibrated;
};

// One figure waiting to be drawn.
struct NamedFigure {
  std::string stem;                    // of its file
  Figure figure;
};

// The run that stands for the campaign in the paper's figures: longest period, then greatest height, first repeat.
// nullptr where nothing ran.
const evaluation::RunResult* paper_run(const evaluation::CampaignResults& results);

// What `results` give without any recording.
std::vector<NamedFigure> result_figures(const evaluation::CampaignResults& results);
// What one recorded run gives.
std::vector<NamedFigure> run_figures(const evaluation::CampaignResults& results, const evaluation::RunRecord& run, const FigureOptions& options);

// Draws and writes; the paths in the order of the figures.
std::vector<std::filesystem::path> write_figures(const std::vector<NamedFigure>& figures, const std::filesystem::path& out, const FigureOptions& options);

// Everything: out is made where it is missing. Throws UserError where a log is missing or broken.
std::vector<std::filesystem::path> draw_campaign_figures(const evaluation::CampaignResults& results, const std::filesystem::path& runs,
                                                         const std::filesystem::path& out, const FigureOptions& options);

}  // namespace waverig::render
