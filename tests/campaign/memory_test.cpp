// Memory stays flat: what a run needed is given back before the next.
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "rig/campaign/sweep.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig {
namespace {

// Linux counts the peak of the resident set, and starts anew when told to (proc(5), clear_refs).
void forget_peak() { std::ofstream("/proc/self/clear_refs") << 5; }
double peak_MB() {
  std::ifstream status("/proc/self/status");
  std::string key;
  double kilobytes = 0;
  while (status >> key)
    if (key == "VmHWM:" && status >> kilobytes) return kilobytes / 1024;
  return 0;
}

void sweep(const std::filesystem::path& out, int repeats) {
  const Campaign campaign = read_campaign(TomlFile(
      "name = \"flat\"\nseed = 7\n[sweep]\nperiods_s = [4.0]\nheights_cm = [50.0]\nduration_s = 40.0\n"
      "ramp_periods = 1\nrest_before_s = 5.0\nrepeats = " +
          std::to_string(repeats) + "\n",
      "flat.toml"));
  ResultsDirectory directory(out, ResultsDirectory::Mode::kFresh);
  directory.claim(campaign.resolved, "test");
  run_campaign(campaign, calibrate(campaign.settings), plan_campaign(campaign.settings).runs, directory, {});
  directory.finish();
}

TEST(Sweep, NeedsNoMoreMemoryForManyRunsThanForFew) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "a sanitizer keeps freed memory back";
#endif
  const TemporaryDirectory temporary;
  sweep(temporary / "first", 2);
  forget_peak();
  sweep(temporary / "few", 2);
  const double few_MB = peak_MB();
  forget_peak();
  sweep(temporary / "many", 16);
  ASSERT_GT(few_MB, 0);
  const double log_MB =
      static_cast<double>(std::filesystem::file_size(temporary / "few/runs/T04.00s_H050.0cm_r1.lcm")) / 1e6;
  EXPECT_LT(peak_MB() - few_MB, log_MB) << "14 more runs, each with a log of " << log_MB << " MB";
}

}  // namespace
}  // namespace waverig::rig
