#include "rig/campaign/sweep.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <optional>
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

// Both calibrations of the compass, of which the chosen one becomes the unit's. The arm lies still at its
// angle 0.
CompassRun calibrate_compass(const CampaignSettings& campaign, CampaignUnit& unit, std::int64_t begin_utime) {
  CompassRunSettings settings = campaign.compass_run;
  settings.begin_utime = begin_utime;
  if (campaign.sweep.mover == Mover::kArm) {
    settings.turntable_zero_rad = campaign.arm.azimuth_rad;
    const double radius_m = campaign.sweep.settings.front().height_m / 2;
    settings.position_N_m = quaternion_of({0, 0, campaign.arm.azimuth_rad}) * Vector3d(radius_m, 0, 0);
  }
  const CompassRun run = turn_compass(unit.settings, fresh_unit(campaign), acquisition_of(unit),
                                      derived_seed(campaign.seed, "compass turns"), settings);
  if (campaign.compass == CompassMethod::kMaxMin) unit.calibration.compass = run.max_min;
  if (campaign.compass == CompassMethod::kEllipsoid) unit.calibration.compass = run.ellipsoid;
  return run;
}

}  // namespace

CalibratedUnit calibrate(const CampaignSettings& campaign) {
  CalibratedUnit result;
  CampaignUnit& unit = result.unit;
  unit.settings = unit_settings(campaign);
  unit.tested = tested_unit(campaign);
  unit.sensitivities = nominal_sensitivities(unit.settings);
  unit.front_end = campaign.calibration.front_end;
  unit.methods = campaign.estimator;
  unit.calibrated = campaign.calibrate;
  if (!campaign.calibrate) return result;

  const UnitParameters fresh = fresh_unit(campaign);
  CalibrationRunSettings settings = campaign.calibration;
  settings.begin_utime = campaign.start_utime;
  settings.sensor_id = campaign.sensor.accelerometer + " + " + campaign.sensor.gyroscope;
  const double gravity = gravity_mps2(campaign.place);
  CalibrationRun run = run_six_positions(unit.settings, fresh, unit.sensitivities, gravity,
                                         derived_seed(campaign.seed, "six positions"), settings);
  unit.calibration = run.calibration;
  unit.methods.sensor = sensor_knowledge(campaign, run.calibration);
  std::optional<CompassRun> compass;
  if (unit.settings.magnetometer) compass = calibrate_compass(campaign, unit, run.end_utime);
  run.calibration = unit.calibration;
  result.report_json = calibration_report(
      run, true_calibration(unit.settings, fresh, unit.sensitivities, run.calibration.temperature_degC,
                            settings.model, unit.front_end));
  if (compass)
    result.report_json =
        with_compass_report(result.report_json, *compass, fresh.magnetometer, campaign.magnetic.field);
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
      const auto log = evaluation::log_of(directory.working(), runs[i].name);
      const auto judged =
          std::filesystem::exists(log)  // a log under its own name is whole: done before a resume
              ? evaluation::judge(evaluation::load_run(log), judge_settings(campaign.settings, unit, runs[i]))
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

bool tells_direction(const evaluation::CellResult& cell) { return std::isfinite(cell.sea.sea.spread_rad); }

std::string shown_direction(double from_rad) {
  return std::isfinite(from_rad) ? fmt::format("{:.2f}", from_rad / kDegree) : "all round";
}

// Not every method tells it.
std::string known(double value, int decimals = 2) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

// Empty where no method told a direction.
std::string direction_table(const evaluation::CampaignResults& results) {
  std::string rows;
  for (const auto& cell : results.cells) {
    const auto& sea = cell.sea.sea;
    if (!tells_direction(cell)) continue;
    rows +=
        fmt::format("{:8g} {:9g}  {:<12} {:>13} {:>11} {:>10} {:>10} {:>13} {:>8} {:>11}\n", cell.period_s,
                    cell.height_m / kCentimetre, cell.method, shown_direction(sea.mean_direction_rad),
                    known(cell.direction_error_rad / kDegree), known(cell.direction_rmse_rad / kDegree),
                    known(sea.spread_rad / kDegree), known(cell.sea.direction.spread_rad / kDegree),
                    known(sea.check_factor, 3), known(cell.sea.direction.check_factor, 3));
  }
  if (rows.empty()) return rows;
  return fmt::format("\n{:>8} {:>9}  {:<12} {:>13} {:>11} {:>10} {:>10} {:>13} {:>8} {:>11}\n", "period s",
                     "height cm", "method", "from deg true", "error deg", "rms deg", "spread deg",
                     "its truth deg", "check", "its truth") +
         rows;
}

std::string regular_table(const evaluation::CampaignResults& results) {
  std::string table = fmt::format("{:>8} {:>9}  {:<12} {:>6} {:>9} {:>9} {:>8} {:>8} {:>9} {:>8} {:>7}\n",
                                  "period s", "height cm", "method", "waves", "mean cm", "true cm", "error %",
                                  "std cm", "bound cm", "U(k=2)", "rmse cm");
  for (const auto& cell : results.cells) {
    const auto& s = cell.statistics;
    if (s.waves == 0 && tells_direction(cell)) continue;  // stands in the table of directions
    table +=
        fmt::format("{:8g} {:9g}  {:<12} {:6} {:>9} {:>9} {:>8} {:>8} {:>9} {:>8} {:>7}\n", cell.period_s,
                    cell.height_m / kCentimetre, cell.method, s.waves, known(s.mean_height_m / kCentimetre),
                    known(s.mean_true_height_m / kCentimetre), known(s.mean_error_percent),
                    known(s.std_m / kCentimetre), known(s.bound_std_m / kCentimetre),
                    known(s.expanded_uncertainty_m / kCentimetre), known(s.rmse_m / kCentimetre));
  }
  return table;
}

std::string sea_table(const evaluation::CampaignResults& results) {
  const auto percent = [](double value, double of) { return 100 * (value / of - 1); };
  std::string table = fmt::format("{:>5} {:>7}  {:<12} {:>12} {:>12} {:>7} {:>9} {:>8} {:>12} {:>13}\n",
                                  "Tp s", "Hm0 cm", "method", "heave rms cm", "% of Hm0", "bound", "gain",
                                  "lag s", "Hm0 error %", "Tm02 error %");
  for (const auto& cell : results.cells) {
    table += fmt::format("{:5g} {:7g}  {:<12} {:>12} {:>12} {:>7} {:>9} {:>8} {:>12} {:>13}\n", cell.period_s,
                         cell.height_m / kCentimetre, cell.method, known(cell.heave_rmse_m / kCentimetre),
                         known(100 * cell.heave_rmse_m / cell.true_hm0_m),
                         known(100 * cell.heave_bound_m / cell.true_hm0_m), known(cell.heave_gain, 4),
                         known(cell.heave_lag_s, 3), known(percent(cell.sea.sea.hm0_m, cell.sea.true_hm0_m)),
                         known(percent(cell.sea.sea.tm02_s, cell.sea.true_tm02_s)));
  }
  return table;
}

}  // namespace

std::string results_table(const evaluation::CampaignResults& results, Mover mover) {
  return (mover == Mover::kArm ? regular_table(results) : sea_table(results)) + direction_table(results);
}

}  // namespace waverig::rig
