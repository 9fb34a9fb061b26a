// report.html: one page that holds everything a campaign found, opens offline,
// prints, and reads on a phone.
#pragma once
#include <filesystem>
#include <string>

#include "estimator/evaluation/results.h"

namespace waverig::render {

// What is said of the whole campaign of one method, for the first lines; of irregular seas nothing.
struct MethodSummary {
  std::string method;
  std::size_t settings = 0;
  std::vector<std::string> without_waves;  // settings where it told none
  double worst_error_percent =
      estimator::kUnknown;             // of the mean height against the true one, over the others
  std::size_t beyond_uncertainty = 0;  // settings where the mean is off by more than U
  double least_std_m = estimator::kUnknown, largest_std_m = estimator::kUnknown;
  double worst_std_over_bound = estimator::kUnknown;
};
std::vector<MethodSummary> summaries_of(const evaluation::CampaignResults& results);

// HTML of the report of a finished results directory: its figures
// (figures/*.png), settings (campaign.toml) and the alarms of its logs are
// taken from there; what is missing is left out. Throws UserError where a log
// is broken.
std::string report_html(const evaluation::CampaignResults& results, const std::filesystem::path& directory);

// Two campaigns side by side: better, worse, or not significant, cell by cell. Throws UserError where they
// have no cell in common.
std::string comparison_html(const evaluation::CampaignResults& baseline,
                            const std::filesystem::path& baseline_directory,
                            const evaluation::CampaignResults& candidate,
                            const std::filesystem::path& candidate_directory);

}  // namespace waverig::render
