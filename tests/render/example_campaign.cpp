#include "tests/render/example_campaign.h"

#include <cmath>
#include <numbers>

#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::test {

using evaluation::CampaignResults;

CampaignResults example_campaign() {
  CampaignResults results;
  results.name = "example";
  results.version = "0.1.0";
  results.command = "waverig sweep example.toml --seed 7";
  results.seed = 7;
  results.complete = true;
  results.calibration_json = example_calibration();
  RandomStream noise(7, "example");
  for (const double period_s : {6.0, 12.0}) {
    for (const double height_m : {0.6, 0.8, 1.0}) {
      for (const std::string method : {"harmonic", "lee2014"}) {
        const bool baseline = method == "lee2014";
        const double sigma_m = (baseline ? 0.01 : 0.003) * period_s / 6, bias_m = baseline ? 0.012 : 0.001;
        evaluation::CellResult cell;
        cell.period_s = period_s;
        cell.height_m = height_m;
        cell.method = method;
        for (int repeat = 0; repeat < 2; ++repeat) {
          evaluation::RunResult run;
          run.run = "T" + std::to_string(static_cast<int>(period_s)) + "_H" +
                    std::to_string(static_cast<int>(100 * height_m)) + "_r" + std::to_string(repeat + 1);
          run.method = method;
          run.repeat = repeat;
          run.period_s = period_s;
          run.height_m = height_m;
          run.excluded_waves = 2;
          run.heave_gain = 1.001;
          run.heave_lag_s = 0.002;
          run.heave_rmse_m = baseline ? 20 : 0.004;
          run.noise_density_mps2_rthz = 0.0034;
          const int waves = 10;
          double sum = 0;
          for (int i = 0; i < waves; ++i) {
            evaluation::JudgedWave wave;
            wave.wave.start_utime = static_cast<std::int64_t>((44 + i * period_s) * 1e6);
            wave.wave.seq = i;
            wave.wave.period_s = period_s;
            wave.true_height_m = height_m;
            wave.wave.height_m = height_m + bias_m + noise.gaussian(sigma_m);
            wave.wave.noise_sigma_m = sigma_m;
            if (i == 3) wave.wave.flags = flag::kGap;
            sum += wave.wave.height_m;
            run.waves.push_back(wave);
          }
          run.statistics.waves = waves;
          run.statistics.mean_height_m = sum / waves;
          run.statistics.mean_true_height_m = height_m;
          run.statistics.std_m = sigma_m;
          run.statistics.rmse_m = sigma_m;
          estimator::SeaState sea;
          sea.hm0_m = height_m;
          sea.mean_direction_rad = repeat * 0.8;
          if (!baseline) run.seas.push_back({.sea = sea});
          results.runs.push_back(run);
        }
        cell.true_hm0_m = std::numbers::sqrt2 * height_m;
        evaluation::HeightStatistics& s = cell.statistics;
        s.waves = 20;
        s.mean_height_m = height_m + bias_m;
        s.error_rate_percent = 100 * bias_m / height_m;
        s.mean_error_percent = 100 * bias_m / height_m;
        s.std_m = sigma_m;
        s.rmse_m = sigma_m;
        s.mean_true_height_m = height_m;
        s.expanded_uncertainty_m = 0.004;
        s.bound_std_m = 0.0026 * std::pow(period_s / 6, 1.5);
        s.budget = {{"noise", sigma_m / 4, 'A'}, {"calibration", 0.001 * height_m, 'B'}};
        results.cells.push_back(cell);
      }
    }
  }
  return results;
}

evaluation::RunRecord example_run(double period_s, double height_m, double steady_s) {
  evaluation::RunRecord run;
  run.run = "T12_H100_r1";
  run.period_s = period_s;
  run.height_m = height_m;
  run.start_utime = 1'000'000;
  const double rest_s = 20, ramp_s = 2 * period_s, end_s = rest_s + 2 * ramp_s + steady_s,
               omega = 2 * std::numbers::pi / period_s;
  const auto utime = [&](double t) {
    return run.start_utime + static_cast<std::int64_t>(std::llround(t * 1e6));
  };
  run.steady_begin_utime = utime(rest_s + ramp_s);
  run.steady_end_utime = utime(rest_s + ramp_s + steady_s);
  RandomStream noise(1, "run");
  const double r = 0.5 * height_m;
  for (int i = 0; i < static_cast<int>(end_s * 50); ++i) {
    const double t = i * 0.02, since = std::max(0.0, t - rest_s);
    const double grown = std::min(1.0, since / ramp_s), angle = omega * since * grown;
    const double pitch_rad = 0.02 * std::sin(angle);
    evaluation::TruthSample truth;
    truth.utime = utime(t);
    truth.heave_m = r * std::sin(angle);
    truth.north_m = r * std::cos(angle);
    truth.arm_angle_rad = angle;
    truth.q_NB = quaternion_of({0, pitch_rad, 0});
    run.truth.push_back(truth);
    estimator::ImuSample imu;
    imu.utime = utime(t);
    imu.seq = i;
    const double acceleration = -r * omega * omega * std::sin(angle);
    imu.f_B = {noise.gaussian(0.02), noise.gaussian(0.02),
               -kStandardGravity - acceleration + noise.gaussian(0.02)};
    imu.w_NB_B = {noise.gaussian(0.001), noise.gaussian(0.001), noise.gaussian(0.001)};
    run.imu.push_back(imu);
    estimator::HeaveSample heave;
    heave.utime = imu.utime;
    heave.seq = i;
    heave.heave_m = truth.heave_m + 0.004 * std::sin(0.3 * t);
    heave.q_NB = truth.q_NB;
    run.heave["harmonic"].push_back(heave);
    heave.heave_m = truth.heave_m + 0.002 * t * t;
    run.heave["lee2014"].push_back(heave);
  }
  std::int64_t seq = 0;
  for (double t = rest_s + ramp_s; t + period_s <= end_s; t += period_s) {
    estimator::Wave wave;
    wave.start_utime = utime(t);
    wave.seq = seq++;
    wave.period_s = period_s;
    wave.height_m = height_m + noise.gaussian(0.01);
    run.waves["lee2014"].push_back(wave);
    run.waves["harmonic"].push_back(wave);
  }
  return run;
}

CampaignResults example_sea_campaign() {
  CampaignResults results = example_campaign();
  results.name = "example seas";
  for (evaluation::CellResult& cell : results.cells) {
    cell.true_hm0_m = 0.99 * cell.height_m;
    cell.heave_rmse_m = cell.method == "harmonic" ? 0.01 * cell.true_hm0_m : 0.1 * cell.true_hm0_m;
    if (cell.method != "harmonic") continue;
    cell.sea.sea.hm0_m = 1.005 * cell.true_hm0_m;
    cell.sea.true_hm0_m = cell.true_hm0_m;
    cell.sea.sea.tm02_s = 0.998 * cell.period_s;
    cell.sea.true_tm02_s = cell.period_s;
  }
  return results;
}

evaluation::RunRecord example_sea_run() {
  evaluation::RunRecord run = example_run();
  for (evaluation::TruthSample& sample : run.truth) sample.arm_angle_rad = estimator::kUnknown;
  return run;
}

std::string example_calibration() {
  return R"({"positions": [
    {"name": "x up", "residual_mps2": [0.001, -0.002, 0.0005]}, {"name": "x down", "residual_mps2": [-0.001, 0.002, 0.0002]},
    {"name": "y up", "residual_mps2": [0.0003, 0.001, 0.001]}, {"name": "y down", "residual_mps2": [0.002, -0.001, 0]},
    {"name": "z up", "residual_mps2": [0, 0.001, -0.001]}, {"name": "z down", "residual_mps2": [0.001, 0, 0.002]}],
  "simulated_truth": {"error_over_sigma": [0.1, -0.4, 1.2, 0.3, -2.2, 0.5, 0.7, -0.1, 0.2, 0.9, -1.1, 0.4], "chi_square": 11.5, "degrees_of_freedom": 12}})";
}

}  // namespace waverig::test
