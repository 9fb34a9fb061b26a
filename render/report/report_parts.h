// The sections that report.html is put together from, each a piece of HTML; empty where there is nothing to
// say.
#pragma once
#include <filesystem>
#include <string>

#include "estimator/evaluation/results.h"

namespace waverig::render {

// Where a number of the tables leads: the runs of a setting and method.
std::string cell_id(const evaluation::CellResult& cell);

// What a campaign on irregular seas found: the first lines, and the table.
std::string sea_answer(const evaluation::CampaignResults& results);
std::string sea_results_table(const evaluation::CampaignResults& results);

// Where the waves came from, where a method tells it.
std::string direction_results_table(const evaluation::CampaignResults& results);

// The rig, the sensor with its calibration, and the settings as resolved.
std::string rig_section(const evaluation::CampaignResults& results, const std::filesystem::path& directory);

// Settings of the campaign's grid that were not run.
std::string left_out_settings(const evaluation::CampaignResults& results);

}  // namespace waverig::render
