#include "rig/frontend/charge_balance.h"

#include <gtest/gtest.h>

#include "motion/kinematics/random.h"

namespace waverig::rig {
namespace {

constexpr double kQuantum = 1e-7;

TEST(ChargeBalance, ConservesChargeToTheRemainderOfOneQuantum) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    RandomStream random(seed, "charge");
    ConverterChannelSettings s{kQuantum,
                               kQuantum,
                               random.gaussian(1e-2),
                               random.gaussian(1e-2),
                               random.gaussian(1e-6),
                               random.gaussian(1e-5),
                               0};
    ChargeBalanceConverter converter(s);
    const double K_P = kQuantum * (1 + s.positive_scale_error) / (1 + s.reset_clock_error);
    const double K_N = kQuantum * (1 + s.negative_scale_error) / (1 + s.reset_clock_error);
    double charge = 0, told = 0, time = 0;
    for (int k = 0; k < 2000; ++k) {
      const double current = 1e-3 * std::sin(0.01 * k) + random.gaussian(1e-4),
                   dt = random.uniform(1e-3, 2e-2);
      converter.integrate(current * dt, dt);
      charge += current * dt;
      time += dt;
      const ConverterCounts counts = converter.take();
      told += K_N * counts.negative - K_P * counts.positive;
      EXPECT_LT(std::abs(converter.remainder_C()), std::max(K_P, K_N));
      // i_SEN = K_N C_N - K_P C_P + i_AFbias, Kim eq. (1), summed over the time.
      EXPECT_NEAR(told + s.bias_A * time + converter.remainder_C(), charge, 1e-12);
    }
  }
}

TEST(ChargeBalance, CountsTheSameWhetherReadOftenOrSeldom) {
  ChargeBalanceConverter often({kQuantum, kQuantum}), seldom({kQuantum, kQuantum});
  std::int64_t sum = 0;
  for (int k = 0; k < 1000; ++k) {
    often.integrate(3.3e-7, 1e-3);
    seldom.integrate(3.3e-7, 1e-3);
    sum += often.take().negative;
  }
  EXPECT_LE(std::abs(sum - seldom.take().negative), 1);
  EXPECT_NEAR(static_cast<double>(sum), 3300, 1);
}

TEST(ChargeBalance, CountsEachPolarityWithItsOwnCurrent) {
  ConverterChannelSettings s{kQuantum, kQuantum, 0.1, -0.1};
  ChargeBalanceConverter positive_input(s), negative_input(s);
  positive_input.integrate(90e-7 + 1e-10, 1);
  negative_input.integrate(-110e-7 - 1e-10, 1);
  EXPECT_EQ(positive_input.take().negative, 100);
  EXPECT_EQ(negative_input.take().positive, 100);
}

TEST(ChargeBalance, SaysWhenTheResetCurrentCannotKeepUp) {
  ConverterChannelSettings s{kQuantum, kQuantum};
  s.largest_rate_Hz = 1000;
  ChargeBalanceConverter converter(s);
  converter.integrate(999.5 * kQuantum, 1);
  EXPECT_FALSE(converter.take().overloaded);
  converter.integrate(-1500 * kQuantum, 1);
  const ConverterCounts counts = converter.take();
  EXPECT_TRUE(counts.overloaded);
  EXPECT_EQ(counts.positive, 1000);
  converter.integrate(0, 1);  // what was beyond is lost, not paid back later
  EXPECT_LE(converter.take().positive, 1);
}

}  // namespace
}  // namespace waverig::rig
