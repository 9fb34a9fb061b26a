#include "motion/kinematics/earth.h"

#include <gtest/gtest.h>

#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"

namespace waverig {
namespace {

// WGS-84 normal gravity on the ellipsoid, Somigliana's closed form (NIMA TR8350.2, eq. (4-1)).
double somigliana_mps2(double latitude_rad) {
  const double s2 = std::pow(std::sin(latitude_rad), 2);
  return 9.7803253359 * (1 + 0.00193185265241 * s2) / std::sqrt(1 - 0.00669437999014 * s2);
}

Vector3d random_position_E(RandomStream& random) {
  const Place place{std::asin(random.uniform(-0.999, 0.999)), random.uniform(-3.14, 3.14),
                    random.uniform(-5e3, 4e5)};
  return position_E(place);
}

Vector3d negative_numeric_gradient(const Vector3d& r_E, const EarthConstants& earth) {
  Vector3d gradient;
  const double h = 2e3;  // m; sixth-order central difference: rounding and truncation both below 1e-10 of g
  for (int axis = 0; axis < 3; ++axis) {
    const auto U = [&](double k) {
      return gravitational_potential_m2ps2(r_E + k * h * Vector3d::Unit(axis), earth);
    };
    gradient[axis] = -(45 * (U(1) - U(-1)) - 9 * (U(2) - U(-2)) + (U(3) - U(-3))) / (60 * h);
  }
  return gradient;
}

TEST(Gravitation, IsTheNegativeGradientOfThePotential) {
  RandomStream random(1, "earth");
  for (const EarthConstants& earth : {kWgs84, kLeeHk}) {
    for (int i = 0; i < 200; ++i) {
      const Vector3d r_E = random_position_E(random);
      const Vector3d gamma = gravitation_E(r_E, earth);
      EXPECT_LT((gamma - negative_numeric_gradient(r_E, earth)).norm(), 1e-9 * gamma.norm());
    }
  }
}

TEST(Gravitation, PointsTowardsTheCentreAgainstThePrintedSignOfEquation9) {
  const Vector3d r_E = position_E({0.3, 0.4, 0});
  EXPECT_LT(gravitation_E(r_E).dot(r_E), 0);
}

TEST(Gravity, AgreesWithSomiglianaFromEquatorToPole) {
  for (int latitude_deg = -90; latitude_deg <= 90; latitude_deg += 5) {
    const double latitude_rad = latitude_deg * kDegree;
    EXPECT_NEAR(gravity_mps2({latitude_rad, 0.7, 0}), somigliana_mps2(latitude_rad), 4e-5) << latitude_deg;
  }
}

TEST(Gravity, TakesThePublishedValuesAtThreeLatitudes) {
  EXPECT_NEAR(gravity_mps2({0, 0, 0}), 9.78033, 4e-5);
  EXPECT_NEAR(gravity_mps2({45 * kDegree, 0, 0}), 9.80620, 4e-5);
  EXPECT_NEAR(gravity_mps2({90 * kDegree, 0, 0}), 9.83218, 4e-5);
}

TEST(Gravity, OfTheDocumentsConstantsIsThreePartsInTenThousandHigh) {
  EXPECT_NEAR(gravity_mps2({45 * kDegree, 0, 0}, kLeeHk), 9.8095, 1e-4);
  EXPECT_NEAR(kLeeHk.mu_m3ps2 / kWgs84.mu_m3ps2 - 1, 0.00034, 1e-5);
}

TEST(Gravity, AgreesWithGeographicLibAtHeightAndInDirection) {
  const GeographicLib::NormalGravity& oracle = GeographicLib::NormalGravity::WGS84();
  RandomStream random(2, "earth");
  for (int i = 0; i < 200; ++i) {
    const Place place{random.uniform(-1.57, 1.57), random.uniform(-3.1, 3.1), random.uniform(-500, 9000)};
    double north, up;
    oracle.Gravity(place.latitude_rad / kDegree, place.height_m, north, up);
    const Vector3d g_N = gravity_N(place);
    EXPECT_NEAR(g_N.z(), -up, 4e-5);
    EXPECT_NEAR(g_N.x(), north, 4e-5);
    EXPECT_NEAR(g_N.y(), 0, 1e-12);
  }
}

TEST(Gravity, WithTheNormalFieldsOwnJ4LeavesOnlyTheSixthDegree) {
  EarthConstants normal = kWgs84;
  normal.J2 = 1082.629821e-6;
  normal.J4 = -2.37091222e-6;  // of the ellipsoid; the true Earth's differs, which is the 4e-5 m/s^2 above
  for (int latitude_deg = -90; latitude_deg <= 90; latitude_deg += 5) {
    const double latitude_rad = latitude_deg * kDegree;
    EXPECT_NEAR(gravity_mps2({latitude_rad, 0, 0}, normal), somigliana_mps2(latitude_rad), 6e-7);
  }
}

TEST(Place, BecomesTheSameEarthFixedPositionAsGeographicLibs) {
  RandomStream random(3, "earth");
  for (int i = 0; i < 100; ++i) {
    const Place place{random.uniform(-1.57, 1.57), random.uniform(-3.1, 3.1), random.uniform(-500, 9000)};
    double x, y, z;
    GeographicLib::Geocentric::WGS84().Forward(place.latitude_rad / kDegree, place.longitude_rad / kDegree,
                                               place.height_m, x, y, z);
    EXPECT_LT((position_E(place) - Vector3d(x, y, z)).norm(), 1e-6);
  }
}

TEST(LocalEarth, TurnsWithTheEarthRateSeenFromN) {
  const LocalEarth local = local_earth({30 * kDegree, 1.0, 100});
  EXPECT_NEAR(local.w_ie_N.norm(), 7.292115e-5, 1e-18);
  EXPECT_LT((local.w_ie_N - R_NE({30 * kDegree, 1.0, 0}) * Vector3d(0, 0, 7.292115e-5)).norm(), 1e-18);
}

TEST(LocalEarth, RefusesThePolesAndNonsense) {
  EXPECT_THROW(local_earth({90 * kDegree, 0, 0}), UserError);
  EXPECT_THROW(local_earth({std::nan(""), 0, 0}), UserError);
}

// Eq. (28) against Newton's law in the inertial frame: a body carried along a parallel at constant speed.
TEST(VelocityEquation, HoldsForUniformTravelAlongAParallel) {
  const Place place{50 * kDegree, 0, 2000};
  const LocalEarth local = local_earth(place);
  const double v_east = 250;  // m/s
  const Vector3d r_E = position_E(place);
  const double rho = r_E.x();
  const double rate = kWgs84.rate_radps + v_east / rho;  // inertial angular rate about the axis
  const Vector3d acceleration_E(-rate * rate * rho, 0, 0);
  const Vector3d f_N = R_NE(place) * (acceleration_E - gravitation_E(r_E));
  EXPECT_LT(velocity_rate_N(local, f_N, {0, v_east, 0}).norm(), 1e-9);
}

TEST(VelocityEquation, HoldsForTravelAlongAMeridian) {
  const LocalEarth local = local_earth({0, 0, 0});
  const double v_north = 100;
  // Centripetal acceleration points down, so the support carries less; Coriolis vanishes at the equator.
  const Vector3d f_N = -local.g_N + Vector3d(0, 0, v_north * v_north / local.north_radius_m);
  EXPECT_LT(velocity_rate_N(local, f_N, {v_north, 0, 0}).norm(), 1e-12);
}

TEST(IdealSensors, FeelGravityUpwardsAndTheEarthRateAtRest) {
  const LocalEarth local = local_earth({-35 * kDegree, 0, 50});
  BodyMotion rest;
  rest.q_NB = quaternion_of({0.1, -0.2, 2.0});
  EXPECT_LT((rest.q_NB * specific_force_B(rest, local) + local.g_N).norm(), 1e-14);
  EXPECT_LT((rest.q_NB * inertial_rate_B(rest, local) - local.w_ie_N).norm(), 1e-18);
}

TEST(IdealSensors, CarriedAlongAParallelTurnWithItAboutTheEarthsAxis) {
  const Place place{50 * kDegree, 0.3, 2000};
  const LocalEarth local = local_earth(place);
  BodyMotion travel;
  travel.velocity_N = Vector3d(0, 250, 0);
  const double rate = kWgs84.rate_radps + 250 / position_E(place).head<2>().norm();
  EXPECT_LT((inertial_rate_B(travel, local) - R_NE(place) * Vector3d(0, 0, rate)).norm(), 1e-15);
}

TEST(IdealSensors, FeelNothingInFreeFall) {
  const LocalEarth local = local_earth({45 * kDegree, 0, 0});
  BodyMotion fall;
  fall.acceleration_N = local.g_N;
  EXPECT_LT(specific_force_B(fall, local).norm(), 1e-14);
}

TEST(IdealSensors, InvertTheVelocityEquation) {
  const LocalEarth local = local_earth({60 * kDegree, 0, 0});
  RandomStream random(4, "earth");
  for (int i = 0; i < 50; ++i) {
    BodyMotion motion;
    motion.q_NB = quaternion_of({random.gaussian(), random.gaussian(), random.gaussian()});
    motion.velocity_N = Vector3d(random.gaussian(), random.gaussian(), random.gaussian()) * 10;
    motion.acceleration_N = Vector3d(random.gaussian(), random.gaussian(), random.gaussian());
    const Vector3d f_N = motion.q_NB * specific_force_B(motion, local);
    EXPECT_LT((velocity_rate_N(local, f_N, motion.velocity_N) - motion.acceleration_N).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace waverig
