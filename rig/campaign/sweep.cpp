#include "rig/campaign/sweep.h"

#include <fmt/format.h>

#include <atomic>
#include <exception>
#include <mutex>
#include <thread>

#include "estimator/evaluation/results_io.h"
#include "estimator/evaluation/run_record.h"
#include "motion/kinematics/random.h"
#include "rig/campaign/progress.h"
#include "rig/campaign/sensor_unit.h"

namespace waverig::rig {
namespace {

// Calls work(i) for i in [0, count) from some threads; the first exception ends all and is rethrown.
template <class Work>
void in_parallel(int jobs, std::size_t count, Work work) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex mutex;
  const auto worker = [&] {
    for (std::size_t i; (i = next++) < count;) try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!failure) failure = std::current_exception();
        next = count;
      }
  };
  std::vector<std::jthread> threads;
  for (int j = 1; j < jobs; ++j) threads.emplace_back(worker);
  worker();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

CalibratedUnit calibrate(const CampaignSettings& campaign) {
  CalibratedUnit result;
  CampaignUnit& unit = result.unit;
  unit.settings = unit_settings(campaign);
  unit.tested = tested_unit(campaign);
  unit.sensitivities = nominal_sensitivities(unit.settings);
  unit.methods = campaign.estimator;
  unit.calibrated = campaign.calibrate;
  if (!campaign.calibrate) return result;

  const UnitParameters fresh = fresh_unit(campaign);
  CalibrationRunSettings settings = campaign.calibration;
  settings.begin_utime = campaign.start_utime;
  settings.sensor_id = campaign.sensor.accelerometer + " + " + campaign.sensor.gyroscope;
  const double gravity = gravity_mps2(campaign.place);
  const CalibrationRun run = run_six_positions(unit.settings, fresh, unit.sensitivities, gravity,
                                               derived_seed(campaign.seed, "six positions"), settings);
  unit.calibration = run.calibration;
  unit.methods.sensor = sensor_knowledge(campaign, run.calibration);
  result.report_json = calibration_report(
      run, true_calibration(unit.settings, fresh, unit.sensitivities, run.calibration.temperature_degC));
  return result;
}

evaluation::CampaignResults run_campaign(const Campaign& campaign, const CalibratedUnit& calibrated,
                                         const std::vector<RunPlan>& runs, const ResultsDirectory& directory,
                                         const SweepOptions& options) {
  const CampaignUnit& unit = calibrated.unit;
  evaluation::invalidate_results(directory.working());
  evaluation::ResultsWriter writer(directory.working());
  std::mutex writing;
  {
    Progress progress("runs", runs.size());
    in_parallel(options.jobs, runs.size(), [&](std::size_t i) {
      const auto log = directory.runs() / (runs[i].name + ".lcm");
      const auto judged = std::filesystem::exists(log)   // a log under its own name is whole: done before a resume
                              ? evaluation::judge(evaluation::load_run(log), judge_settings(unit))
                              : run_embedded(campaign.settings, unit, runs[i], log);
      {
        const std::lock_guard lock(writing);
        for (const auto& of_method : judged) writer.add(of_method);
      }
      progress.done(runs[i].name);
    });
  }
  evaluation::CampaignResults head;
  head.name = campaign.settings.name;
  head.version = options.version;
  head.command = options.command;
  head.seed = campaign.settings.seed;
  head.complete = true;
  head.calibration_json = calibrated.report_json;
  return writer.finish(std::move(head));
}

namespace {

std::string regular_table(const evaluation::CampaignResults& results) {
  std::string table = fmt::format("{:>8} {:>9}  {:<12} {:>6} {:>9} {:>8} {:>8} {:>9} {:>8} {:>7}\n", "period s", "height cm",
                                  "method", "waves", "mean cm", "error %", "std cm", "bound cm", "U(k=2)", "rmse cm");
  for (const auto& cell : results.cells) {
    const auto& s = cell.statistics;
    table += fmt::format("{:8.1f} {:9.1f}  {:<12} {:6} {:9.2f} {:8.2f} {:8.2f} {:9.2f} {:8.2f} {:7.2f}\n", cell.period_s,
                         cell.height_m / kCentimetre, cell.method, s.waves, s.mean_height_m / kCentimetre,
                         s.error_rate_percent, s.std_m / kCentimetre, s.bound_std_m / kCentimetre,
                         s.expanded_uncertainty_m / kCentimetre, s.rmse_m / kCentimetre);
  }
  return table;
}

std::string sea_table(const evaluation::CampaignResults& results) {
  const auto percent = [](double value, double of) { return 100 * (value / of - 1); };
  std::string table =
      fmt::format("{:>5} {:>7}  {:<12} {:>12} {:>12} {:>9} {:>8} {:>12} {:>13}\n", "Tp s", "Hm0 cm", "method",
                  "heave rms cm", "% of Hm0", "gain", "lag s", "Hm0 error %", "Tm02 error %");
  for (const auto& cell : results.cells)
    table += fmt::format("{:5.1f} {:7.1f}  {:<12} {:12.2f} {:12.2f} {:9.4f} {:8.3f} {:12.2f} {:13.2f}\n", cell.period_s,
                         cell.height_m / kCentimetre, cell.method, cell.heave_rmse_m / kCentimetre,
                         100 * cell.heave_rmse_m / cell.true_hm0_m, cell.heave_gain, cell.heave_lag_s,
                         percent(cell.sea.sea.hm0_m, cell.sea.true_hm0_m), percent(cell.sea.sea.tm02_s, cell.sea.true_tm02_s));
  return table;
}

}  // namespace

std::string results_table(const evaluation::CampaignResults& results, Mover mover) {
  return mover == Mover::kArm ? regular_table(results) : sea_table(results);
}

}  // namespace waverig::rig
