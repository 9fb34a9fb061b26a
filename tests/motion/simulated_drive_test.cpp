#include "motion/simulated_drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "lcmtypes/error.h"

namespace waverig::motion {
namespace {

using std::numbers::pi;

SimulatedDriveSettings frictionless() {
  return {.viscous_friction_Nms = 0, .coulomb_friction_Nm = 0, .unbalance_Nm = 0, .cogging_Nm = 0};
}

// Plays setpoints as a controller does, one period ahead.
class Player {
 public:
  explicit Player(SimulatedDrive& drive) : drive_(drive) {
    for (int i = 0; i < 3; ++i) {
      word_ = towards_operation(state_of(feedback_.statusword));
      if (i == 0) word_ = controlword::kShutdown;
      feedback_ = drive_.exchange({.controlword = word_, .mode = DriveMode::kCyclicPosition});
    }
    counts_per_rad_ = drive_.settings().counts_per_turn / (2 * pi);
    origin_ = feedback_.position;
  }
  DriveFeedback play(double angle_rad, double rate_radps) {
    feedback_ = drive_.exchange(
        {.controlword = controlword::kEnableOperation,
         .mode = DriveMode::kCyclicPosition,
         .target_position = origin_ + static_cast<std::int32_t>(std::lround(angle_rad * counts_per_rad_)),
         .target_velocity = static_cast<std::int32_t>(std::lround(rate_radps * counts_per_rad_))});
    drive_.advance(0.01);
    return feedback_;
  }
  const DriveFeedback& feedback() const { return feedback_; }

 private:
  SimulatedDrive& drive_;
  DriveFeedback feedback_;
  std::uint16_t word_ = 0;
  double counts_per_rad_ = 0;
  std::int32_t origin_ = 0;
};

TEST(SimulatedDrive, WithoutLoadFollowsASmoothMoveWithinAFewCounts) {
  SimulatedDrive drive(frictionless());
  Player player(drive);
  double worst = 0;
  for (int i = 1; i <= 2000; ++i) {
    const double t = 0.01 * i;
    player.play(1 - std::cos(t), std::sin(t));
    if (i > 100) worst = std::max(worst, std::abs(drive.shaft().angle_rad - (1 - std::cos(t))));
  }
  EXPECT_LT(worst, 20 * 2 * pi / drive.settings().counts_per_turn);
}

TEST(SimulatedDrive, AngleAndRateAreTheIntegralsOfTheAcceleration) {
  SimulatedDrive drive;
  Player player(drive);
  ShaftState last = drive.shaft();
  for (int i = 1; i <= 500; ++i) {
    drive.exchange({.controlword = controlword::kEnableOperation,
                    .target_position = 10000 * i,
                    .target_velocity = 1000000});
    for (int k = 0; k < 10; ++k) {
      drive.advance(0.001);
      const ShaftState now = drive.shaft();
      ASSERT_NEAR(now.rate_radps, last.rate_radps + 0.001 * now.accel_radps2, 1e-12);
      ASSERT_NEAR(now.angle_rad, last.angle_rad + 0.001 * 0.5 * (last.rate_radps + now.rate_radps), 1e-12);
      last = now;
    }
  }
}

TEST(SimulatedDrive, TorqueLimitBoundsTheAcceleration) {
  SimulatedDriveSettings settings = frictionless();
  settings.inertia_kgm2 = 10;
  settings.rated_torque_Nm = 20;
  settings.torque_limit_ratio = 1.5;
  settings.following_window_rad = 100;
  SimulatedDrive drive(settings);
  Player player(drive);
  bool limited = false;
  double most = 0;
  for (int i = 1; i < 50; ++i) {
    const auto feedback = player.play(0.3 * i, 5);
    limited = limited || (feedback.statusword & statusword::kInternalLimit) != 0;
    most = std::max(most, drive.shaft().accel_radps2);
  }
  EXPECT_TRUE(limited);
  EXPECT_NEAR(most, 3, 1e-9);  // 30 Nm on 10 kg m^2
}

TEST(SimulatedDrive, TurningSteadilyItsTorqueIsThatOfFriction) {
  SimulatedDriveSettings settings = frictionless();
  settings.viscous_friction_Nms = 2;
  settings.coulomb_friction_Nm = 3;
  SimulatedDrive drive(settings);
  Player player(drive);
  for (int i = 1; i <= 1000; ++i)
    player.play(i < 100 ? 1e-4 * i * i : 1 + 0.02 * (i - 100), i < 100 ? 0.02 * i : 2);
  EXPECT_NEAR(player.feedback().torque_permille, 1e3 * (3 + 2 * 2) / settings.rated_torque_Nm, 2);
}

// The weight pulls most where the arm lies level.
TEST(SimulatedDrive, HoldingAnUnbalancedArmTakesItsWeightTimesTheCosine) {
  for (const double angle_rad : {0.0, 1.0, 0.5 * pi, pi}) {
    SimulatedDriveSettings settings = frictionless();
    settings.unbalance_Nm = 20;
    settings.initial_angle_rad = angle_rad;
    SimulatedDrive drive(settings);
    Player player(drive);
    for (int i = 1; i <= 500; ++i) player.play(0, 0);
    EXPECT_NEAR(1e-3 * player.feedback().torque_permille * settings.rated_torque_Nm, 20 * std::cos(angle_rad),
                0.2);
  }
}

TEST(SimulatedDrive, ATargetRateBeyondItsOwnLimitIsNotFollowed) {
  SimulatedDriveSettings settings = frictionless();
  settings.rate_limit_radps = 2;
  settings.following_window_rad = 100;
  SimulatedDrive drive(settings);
  Player player(drive);
  double fastest = 0;
  for (int i = 1; i <= 300; ++i) {
    player.play(0.01 * i, 9);
    fastest = std::max(fastest, drive.shaft().rate_radps);
  }
  EXPECT_LT(fastest, 2.2);
}

TEST(SimulatedDrive, AResetFaultTakesItsErrorCodeAlong) {
  SimulatedDrive drive;
  drive.faults.error_code = 0x2310;
  drive.advance(0.01);
  EXPECT_EQ(drive.exchange({}).error_code, 0x2310);
  const DriveFeedback reset = drive.exchange({.controlword = controlword::kFaultReset});
  EXPECT_EQ(state_of(reset.statusword), DriveState::kSwitchOnDisabled);
  EXPECT_EQ(reset.error_code, 0);
}

TEST(SimulatedDrive, CoggingRipplesTheRateOnceATooth) {
  SimulatedDriveSettings settings = frictionless();
  settings.cogging_Nm = 0.5;
  settings.cogging_per_turn = 60;
  SimulatedDrive drive(settings);
  Player player(drive);
  const double w = 2 * pi / 6;
  // Acceleration of the shaft projected on the tooth frequency, over whole turns.
  double c = 0, s = 0;
  int n = 0;
  for (int i = 1; i <= 2400; ++i) {
    const double t = 0.01 * i, ramp = std::min(1.0, t / 2);
    player.play(w * (t < 2 ? 0.5 * t * t / 2 : t - 1), w * ramp);
    if (i > 1200) {
      c += drive.shaft().accel_radps2 * std::cos(60 * drive.shaft().angle_rad);
      s += drive.shaft().accel_radps2 * std::sin(60 * drive.shaft().angle_rad);
      ++n;
    }
  }
  // At 10 Hz the loops take back a part of 0.5 Nm / 8 kg m^2, never all and never none of it.
  const double amplitude = 2 * std::hypot(c, s) / n;
  EXPECT_GT(amplitude, 0.3 * 0.5 / 8);
  EXPECT_LT(amplitude, 1.6 * 0.5 / 8);
}

TEST(SimulatedDrive, BrakeHoldsAnUnbalancedArmWhileTheDriveIsOff) {
  SimulatedDrive drive({.unbalance_Nm = 50, .initial_angle_rad = 0.3});
  drive.advance(10);
  EXPECT_EQ(drive.shaft().angle_rad, 0.3);
}

TEST(SimulatedDrive, WatchdogStopsTheArmWhenTheControllerIsGone) {
  SimulatedDrive drive;
  Player player(drive);
  for (int i = 1; i <= 300; ++i) player.play(0.005 * i * i * 0.01, 0.01 * i);
  ASSERT_GT(drive.shaft().rate_radps, 2);
  drive.advance(0.08);
  EXPECT_EQ(drive.state(), DriveState::kOperationEnabled);
  drive.advance(2);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(drive.shaft().rate_radps, 0);
  EXPECT_EQ(drive.exchange({}).error_code, 0x8130);
}

TEST(SimulatedDrive, FollowingWindowFaultsWhenTheArmJams) {
  SimulatedDrive drive;
  Player player(drive);
  for (int i = 1; i <= 200; ++i) player.play(0.005 * i * i * 0.01, 0.01 * i);
  drive.faults.jam_Nm = 1000;
  for (int i = 201; i <= 400; ++i) player.play(0.005 * i * i * 0.01, 0.01 * i);
  EXPECT_EQ(drive.state(), DriveState::kFault);
  EXPECT_EQ(player.feedback().error_code, 0x8611);
}

TEST(SimulatedDrive, PositionCountsWrapAtThirtyTwoBitsAndTheArmTurnsOn) {
  SimulatedDriveSettings settings = frictionless();
  settings.counts_per_turn = 1 << 28;  // wraps every 16 turns
  SimulatedDrive drive(settings);
  Player player(drive);
  const double counts_per_rad = settings.counts_per_turn / (2 * pi);
  const double rate = 5;
  double angle = 0, w = 0;
  for (int i = 1; i <= 4000; ++i) {
    const double next = std::min(rate, w + 0.02);
    angle += 0.5 * (w + next) * 0.01;
    w = next;
    const auto counts = static_cast<std::int64_t>(angle * counts_per_rad);
    drive.exchange({.controlword = controlword::kEnableOperation,
                    .target_position = static_cast<std::int32_t>(static_cast<std::uint32_t>(counts)),
                    .target_velocity = static_cast<std::int32_t>(w * counts_per_rad)});
    drive.advance(0.01);
  }
  EXPECT_GT(angle, 16 * 2 * pi);
  EXPECT_NEAR(drive.shaft().angle_rad, angle, 1e-4);
}

TEST(SimulatedDrive, SameSettingsGiveTheSameBits) {
  const auto record = [](std::uint64_t seed) {
    SimulatedDrive drive({.seed = seed});
    Player player(drive);
    std::vector<double> angles;
    for (int i = 1; i <= 500; ++i) {
      player.play(0.001 * i, 0.1);
      angles.push_back(drive.shaft().angle_rad);
    }
    return angles;
  };
  const auto a = record(7), b = record(7), c = record(8);
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
  EXPECT_NE(a, c);
}

TEST(SimulatedDrive, ItsClockRunsInAdvanceOnly) {
  SimulatedDrive drive({}, 5'000'000);
  for (int i = 0; i < 1000; ++i) drive.advance(0.01);
  drive.exchange({});
  EXPECT_EQ(drive.exchange({}).utime, 15'000'000);
}

TEST(SimulatedDrive, RefusesWhatMakesNoDrive) {
  EXPECT_THROW(SimulatedDrive({.inertia_kgm2 = 0}), UserError);
  EXPECT_THROW(SimulatedDrive({.inner_step_s = 0.1}), UserError);
  EXPECT_THROW(SimulatedDrive({.unbalance_Nm = 300}), UserError);  // more than the brake holds
}

}  // namespace
}  // namespace waverig::motion
