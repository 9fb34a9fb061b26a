// The pages as text here; browser_test.py opens them in a real browser.
#include "render/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <regex>
#include <set>

#include "lcmtypes/error.h"
#include "render/campaign_figures.h"
#include "render/figures/accuracy.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"
#include "tests/render/example_campaign.h"
#include "tests/render/picture.h"

namespace waverig::render {
namespace {

std::vector<std::string> all(const std::string& text, const std::string& pattern) {
  std::vector<std::string> out;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    out.push_back((*it)[1]);
  return out;
}

// The report of the example with two figures beside it.
struct Example {
  test::TemporaryFolder folder;
  evaluation::CampaignResults results = test::example_campaign();
  Example() {
    std::vector<NamedFigure> figures = result_figures(results);
    figures.resize(2);
    write_figures(figures, folder.path() / "figures", {});
    std::ofstream(folder.path() / "campaign.toml") << "name = \"<example>\"\n";
  }
  std::string html() const { return report_html(results, folder.path()); }
};

TEST(Report, AsksNothingFromOutside) {
  const std::string html = Example().html();
  for (const std::string& source : all(html, "(?:src|srcset|action|data)=\"([^\"]{0,20})"))
    EXPECT_TRUE(source.starts_with("data:")) << source;
  for (const std::string& link : all(html, "href=\"([^\"]*)\""))
    EXPECT_TRUE(link.starts_with("#") || link.starts_with("runs/")) << link;
  EXPECT_EQ(html.find("http://"), std::string::npos);
  EXPECT_EQ(html.find("https://"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
}

TEST(Report, SaysWhoJudged) {
  Example example;
  example.results.version = "1.0+a";
  const std::string itself = example.html();
  EXPECT_NE(itself.find("<p>Methods: "), std::string::npos);
  EXPECT_NE(itself.find(". Judged by waverig 1.0+a.</p>"), std::string::npos);
  example.results.judged_version = "1.1+b";
  example.results.judged_command = "waverig evaluate done --heave theirs=<dir>";
  const std::string anew = example.html();
  EXPECT_NE(
      anew.find(". Judged anew by waverig 1.1+b: <code>waverig evaluate done --heave theirs=&lt;dir&gt;</code>.</p>"),
      std::string::npos);
  const std::string pair =
      comparison_html(Example().results, example.folder.path(), example.results, example.folder.path());
  EXPECT_NE(pair.find("version 1.0+a, judged anew by 1.1+b, seed"), std::string::npos);
}

// Its direction stands in a table of its own; it has no single waves that could be listed.
TEST(Report, ListsNoSingleWavesOfAMethodThatGivesNone) {
  Example example;
  evaluation::CellResult cell = example.results.cells.front();
  evaluation::RunResult run = example.results.runs.front();
  cell.method = run.method = "directional";
  cell.statistics = {};
  cell.sea.sea.spread_rad = 0.1;
  run.statistics = {};
  run.waves.clear();
  run.excluded_waves = 0;
  example.results.cells.push_back(cell);
  example.results.runs.push_back(run);
  const std::string html = example.html();
  EXPECT_NE(html.find("<p>Methods: lee2014, harmonic, directional. Judged"), std::string::npos);
  EXPECT_EQ(html.find(", directional: 0 waves"), std::string::npos);
  EXPECT_EQ(html.find("Single waves of " + run.run + ", directional"), std::string::npos);
  EXPECT_EQ(html.find("#run-" + run.run + "-directional"), std::string::npos);
  const std::size_t section = html.find("<section id=\"" + cell_id(cell) + "\">");   // the direction's numbers lead here
  ASSERT_NE(section, std::string::npos);
  EXPECT_NE(html.find("runs/" + run.run + ".lcm", section), std::string::npos);
  const std::vector<std::string> ids = all(html, " id=\"([^\"]*)\"");
  const std::set<std::string> known(ids.begin(), ids.end());
  for (const std::string& link : all(html, "href=\"#([^\"]*)\"")) EXPECT_TRUE(known.contains(link)) << link;
}

TEST(Report, LinksLeadToWhereTheyPromise) {
  const std::string html = Example().html();
  const std::vector<std::string> ids = all(html, " id=\"([^\"]*)\"");
  const std::set<std::string> known(ids.begin(), ids.end());
  EXPECT_EQ(known.size(), ids.size()) << "an id stands twice";
  std::size_t links = 0;
  for (const std::string& link : all(html, "href=\"#([^\"]*)\"")) {
    EXPECT_TRUE(known.contains(link)) << link;
    ++links;
  }
  EXPECT_GT(links, 50U);
}

TEST(Report, NumbersLeadToTheirRunAndWave) {
  const Example example;
  const std::string html = example.html();
  const evaluation::RunResult& run = example.results.runs.front();
  EXPECT_NE(html.find("id=\"run-" + run.run + "-" + run.method + "-wave-0\""), std::string::npos);
  EXPECT_NE(html.find("runs/" + run.run + ".lcm"), std::string::npos);
}

TEST(Report, TellsFlagsSeedAndCommand) {
  const std::string html = Example().html();
  EXPECT_NE(html.find("1 \u00D7 gap"), std::string::npos);
  EXPECT_NE(html.find("seed 7"), std::string::npos);
  EXPECT_NE(html.find("waverig sweep example.toml --seed 7"), std::string::npos);
}

TEST(Report, EscapesWhatItIsGiven) {
  Example example;
  example.results.name = "<script>alert(1)</script> & \"quotes\"";
  const std::string html = example.html();
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_NE(html.find("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;quotes&quot;"), std::string::npos);
  EXPECT_NE(html.find("name = &quot;&lt;example&gt;&quot;"), std::string::npos);
}

TEST(Report, StandsWithoutFiguresRunsOrResults) {
  const test::TemporaryFolder empty;
  const std::string html = report_html({}, empty.path());
  EXPECT_NE(html.find("not complete"), std::string::npos);
  EXPECT_EQ(html.find("<section id=\"figures\""), std::string::npos);
  const std::vector<std::string> ids = all(html, " id=\"([^\"]*)\"");
  for (const std::string& link : all(html, "href=\"#([^\"]*)\""))
    EXPECT_NE(std::find(ids.begin(), ids.end(), link), ids.end()) << link << " leads nowhere";
}

TEST(Report, SummaryIsTheWorstOfAllSettings) {
  const std::vector<MethodSummary> summaries = summaries_of(test::example_campaign());
  ASSERT_EQ(summaries.size(), 2U);
  const MethodSummary& baseline = summaries[0].method == "lee2014" ? summaries[0] : summaries[1];
  EXPECT_NEAR(baseline.worst_error_percent, 2.0, 1e-9);  // 1.2 cm of 60 cm
  EXPECT_NEAR(baseline.largest_std_m, 0.02, 1e-12);
  EXPECT_NEAR(baseline.worst_std_over_bound, 0.01 / 0.0026, 1e-9);
}

TEST(Report, AWaveByItselfDoesNotScatter) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_NE(report_html(results, empty.path()).find("; single waves scatter by 0.30 to 0.60 cm"), std::string::npos);
  for (auto& cell : results.cells) cell.statistics.std_m = 0.003;
  EXPECT_NE(report_html(results, empty.path()).find("; single waves scatter by 0.30 cm"), std::string::npos);
  for (auto& cell : results.cells) {
    cell.statistics.waves = 1;
    cell.statistics.std_m = cell.statistics.rmse_m = estimator::kUnknown;
  }
  const std::string html = report_html(results, empty.path());
  EXPECT_EQ(html.find("single waves scatter"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

// The rig makes a wave a little other than the set one: that is no error of the sensor's.
TEST(Report, ErrorsAreAgainstTheTrueHeightAndMarkedBeyondTheirUncertainty) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  std::erase_if(results.cells, [](const auto& c) { return c.method != "harmonic"; });
  for (auto& cell : results.cells) {
    evaluation::HeightStatistics& s = cell.statistics;
    s.mean_true_height_m = s.mean_height_m / 0.995;
    s.mean_error_percent = -0.5;
    s.error_rate_percent = 7;
    s.expanded_uncertainty_m = 0.0035;  // the error of 80 and 100 cm is more
  }
  EXPECT_EQ(summaries_of(results).front().beyond_uncertainty, 4U);
  const std::string html = report_html(results, empty.path());
  EXPECT_NE(html.find("within 0.50 % of the true height in every setting; in 4 of 6 it is further off than its "
                      "expanded uncertainty U; single"),
            std::string::npos);
  EXPECT_EQ(html.find(">7.00<"), std::string::npos);
  EXPECT_NE(html.find("\u22120.50</a></td>"), std::string::npos) << "60 cm";
  EXPECT_NE(html.find("\u22120.50</a>*</td>"), std::string::npos) << "100 cm";
  const Figure figure = error_map_figure(results);
  const HeatMap& map = std::get<HeatMap>(figure.panels.at(0).marks.front());
  EXPECT_EQ(map.values, std::vector<double>(6, -0.5));
  EXPECT_EQ(map.signs, (std::vector<std::string>{"", "", "*", "*", "*", "*"}));
  EXPECT_NE(figure.subtitle.find("* beyond the expanded uncertainty"), std::string::npos);
}

TEST(Report, ASettingWithoutWavesIsNoSuccess) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_NE(report_html(results, empty.path()).find("of the true height in every setting; in"), std::string::npos);
  for (auto& cell : results.cells)
    if (cell.method == "lee2014" && cell.period_s == 12 && cell.height_m == 0.6) cell.statistics = {};
  EXPECT_NE(report_html(results, empty.path())
                .find("<strong>lee2014</strong>: the mean wave height is within 2.00 % of the true height in 5 of 6 "
                      "settings; none were measured at 12 s, 60 cm; in 5 of 5 it is further off than its expanded uncertainty U; single waves"),
            std::string::npos);
  for (auto& cell : results.cells)
    if (cell.method == "lee2014") cell.statistics = {};
  EXPECT_NE(report_html(results, empty.path()).find("lee2014</strong>: no single wave was measured"), std::string::npos);
}

TEST(Report, AnswersWhereTheWavesCameFrom) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_EQ(report_html(results, empty.path()).find("where the waves came from is"), std::string::npos);
  double rmse_deg = 0.2;
  for (auto& cell : results.cells) {
    if (cell.method != "harmonic") continue;
    cell.sea.sea.spread_rad = 0.1;
    cell.sea.sea.check_factor = 1 + rmse_deg / 100;
    cell.direction_rmse_rad = (rmse_deg += 0.1) * kDegree;
  }
  EXPECT_NE(report_html(results, empty.path())
                .find("<strong>harmonic</strong>: where the waves came from is within 0.80\u00B0 of the true direction "
                      "(rms over the runs of a setting) in every setting; the check factor is 1.002 to 1.007."),
            std::string::npos);
}

TEST(Report, PeriodsOfATableHaveTheSameDecimals) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_NE(report_html(results, empty.path()).find(">6</td><td data-value=\"60\">60</td>"), std::string::npos);
  for (auto& cell : results.cells)
    if (cell.period_s == 12) cell.period_s = 12.5;
  const std::string html = report_html(results, empty.path());
  EXPECT_NE(html.find(">6.0</td><td data-value=\"60\">60</td>"), std::string::npos);
  EXPECT_NE(html.find(">12.5</td><td data-value=\"60\">60</td>"), std::string::npos);
}

TEST(Report, OfSeasSpeaksOfHeaveAndSeaStates) {
  const test::TemporaryFolder empty;
  const evaluation::CampaignResults seas = test::example_sea_campaign();
  EXPECT_TRUE(summaries_of(seas).empty());
  const std::string html = report_html(seas, empty.path());
  EXPECT_NE(
      html.find("the heave is off by 1.00 % of Hm0 (rms); Hm0 is within 0.50 %, Tm02 within 0.20 %"),
      std::string::npos);
  EXPECT_NE(html.find("the heave is off by 10.00 % of Hm0 (rms).<"), std::string::npos);
  EXPECT_EQ(html.find("of the true height in every setting"), std::string::npos);
}

TEST(Report, FoldsTheRunsOfManySettings) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  const std::string fold = "<h2>Runs and waves</h2>\n<details><summary>";
  EXPECT_EQ(report_html(results, empty.path()).find(fold), std::string::npos);
  const std::vector<evaluation::CellResult> cells = results.cells;
  for (const double more_s : {0.5, 1.0})
    for (evaluation::CellResult cell : cells) {
      cell.period_s += more_s;
      results.cells.push_back(cell);
    }
  EXPECT_NE(report_html(results, empty.path()).find(fold + "36 settings and methods"), std::string::npos);
}

TEST(Report, StatesTheUncertaintyOfHm0WhereAMethodDoes) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults seas = test::example_sea_campaign();
  EXPECT_EQ(report_html(seas, empty.path()).find("\u00B1 (k"), std::string::npos);
  seas.cells[0].sea.sea.hm0_sigma_m = 0.0123;
  const std::string html = report_html(seas, empty.path());
  EXPECT_NE(html.find(">Hm0 measured</th><th scope=\"col\">\u00B1 (k"), std::string::npos);
  EXPECT_NE(html.find(">2.46<"), std::string::npos);
}

TEST(Report, NamesTheSettingsThatWereNotRun) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  EXPECT_EQ(report_html(results, empty.path()).find("were not run"), std::string::npos);
  std::erase_if(results.cells, [](const auto& c) { return c.period_s == 6 && c.height_m > 0.7; });
  EXPECT_NE(report_html(results, empty.path()).find("were not run: 6 s with 80, 100 cm."), std::string::npos);
}

TEST(Report, TellsTheSensorAndWhatItsCalibrationTookOut) {
  const test::TemporaryFolder empty;
  evaluation::CampaignResults results = test::example_campaign();
  results.calibration_json = R"({"sensor_id": "A & B", "method": "six positions", "temperature_degC": 24.25,
    "accelerometer": {"M": [[1.01, 0, 0], [0, 0.99, 0], [0, 0, 1]], "sigma_M": [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 1e-4]],
    "b_mps2": [0.25, -0.3, 0], "sigma_b_mps2": [0.001, 0.001, 0.001]}})";
  const std::string html = report_html(results, empty.path());
  EXPECT_NE(html.find("A &amp; B, calibrated in six positions"), std::string::npos);
  for (const char* number : {">250.00<", ">\u2212300.00<", ">1.000<", ">\u22121.000<"})
    EXPECT_NE(html.find(number), std::string::npos) << number;
  results.calibration_json = "{";
  EXPECT_THROW(report_html(results, empty.path()), UserError);
}

TEST(Comparison, CallsBetterWorseAndNotSignificant) {
  const Example a, b;
  evaluation::CampaignResults worse = b.results;
  worse.cells[0].statistics.std_m *= 3;
  worse.cells[2].statistics.std_m /= 3;
  const std::string html = comparison_html(a.results, a.folder.path(), worse, b.folder.path());
  EXPECT_NE(html.find("\u25BC worse"), std::string::npos);
  EXPECT_NE(html.find("\u25B2 better"), std::string::npos);
  EXPECT_NE(html.find("not significant"), std::string::npos);
  EXPECT_EQ(all(html, "(data:image/png;base64,)").size(), 4U);
}

// What counts in the verdict stands in the table: of a sea its Hm0 and its heave too.
TEST(Comparison, ShowsHm0AndHeaveOfSeasAlone) {
  const evaluation::CampaignResults heights = test::example_campaign();
  const test::TemporaryFolder empty;  // a picture's letters may spell anything
  const auto page = [&](const evaluation::CampaignResults& candidate) {
    return comparison_html(heights, empty.path(), candidate, empty.path());
  };
  EXPECT_EQ(page(heights).find("Hm0"), std::string::npos);
  EXPECT_EQ(page(heights).find("Heave rms"), std::string::npos);
  evaluation::CampaignResults seas = heights;
  evaluation::CellResult& sea = seas.cells[0];
  sea.motion = evaluation::Motion::kSea;
  sea.heave_rmse_m = 0.0123;
  sea.heave_rmse_sigma_m = 0.0001;
  sea.heave_runs = 3;
  sea.sea = {.sea = {.hm0_m = 1.0345, .hm0_sigma_m = 0.003}, .true_hm0_m = 1};
  evaluation::CampaignResults better = seas;
  better.cells[0].heave_rmse_m = 0.0111;
  better.cells[0].sea.sea.hm0_m = 1.0567;
  const std::string html = comparison_html(seas, empty.path(), better, empty.path());
  EXPECT_NE(page(heights).find(">Period s<"), std::string::npos);
  for (const char* text : {">Tp s<", ">Hm0 cm<", ">Hm0 error, baseline<", ">Hm0 error, candidate<", ">Hm0 error: verdict<", ">Heave rms, baseline<",
                           ">Heave rms: verdict<", ">3.45<", ">5.67<", ">1.23<", ">1.11<"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  const std::size_t row = html.find(">3.45<");
  EXPECT_LT(html.find("\u25BC worse", row), html.find(">1.23<", row)) << "Hm0";
  EXPECT_LT(html.find("\u25B2 better", row), html.find("</tr>", row)) << "heave";
}

TEST(Html, Base64OfAPictureIsWhole) {
  const Example example;
  const std::filesystem::path png = example.folder.path() / "figures" / "paper-table-2.png";
  const std::string html = html_figure(png, "x");
  const std::size_t first = html.find("base64,") + std::string("base64,").size();
  const std::string code = html.substr(first, html.find('"', first) - first);
  const std::vector<std::uint8_t> bytes = test::bytes_of(png);
  EXPECT_EQ(code.size(), (bytes.size() + 2) / 3 * 4);
  EXPECT_TRUE(code.starts_with("iVBORw0KGgo")) << "the signature of PNG";
}

// A folder of the name opens as a file does, and gives nothing.
TEST(Report, NamesAFileThatCannotBeRead) {
  const Example example;
  for (const char* name : {"campaign.toml", "figures/paper-table-2.png"}) {
    const std::filesystem::path path = example.folder.path() / name;
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    try {
      report_html(example.results, example.folder.path());
      ADD_FAILURE() << name;
    } catch (const UserError& error) {
      EXPECT_EQ(std::string(error.what()).find(path.string() + ": cannot be read: Is a directory; expected "), 0U) << error.what();
    }
    std::filesystem::remove(path);
  }
}

TEST(Html, UnknownNumbersAreDashesAndSortLast) {
  HtmlTable table("t", {"a"});
  table.add_row({number_cell(std::nan(""), 2)});
  EXPECT_NE(table.html().find("data-value=\"NaN\">\u2013<"), std::string::npos);
}

}  // namespace
}  // namespace waverig::render
