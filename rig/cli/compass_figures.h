// The figures of the compass analysis: Cho's figures 2 to 6, and the border of the linear formulas.
#pragma once
#include <string>
#include <vector>

#include "estimator/compass/error_propagation.h"
#include "estimator/compass/tilt_study.h"
#include "render/figure.h"

namespace waverig::cli {

// Where the formulas stop being good to a tenth, along the document's sweep (roll = pitch = tilt), case I.
struct BorderPoint {
  double tilt_rad = 0;
  double first_of_g[3] = {0, 0, 0}, second_of_g[3] = {0, 0, 0};  // roll, pitch, heading
};
std::vector<BorderPoint> border_of(const estimator::TiltStudySettings& settings);

struct NamedFigure {
  std::string file;  // without extension
  render::Figure figure;
};
std::vector<NamedFigure> compass_figures(const estimator::TiltStudy& study,
                                         const std::vector<BorderPoint>& border);

}  // namespace waverig::cli
