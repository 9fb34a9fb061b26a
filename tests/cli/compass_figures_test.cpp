#include "rig/cli/compass_figures.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/canvas.h"
#include "render/figure_writer.h"
#include "render/layout.h"

namespace waverig::cli {
namespace {

TEST(CompassFigures, TitlesOfPanelsSideBySideStandAtOneHeight) {
  estimator::TiltStudySettings settings;
  settings.runs = 2;
  const auto figures = compass_figures(estimator::run_tilt_study(settings), border_of(settings));
  const auto border = std::ranges::find(figures, "border", &NamedFigure::file);
  ASSERT_NE(border, figures.end());
  render::Canvas canvas;
  render::prepare_fonts(border->figure, canvas.fonts());
  canvas.fonts().bake();
  const render::FigurePlan plan = render::planned(border->figure, canvas.fonts());
  ASSERT_EQ(plan.panels.size(), 3U);
  for (const render::PanelPlan& panel : plan.panels)
    EXPECT_EQ(panel.title_bottom, plan.panels.front().title_bottom) << panel.panel.title;
}

}  // namespace
}  // namespace waverig::cli
