#include "estimator/compass/heading.h"

#include <gtest/gtest.h>

#include "motion/kinematics/random.h"

namespace waverig::estimator {
namespace {

constexpr double kDip = 50 * kDegree;

struct Attitude {
  double heading_rad;
  Tilt tilt;
};

Attitude random_attitude(RandomStream& random, double largest_tilt_rad) {
  return {random.uniform(-3.1, 3.1),
          {random.uniform(-largest_tilt_rad, largest_tilt_rad),
           random.uniform(-largest_tilt_rad, largest_tilt_rad)}};
}

TEST(Tilt, IsReadFromTheSpecificForceOfABodyAtRest) {
  RandomStream random(1, "heading");
  for (int i = 0; i < 200; ++i) {
    const Attitude a = random_attitude(random, 1.5);
    const Quaterniond q_NB = quaternion_of({a.tilt.roll_rad, a.tilt.pitch_rad, a.heading_rad});
    const Vector3d f_B = q_NB.conjugate() * Vector3d(0, 0, -kStandardGravity);
    const Tilt tilt = tilt_of(triad_of(f_B));
    EXPECT_NEAR(tilt.roll_rad, a.tilt.roll_rad, 1e-12);
    EXPECT_NEAR(tilt.pitch_rad, a.tilt.pitch_rad, 1e-12);
  }
}

TEST(Heading, ComesOutForEveryAttitude) {
  RandomStream random(2, "heading");
  for (int i = 0; i < 500; ++i) {
    const Attitude a = random_attitude(random, 1.5);
    const Vector3d m_B = field_B(a.heading_rad, kDip, a.tilt);
    EXPECT_NEAR(m_B.norm(), 1, 1e-14);
    EXPECT_NEAR(heading_rad(m_B, a.tilt), a.heading_rad, 1e-12);
    EXPECT_NEAR(dip_rad(m_B, a.tilt), kDip, 1e-12);
  }
}

TEST(Heading, LevelledFieldIsEquation12) {
  RandomStream random(3, "heading");
  for (int i = 0; i < 100; ++i) {
    const Attitude a = random_attitude(random, 1.4);
    const Vector3d level = levelled_field(field_B(a.heading_rad, kDip, a.tilt), a.tilt);
    EXPECT_NEAR(level.x(), std::cos(a.heading_rad) * std::cos(kDip), 1e-14);
    EXPECT_NEAR(level.y(), -std::sin(a.heading_rad) * std::cos(kDip), 1e-14);
    EXPECT_NEAR(level.z(), std::sin(kDip), 1e-14);
  }
}

TEST(Heading, NeedsTheTiltOnceTheSensorIsNotLevel) {
  const Tilt tilt{20 * kDegree, 0};
  const Vector3d m_B = field_B(45 * kDegree, kDip, tilt);
  EXPECT_GT(std::abs(level_heading_rad(m_B.x(), m_B.y()) - 45 * kDegree), 10 * kDegree);
  const Vector3d level_B = field_B(45 * kDegree, kDip, {});
  EXPECT_NEAR(level_heading_rad(level_B.x(), level_B.y()), 45 * kDegree, 1e-14);
}

TEST(Heading, DeclinationTurnsMagneticIntoTrueOnceAndStaysInTheCircle) {
  EXPECT_NEAR(true_heading_rad(10 * kDegree, -8 * kDegree), 2 * kDegree, 1e-15);
  EXPECT_NEAR(true_heading_rad(175 * kDegree, 8 * kDegree), -177 * kDegree, 1e-14);
}

TEST(TwoAxisModule, ReconstructsZAndHeadingWithAKnownDip) {
  RandomStream random(4, "heading");
  int negative = 0;
  for (int i = 0; i < 500; ++i) {
    const Attitude a = random_attitude(random, 60 * kDegree);
    const Vector3d m_B = field_B(a.heading_rad, kDip, a.tilt);
    const TwoAxisHeading result = two_axis_heading(m_B.x(), m_B.y(), a.tilt, kDip, {});
    EXPECT_NEAR(result.z.z, m_B.z(), 1e-7);  // the root near zero costs half the digits
    EXPECT_NEAR(result.z.z_by_tilt, m_B.z(), 1e-12);
    EXPECT_NEAR(std::remainder(result.heading_rad - a.heading_rad, 2 * std::numbers::pi), 0, 1e-6);
    EXPECT_FALSE(result.z.sign_doubtful);
    negative += m_B.z() < 0;
  }
  EXPECT_GT(negative, 20);  // both signs were visited
}

TEST(TwoAxisModule, FlagsWhereTheTiltCannotDecideTheSign) {
  // Along the document's sweep z passes through zero; tilt known to 5.8 deg (0.1 g) and the dip to 0.1 deg.
  const TwoAxisSettings settings{
      .tilt_sigma_rad = 0.1, .dip_sigma_rad = 0.1 * kDegree, .field_sigma = 1e-3, .guard = 2.5};
  RandomStream random(5, "heading");
  int wrong = 0, wrong_unflagged = 0, flagged = 0, total = 0;
  for (double tilt_deg = -50; tilt_deg <= 50; tilt_deg += 0.25) {
    const Tilt tilt{tilt_deg * kDegree, tilt_deg * kDegree};
    const Vector3d m_B = field_B(45 * kDegree, kDip, tilt);
    for (int i = 0; i < 20; ++i, ++total) {
      const Tilt seen{tilt.roll_rad + random.gaussian(0.1), tilt.pitch_rad + random.gaussian(0.1)};
      const ReconstructedZ z = reconstruct_z(m_B.x(), m_B.y(), seen, kDip, settings);
      const bool sign_wrong = z.z * m_B.z() < 0 && std::abs(m_B.z()) > 1e-9;
      wrong += sign_wrong;
      wrong_unflagged += sign_wrong && !z.sign_doubtful;
      flagged += z.sign_doubtful;
    }
  }
  EXPECT_GT(wrong, total / 200);           // it does happen
  EXPECT_LT(wrong_unflagged, wrong / 20);  // and is announced
  EXPECT_LT(flagged, total / 2);           // without crying wolf all the way
}

TEST(TwoAxisModule, OffersTheOtherHeadingWhereTheSignIsDoubtful) {
  const Tilt tilt{30 * kDegree, 20 * kDegree};
  const Vector3d m_B = field_B(1.0, kDip, tilt);
  const TwoAxisHeading result = two_axis_heading(m_B.x(), m_B.y(), tilt, kDip, {});
  EXPECT_NEAR(result.other_heading_rad, heading_rad({m_B.x(), m_B.y(), -m_B.z()}, tilt), 1e-7);
}

TEST(TwoAxisModule, SaysSoWhereXAndYAreLongerThanTheField) {
  const ReconstructedZ z = reconstruct_z(0.9, 0.5, {}, kDip, {});
  EXPECT_TRUE(z.beyond_unit);
  EXPECT_EQ(z.z, 0);
}

TEST(Dip, IsEstimatedFromALevelTurn) {
  for (double heading = -3; heading < 3; heading += 0.5) {
    const Vector3d m_B = field_B(heading, kDip, {});
    EXPECT_NEAR(level_dip_rad(m_B.x(), m_B.y()), kDip, 1e-12);
  }
  EXPECT_EQ(level_dip_rad(1, 0.1), 0);
}

}  // namespace
}  // namespace waverig::estimator
