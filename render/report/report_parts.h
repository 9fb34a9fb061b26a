// The sections that report.html is put together from, each a piece of HTML; empty where there is nothing to
// say.
#pragma once
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "estimator/evaluation/results.h"
#include "motion/kinematics/frames.h"
#include "render/report/html.h"

namespace waverig::render {

// Set periods and heights as columns of a table: each with the decimals that the one in need of most has.
class SettingColumns {
 public:
  template <class Rows>
  explicit SettingColumns(const Rows& rows) {
    for (const auto& row : rows) {
      period_decimals_ = std::max(period_decimals_, decimals_of(row.period_s));
      height_decimals_ = std::max(height_decimals_, decimals_of(row.height_m / kCentimetre));
    }
  }
  // Their titles in front of others: of seas the set period and height are Tp and Hm0.
  static std::vector<std::string> heads(bool seas, std::vector<std::string> others) {
    others.insert(others.begin(), {seas ? "Tp s" : "Period s", seas ? "Hm0 cm" : "Height cm"});
    return others;
  }
  template <class Row>
  HtmlCell period(const Row& row) const {
    return number_cell(row.period_s, period_decimals_);
  }
  template <class Row>
  HtmlCell height(const Row& row) const {
    return number_cell(row.height_m / kCentimetre, height_decimals_);
  }

 private:
  static int decimals_of(double value) {
    int decimals = 0;
    for (; decimals < 2 && std::abs(value - std::round(value)) > 1e-6; ++decimals) value *= 10;
    return decimals;
  }
  int period_decimals_ = 0, height_decimals_ = 0;
};

// "1.00 to 2.00", or the one number that both are.
std::string range_text(double low, double high, int decimals);

// Before figures whose text is small on a narrow screen.
inline constexpr const char* kOpensLarge =
    "<p class=\"faint no-print\">Pressed, a figure opens as large as it is.</p>\n";

// Where a number of the tables leads: the runs of a setting and method.
std::string cell_id(const evaluation::CellResult& cell);

// What a campaign on irregular seas found: the first lines, and the table.
std::string sea_answer(const evaluation::CampaignResults& results);
std::string sea_results_table(const evaluation::CampaignResults& results);

// Where the waves came from, where a method tells it: the first lines, and the table.
std::string direction_answer(const evaluation::CampaignResults& results);
std::string direction_results_table(const evaluation::CampaignResults& results);

// The rig, the sensor with its calibration, and the settings as resolved.
std::string rig_section(const evaluation::CampaignResults& results, const std::filesystem::path& directory);

// Settings of the campaign's grid that were not run.
std::string left_out_settings(const evaluation::CampaignResults& results);

}  // namespace waverig::render
