// All figures of a campaign, drawn by several threads from its results and
// recorded runs.
#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "estimator/evaluation/results.h"
#include "render/figure_writer.h"
#include "render/figures/noise.h"
#include "render/figures/paper.h"

namespace waverig::render {

struct FigureOptions {
  int threads = 1;  // any number gives the same bytes
  Theme theme = Theme::kPrint;
  bool svg = false;  // beside each PNG the same figure as vectors
  Provenance provenance{};
  // The paper's method on the run's counts at nominal sensitivities; without it
  // figures 4 and 5 show the calibrated samples, and figure 6 is left out.
  std::function<PaperTraces(const evaluation::RunRecord&)> uncalibrated;
};

// What a reader is told of each figure, in the order of a report.
struct FigureInfo {
  std::string_view stem, group, caption;
};
inline constexpr std::array<FigureInfo, 20> kFigureOrder = {{
    {"rig", "The rig",
     "The rig in the run of the figures below: the arm turns, the gondola swings; the water is the wave that "
     "it "
     "stands for."},
    {"buoy", "The buoy",
     "The buoy in the run of the figures below; beside it the water is what came by before and comes by "
     "after."},
    {"paper-table-2", "As in the paper",
     "Table 2 as a chart: what was published beside what each method gives, "
     "with the Cram\u00E9r\u2013Rao bound of single waves."},
    {"paper-4-inertial-data", "As in the paper", "Figure 4: roll, pitch and specific force on three axes."},
    {"paper-5-uncorrected-trace", "As in the paper", "Figure 5: the trace before its errors are corrected."},
    {"paper-6-without-calibration", "As in the paper",
     "Figure 6: corrected trace and wave heights, accelerometer not "
     "calibrated."},
    {"paper-7-with-calibration", "As in the paper",
     "Figure 7: corrected trace and wave heights, accelerometer calibrated."},
    {"sea-states", "Accuracy",
     "Sea states: error of the heave, of the significant height Hm0 and of the mean period Tm02."},
    {"sea-heave-map", "Accuracy", "Error of the heave over peak period and Hm0."},
    {"sea-trace", "Accuracy", "Heave of each method beside the true one, and its error."},
    {"mean-heights", "Accuracy",
     "Mean height and scatter of single waves in every setting, with the Cram\u00E9r\u2013Rao bound of "
     "single waves."},
    {"error-map", "Accuracy", "Error of the mean wave height over period and height."},
    {"std-map", "Accuracy",
     "Standard deviation of single waves over period and height, the Cram\u00E9r\u2013Rao "
     "bound beside."},
    {"frequency-response", "Accuracy", "Gain and phase against period, as on a buoy's calibration sheet."},
    {"single-waves", "Accuracy", "Every single wave, estimated against true."},
    {"uncertainty-budget", "Accuracy", "What the uncertainty of the mean height is made of."},
    {"directions", "Accuracy", "From where the waves came."},
    {"calibration", "Sensor",
     "What the six-position calibration leaves over, and its result against "
     "the simulated truth."},
    {"allan-deviation", "Sensor",
     "Allan deviation of each sensor axis at rest, with the fitted noise "
     "terms."},
    {"spectra", "Sensor", "Spectra of specific force and heave, with the noise floor."},
}};

// One figure waiting to be drawn.
struct NamedFigure {
  std::string stem;  // of its file
  Figure figure;
};

// The run that stands for the campaign in the paper's figures: longest period,
// then greatest height, first repeat. nullptr where nothing ran.
const evaluation::RunResult* paper_run(const evaluation::CampaignResults& results);

// What `results` give without any recording; a figure that would be empty is left out.
std::vector<NamedFigure> result_figures(const evaluation::CampaignResults& results);
// What one recorded run gives; the sensor's noise at rest from its repeats too.
std::vector<NamedFigure> run_figures(const evaluation::CampaignResults& results,
                                     const evaluation::RunRecord& run, const FigureOptions& options,
                                     RestRecords rest_of_repeats = {});

// Draws and writes; the paths in the order of the figures.
std::vector<std::filesystem::path> write_figures(const std::vector<NamedFigure>& figures,
                                                 const std::filesystem::path& out,
                                                 const FigureOptions& options);

// Everything: out is made where it is missing; figures of kFigureOrder that an earlier call left there and of
// which there is none now are removed. Throws UserError where a log is
// missing or broken.
std::vector<std::filesystem::path> draw_campaign_figures(const evaluation::CampaignResults& results,
                                                         const std::filesystem::path& runs,
                                                         const std::filesystem::path& out,
                                                         const FigureOptions& options);

}  // namespace waverig::render
