// Writes report.html and compare.html of the example campaign into a folder, for browser_test.py.
#include <fstream>

#include "render/campaign_figures.h"
#include "render/report/report.h"
#include "tests/render/example_campaign.h"

int main(int argc, char** argv) {
  using namespace waverig;
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  const evaluation::CampaignResults results = test::example_campaign();
  evaluation::CampaignResults other = results;
  other.name = "another";
  other.cells[0].statistics.std_m *= 3;
  std::vector<render::NamedFigure> figures = render::result_figures(results);
  render::write_figures(figures, folder / "figures", {});
  std::ofstream(folder / "campaign.toml") << "name = \"example\"\n" << std::string(300, '#') << "\n";
  std::ofstream(folder / "report.html") << render::report_html(results, folder);
  std::ofstream(folder / "compare.html") << render::comparison_html(results, folder, other, folder);
}
