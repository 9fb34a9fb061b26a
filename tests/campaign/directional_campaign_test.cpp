// Direction through the whole campaign path: magnetometer counts in frames, compass calibration on the rig,
// samples on the bus, method, judge.
#include <gtest/gtest.h>

#include "estimator/compass/direction_budget.h"
#include "estimator/evaluation/cells.h"
#include "estimator/evaluation/results_io.h"
#include "lcmtypes/error.h"
#include "rig/campaign/sensor_unit.h"
#include "rig/campaign/sweep.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig {
namespace {

// Of one method; in memory, nothing is recorded.
std::vector<evaluation::RunResult> runs_of(const Campaign& campaign, const std::string& method) {
  const CampaignUnit unit = calibrate(campaign.settings).unit;
  std::vector<evaluation::RunResult> found;
  for (const RunPlan& plan : plan_campaign(campaign.settings).runs)
    for (auto& result : run_embedded(campaign.settings, unit, plan, {}))
      if (result.method == method) found.push_back(std::move(result));
  return found;
}

double wrapped_deg(double angle_rad) { return std::remainder(angle_rad, 2 * std::numbers::pi) / kDegree; }

Campaign campaign_of(const std::string& text, std::uint64_t seed = 5) {
  return read_campaign(TomlFile("name = \"c\"\n" + text, "c.toml"), &seed);
}

constexpr const char* kArm =
    "methods = [\"directional\", \"harmonic\"]\n[sweep]\nperiods_s = [5.0]\nheights_cm = [100.0]\nduration_s "
    "= 80.0\n"
    "repeats = 1\nramp_periods = 1\nrest_before_s = 5.0\n";
constexpr const char* kMagnetometer = "[sensor]\nmagnetometer = \"MAG3110\"\n";

// CDIP's wheel: within 2 degrees, check factor up to 1.05 below 10 s, 1.15 below 15 s, 1.5 above.
TEST(DirectionalCampaign, TellsThePlaneOfTheArmWithinTwoDegreesInFourPlacementsFromTwoToTwentySeconds) {
  Campaign campaign =
      read_campaign(std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig/campaigns/directional.toml");
  campaign.settings.methods = {"directional"};
  campaign.settings.sweep.profile.steady_s = 240;
  campaign.settings.sweep.settings = {{2, 0.6}, {6.25, 1.8}, {12.5, 1.8}, {20, 1.8}};
  const auto runs = runs_of(campaign, "directional");
  ASSERT_EQ(runs.size(), 16u);
  for (const evaluation::RunResult& run : runs) {
    ASSERT_EQ(run.seas.size(), 1u) << run.run;
    const evaluation::JudgedSea& sea = run.seas[0];
    EXPECT_LT(std::abs(wrapped_deg(sea.sea.mean_direction_rad - (17 + 90 * run.repeat) * kDegree)), 2)
        << run.run;
    EXPECT_LT(std::abs(wrapped_deg(sea.direction.mean_direction_rad - (17 + 90 * run.repeat) * kDegree)), 0.1)
        << run.run;
    EXPECT_NEAR(sea.direction.check_factor, 1, 1e-3) << run.run;
    EXPECT_GT(sea.sea.check_factor, 0.985) << run.run;
    EXPECT_LT(sea.sea.check_factor, run.period_s < 10 ? 1.05 : run.period_s < 15 ? 1.15 : 1.5) << run.run;
  }
  const auto cells = evaluation::cells_of(runs);
  ASSERT_FALSE(cells.empty());
  EXPECT_TRUE(std::isnan(cells[0].sea.sea.mean_direction_rad)) << "four placements all round have no mean";
  EXPECT_LT(cells[0].direction_rmse_rad, 2 * kDegree);
}

TEST(DirectionalCampaign, MeasuresShortCrestedSeasWithinOneDegreeAndTheirSpreadWithinTwo) {
  for (const char* sea : {"spreading_s = 10.0\ndirection_from_deg = 250.0\n",
                          "spreading_s = 4.0\ndirection_from_deg = 40.0\n"}) {
    const Campaign campaign =
        campaign_of(std::string("methods = [\"directional\"]\n[sweep]\nmotion = \"jonswap\"\nperiods_s = "
                                "[8.0]\nheights_cm = [150.0]\n"
                                "duration_s = 1200.0\nrepeats = 1\n[place]\ndeclination_deg = "
                                "-8.5\n[sea]\nheading_deg = 70.0\n") +
                    sea + kMagnetometer);
    const auto runs = runs_of(campaign, "directional");
    ASSERT_EQ(runs.size(), 1u);
    ASSERT_EQ(runs[0].seas.size(), 1u);
    const evaluation::JudgedSea& judged = runs[0].seas[0];
    EXPECT_LT(std::abs(judged.direction_error_rad()), 1 * kDegree) << sea;
    EXPECT_LT(std::abs(judged.sea.spread_rad - judged.direction.spread_rad), 2 * kDegree) << sea;
    EXPECT_LT(std::abs(wrapped_deg(judged.direction.mean_direction_rad -
                                   campaign.settings.sweep.sea.direction_from_rad)),
              3)
        << "the record of a short-crested sea, against the endless one";
    std::printf("sea from %.1f: record %.2f, told %.2f; spread of the record %.2f, told %.2f deg\n",
                campaign.settings.sweep.sea.direction_from_rad / kDegree,
                judged.direction.mean_direction_rad / kDegree, judged.sea.mean_direction_rad / kDegree,
                judged.direction.spread_rad / kDegree, judged.sea.spread_rad / kDegree);
  }
}

// Of one board, its iron drawn from the seed, and the arm at that azimuth.
Campaign campaign_of_board(int board, double azimuth_rad, const char* compass) {
  return campaign_of(std::string(kArm) + "[rig]\narm_azimuth_deg = " + std::to_string(azimuth_rad / kDegree) +
                         "\n" + kMagnetometer + "board_iron_uT = 2.0\n[calibration]\ncompass = \"" + compass +
                         "\"\n",
                     100 + static_cast<std::uint64_t>(board));
}

// What a compass shows too much at that heading, by its unit's drawn iron.
double heading_error_rad(const CampaignSettings& campaign, double azimuth_rad) {
  const MagnetometerSettings part = *unit_settings(campaign).magnetometer;
  const MagnetometerParameters iron = fresh_unit(campaign).magnetometer;
  const Euler& mounting = campaign.arm.mounting;
  const estimator::Tilt tilt{mounting.roll_rad, mounting.pitch_rad};
  const double heading_rad = azimuth_rad + mounting.yaw_rad;
  const Vector3d shown_uT =
      iron.soft_iron * (part.earth.total_uT * estimator::field_B(heading_rad, part.earth.dip_rad, tilt)) +
      iron.hard_iron_uT;
  return std::remainder(estimator::heading_rad(shown_uT, tilt) - heading_rad, 2 * std::numbers::pi);
}

void expect_as_budget(const char* what, double square_rad2, int boards,
                      const estimator::CompassKnowledge& knowledge, double dip_rad) {
  const double rms_deg = std::sqrt(square_rad2 / boards) / kDegree;
  const double budget_deg = estimator::direction_budget(knowledge, dip_rad).total_rad() / kDegree;
  std::printf("%s: %.2f deg rms over %d boards, budget %.2f deg\n", what, rms_deg, boards, budget_deg);
  EXPECT_NEAR(rms_deg, budget_deg, 0.4 * budget_deg) << what;  // 16 boards: 18 % standard deviation
}

// Uncalibrated, a compass turns all directions by what its board's iron does at its heading; over boards as
// much as the budget says. Calibrated, what is left is the gyroscope's axes.
TEST(DirectionalCampaign, IsOffAsTheBudgetSaysWithAnUncalibratedCompassAndWithACalibratedOne) {
  double by_iron = 0, left = 0;
  constexpr int kBoards = 16;
  for (int board = 0; board < kBoards; ++board) {
    const double azimuth_rad = 2 * std::numbers::pi / kBoards * board;
    const Campaign without = campaign_of_board(board, azimuth_rad, "none"),
                   with = campaign_of_board(board, azimuth_rad, "ellipsoid");
    const double uncalibrated_rad = runs_of(without, "directional").at(0).seas.at(0).direction_error_rad();
    const double calibrated_rad = runs_of(with, "directional").at(0).seas.at(0).direction_error_rad();
    EXPECT_NEAR(wrapped_deg(uncalibrated_rad - calibrated_rad),
                heading_error_rad(without.settings, azimuth_rad) / kDegree, 0.25)
        << "board " << board;
    by_iron += uncalibrated_rad * uncalibrated_rad;
    left += calibrated_rad * calibrated_rad;
  }
  const UnitSettings unit = unit_settings(campaign_of_board(0, 0, "none").settings);
  const MagnetometerSettings& part = *unit.magnetometer;
  estimator::CompassKnowledge knowledge{.gyro_misalignment_sigma_rad = unit.gyroscope.misalignment_sigma};
  expect_as_budget("calibrated", left, kBoards, knowledge, part.earth.dip_rad);
  knowledge.hard_iron_sigma = part.hard_iron_sigma_uT / part.earth.total_uT;
  knowledge.soft_iron_sigma = std::hypot(part.soft_iron_sigma, part.scale_sigma) / std::numbers::sqrt2;
  expect_as_budget("uncalibrated", by_iron, kBoards, knowledge, part.earth.dip_rad);
}

TEST(DirectionalCampaign, CalibratesTheCompassOnTheRigByBothMethodsSideBySide) {
  const Campaign campaign = campaign_of(std::string(kArm) + kMagnetometer);
  const CalibratedUnit calibrated = calibrate(campaign.settings);
  ASSERT_TRUE(calibrated.unit.calibration.compass);
  const estimator::CompassCalibration& applied = *calibrated.unit.calibration.compass;
  EXPECT_EQ(applied.method, "ellipsoid");
  EXPECT_LT(applied.residual.relative_std, 2e-3);
  const MagnetometerParameters iron = fresh_unit(campaign.settings).magnetometer;
  EXPECT_LT((applied.correction.offset - iron.hard_iron_uT).norm(), 0.1);
  EXPECT_NEAR(applied.dip_rad, campaign.settings.magnetic.field.dip_rad, 0.2 * kDegree);
  EXPECT_LT(level_heading_error_rad(applied.correction, iron, campaign.settings.magnetic.field),
            0.15 * kDegree);
  for (const char* key : {"\"max-min\"", "\"ellipsoid\"", "\"simulated_truth\"", "\"compass\""})
    EXPECT_NE(calibrated.report_json.find(key), std::string::npos) << key;
  // The file is what `waverig node acquisition --calibration` reads.
  const auto read = estimator::calibration_from_json(calibrated.report_json, "calibration.json");
  ASSERT_TRUE(read.compass);
  EXPECT_LT((read.compass->correction.gain - applied.correction.gain).norm(), 1e-12);
  EXPECT_LT((read.compass->correction.offset - applied.correction.offset).norm(), 1e-12);
}

TEST(DirectionalCampaign, TurnsAlongWithAWrongDeclination) {
  const std::string right = std::string(kArm) + "[place]\ndeclination_deg = -8.0\n" + kMagnetometer;
  const std::string wrong = std::string(kArm) +
                            "[place]\ndeclination_deg = -3.0\n[rig.field]\ndeclination_deg = -8.0\n" +
                            kMagnetometer;
  const auto a = runs_of(campaign_of(right), "directional"), b = runs_of(campaign_of(wrong), "directional");
  EXPECT_LT(std::abs(a.at(0).seas.at(0).direction_error_rad()), 1 * kDegree);
  EXPECT_NEAR(
      wrapped_deg(b.at(0).seas.at(0).sea.mean_direction_rad - a.at(0).seas.at(0).sea.mean_direction_rad), 5,
      1e-6);
}

// Calibration and method take gravity from a place of their own. All they measure is a multiple of it.
TEST(Place, AWrongOneScalesTheHeightsByTheRatioOfGravities) {
  const std::string here =
      std::string(kArm) + "[rig.place]\nlatitude_deg = 80.0\nheight_m = 0.0\n[place]\nheight_m = 0.0\n";
  const Campaign right = campaign_of(here + "latitude_deg = 80.0\n"),
                 wrong = campaign_of(here + "latitude_deg = 10.0\n");
  const double predicted = gravity_mps2(wrong.settings.place) / gravity_mps2(right.settings.place);
  ASSERT_LT(predicted, 0.996);
  const double a = runs_of(right, "harmonic").at(0).statistics.mean_height_m;
  const double b = runs_of(wrong, "harmonic").at(0).statistics.mean_height_m;
  std::printf("wrong place: heights %.4f %% off, predicted %.4f %%\n", 100 * (b / a - 1),
              100 * (predicted - 1));
  EXPECT_NEAR(b / a, predicted, 1e-4);
}

TEST(Magnetometer, ChangesNothingButDirection) {
  const auto with = runs_of(campaign_of(std::string(kArm) + kMagnetometer), "harmonic"),
             without = runs_of(campaign_of(kArm), "harmonic");
  EXPECT_EQ(with.at(0).statistics.mean_height_m, without.at(0).statistics.mean_height_m);
  EXPECT_EQ(with.at(0).statistics.std_m, without.at(0).statistics.std_m);
  EXPECT_TRUE(runs_of(campaign_of(kArm), "directional").empty()) << "no field, no direction";
  EXPECT_EQ(calibrate(campaign_of(kArm).settings).report_json.find("compass"), std::string::npos);
  EXPECT_EQ(evaluation::results_csv(evaluation::cells_of(without)).find("direction"), std::string::npos);
  const Campaign none =
      campaign_of(std::string(kArm) + "[place]\ndeclination_deg = 4.0\n[sensor]\nmagnetometer = \"none\"\n");
  EXPECT_EQ(none.settings.sensor.magnetometer, "none") << "its other keys may stay";
}

}  // namespace
}  // namespace waverig::rig
