#include "motion/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lcmtypes/error.h"
#include "motion/kinematics/frames.h"

namespace waverig::motion {
namespace {

TEST(Spectrum, IntegratesToTheOrderedHeight) {
  for (const auto shape : {SpectrumShape::kJonswap, SpectrumShape::kPiersonMoskowitz}) {
    const WaveSpectrum spectrum(shape, 2, 9, 3.3);
    EXPECT_NEAR(4 * std::sqrt(spectrum.variance_between(0, 3)), 2, 1e-3);
  }
}

// Closed form: S = 5/16 H^2 fp^4 f^-5 exp(-5/4 (fp/f)^4).
TEST(Spectrum, PiersonMoskowitzIsTheClosedForm) {
  const double h = 1.7, fp = 1 / 7.0;
  const WaveSpectrum spectrum(SpectrumShape::kPiersonMoskowitz, h, 1 / fp, 3.3);
  for (double f = 0.08; f < 0.8; f += 0.03) {
    const double closed =
        5.0 / 16 * h * h * std::pow(fp, 4) * std::pow(f, -5) * std::exp(-1.25 * std::pow(fp / f, 4));
    EXPECT_NEAR(spectrum.density(f), closed, 1e-5 * closed + 1e-12) << f;
  }
}

TEST(Spectrum, JonswapPeaksGammaTimesHigherThanItsBase) {
  const WaveSpectrum jonswap(SpectrumShape::kJonswap, 1, 8, 3.3), base(SpectrumShape::kJonswap, 1, 8, 1);
  const double far = 0.5;  // Hz, where the peak enhancement is nothing
  EXPECT_NEAR(jonswap.density(0.125) / jonswap.density(far) / (base.density(0.125) / base.density(far)), 3.3,
              1e-9);
}

TEST(Spectrum, SteepestSeasAreThoseOfDnv) {
  EXPECT_NEAR(largest_hm0_m(8), kStandardGravity * 64 / (2 * std::numbers::pi) / 15, 1e-9);
  EXPECT_NEAR(largest_hm0_m(15), kStandardGravity * 225 / (2 * std::numbers::pi) / 25, 1e-9);
  EXPECT_FALSE(too_steep(3, 0.5));
  ASSERT_TRUE(too_steep(3, 4));
  EXPECT_EQ(*too_steep(3, 4), "a sea of Tp = 3 s carries at most Hm0 = 0.936 m (DNV-RP-C205), not 4 m");
}

TEST(Spectrum, RefusesNonsense) {
  EXPECT_THROW(WaveSpectrum(SpectrumShape::kJonswap, 0, 8, 3.3), UserError);
  EXPECT_THROW(WaveSpectrum(SpectrumShape::kJonswap, 1, -8, 3.3), UserError);
  EXPECT_THROW(WaveSpectrum(SpectrumShape::kJonswap, 1, 8, 0.5), UserError);
}

}  // namespace
}  // namespace waverig::motion
