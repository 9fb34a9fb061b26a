#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "estimator/evaluation/results_files.h"
#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "render/figures/settings.h"
#include "render/report/html.h"
#include "render/report/report_parts.h"

namespace waverig::render {
namespace {

using nlohmann::json;

std::string folded(const char* title, const std::string& text) {
  return fmt::format("<details><summary>{}</summary><pre>{}</pre></details>\n", title, html_text(text));
}

// Bias and sensitivity of each axis as the campaign's calibration found them.
std::string sensor_table(const json& calibration) {
  const json& accelerometer = calibration.at("accelerometer");
  HtmlTable table(
      "What the calibration took out of each axis of the accelerometer, \u00B1 one standard uncertainty.",
      {"Axis", "Bias mm/s\u00B2", "\u00B1", "Sensitivity off %", "\u00B1"});
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto of = [&](const char* name) { return accelerometer.at(name).at(i); };
    table.add_row({text_cell(kAxes[i]), number_cell(1000 * of("b_mps2").get<double>(), 2),
                   number_cell(1000 * of("sigma_b_mps2").get<double>(), 2),
                   number_cell(100 * (of("M").at(i).get<double>() - 1), 3),
                   number_cell(100 * of("sigma_M").at(i).get<double>(), 3)});
  }
  return table.html(false);
}

std::string sensor_part(const std::string& text) {
  try {
    const json calibration = json::parse(text);
    std::string out;
    if (calibration.contains("sensor_id") && calibration.contains("method"))
      out += fmt::format(
          "<p>The sensor: {}, calibrated in {} at the campaign\u2019s start{}.</p>\n",
          html_text(calibration.at("sensor_id").get<std::string>()),
          html_text(calibration.at("method").get<std::string>()),
          calibration.contains("temperature_degC")
              ? fmt::format(" at {:.1f} \u00B0C", calibration.at("temperature_degC").get<double>())
              : "");
    if (calibration.contains("accelerometer")) out += sensor_table(calibration);
    return out;
  } catch (const json::exception& error) {
    throw UserError(
        fmt::format("calibration report: {}: a sensor calibration in JSON expected", error.what()));
  }
}

}  // namespace

std::string rig_section(const evaluation::CampaignResults& results, const std::filesystem::path& directory) {
  const std::filesystem::path file = directory / evaluation::kSettingsFile;
  const std::string settings =
      std::filesystem::exists(file) ? content_of(file, "the resolved settings of a campaign") : "";
  if (settings.empty() && results.calibration_json.empty()) return "";
  std::string out = "<section id=\"rig\"><h2>Rig and sensor</h2>\n<p>";
  out += are_seas(results)
             ? "A buoy rides an irregular sea; the sensor in it streams to the estimator, and what the "
               "estimator tells is held against what the buoy really did."
             : "A motion controller turns an arm that carries a gondola; the sensor riding in it streams "
               "to the estimator, and what the estimator tells is held against what the mechanism "
               "really did.";
  out += "</p>\n";
  if (!results.calibration_json.empty()) out += sensor_part(results.calibration_json);
  if (!settings.empty()) out += folded("Settings as resolved, defaults included", settings);
  if (!results.calibration_json.empty()) out += folded("The calibration in full", results.calibration_json);
  return out + "</section>\n";
}

std::string left_out_settings(const evaluation::CampaignResults& results) {
  const std::vector<Setting> settings = settings_of(results);
  const Grid grid(settings);
  std::string missing;
  for (const double period_s : grid.periods_s) {
    std::string heights;
    for (const double height_m : grid.heights_m) {
      if (std::find(settings.begin(), settings.end(), Setting{period_s, height_m}) == settings.end())
        heights += fmt::format("{}{:g}", heights.empty() ? "" : ", ", cm(height_m));
    }
    if (!heights.empty())
      missing += fmt::format("{}{:g} s with {} cm", missing.empty() ? "" : "; ", period_s, heights);
  }
  if (missing.empty()) return "";
  return fmt::format(
      "<p>Of the grid of periods and heights these were not run: {}. Outside of what the rig can make or the "
      "sensor "
      "can measure; <code>waverig plan campaign.toml</code> says which limit each one breaks.</p>\n",
      missing);
}

}  // namespace waverig::render
