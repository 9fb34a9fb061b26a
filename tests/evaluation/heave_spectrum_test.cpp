#include "estimator/evaluation/heave_spectrum.h"

#include <gtest/gtest.h>
#include <netcdf.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "estimator/evaluation/netcdf_file.h"
#include "estimator/evaluation/zero_crossing.h"
#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

struct Component {
  double amplitude_m, frequency_hz, phase_rad;
};

HeaveSeries series(const std::vector<Component>& components, double duration_s, double rate_hz) {
  HeaveSeries s;
  for (int i = 0; i < static_cast<int>(duration_s * rate_hz); ++i) {
    const double t = i / rate_hz;
    double h = 0.3 + 1e-4 * t;  // what is no sea
    for (const Component& c : components)
      h += c.amplitude_m * std::cos(kTwoPi * c.frequency_hz * t + c.phase_rad);
    s.utime.push_back(1'000'000'000'000 + std::llround(t * 1e6));
    s.heave_m.push_back(h);
    s.heave_sigma_m.push_back(estimator::kUnknown);
  }
  return s;
}

TEST(HeaveSpectrum, HoldsTheVarianceOfASineAtItsFrequency) {
  const HeaveSeries s = series({{0.8, 0.115, 0.3}}, 1800, 2.56);
  const HeaveSpectrum spectrum = spectrum_of(s.utime, s.heave_m);
  const estimator::SeaState sea = sea_of(spectrum);
  EXPECT_NEAR(sea.hm0_m, 4 * 0.8 / std::sqrt(2), 1e-3);
  EXPECT_NEAR(sea.tp_s, 1 / 0.115, 0.02);
  EXPECT_NEAR(sea.tm01_s, 1 / 0.115, 0.01);
  EXPECT_NEAR(sea.tm02_s, 1 / 0.115, 0.02);
  EXPECT_NEAR(spectrum.resolution_hz, 0.005, 1e-9);
}

// A median interval of nothing is no step of a grid: it would never end.
TEST(HeaveSpectrum, OfTimesThatDoNotGrowIsEmpty) {
  HeaveSeries s = series({{0.5, 0.1, 0}}, 60, 4);
  for (std::size_t i = 0; i < s.utime.size(); ++i) s.utime[i] = s.utime[i - i % 4];
  EXPECT_TRUE(spectrum_of(s.utime, s.heave_m).frequency_hz.empty());
}

// 249 s in blocks of 100: what happens in its last 45 s lies in one of them.
TEST(HeaveSpectrum, SeesARecordToItsEnd) {
  HeaveSeries s = series({{0.5, 0.1, 0}}, 249, 4);
  for (std::size_t i = 204 * 4; i < s.heave_m.size(); ++i)
    s.heave_m[i] = 0.5 * std::cos(kTwoPi * 0.25 * static_cast<double>(i) / 4);
  const HeaveSpectrum spectrum = spectrum_of(s.utime, s.heave_m, {.block_s = 100});
  double fast = 0, all = 0;
  for (std::size_t k = 0; k < spectrum.frequency_hz.size(); ++k) {
    all += spectrum.density_m2_per_hz[k];
    if (std::abs(spectrum.frequency_hz[k] - 0.25) < 0.05) fast += spectrum.density_m2_per_hz[k];
  }
  EXPECT_GT(fast / all, 0.05);
  EXPECT_LT(fast / all, 45.0 / 249);  // ends weigh less
}

// Six seconds of a wave of twelve look like a slope.
TEST(HeaveSpectrum, PiecesShorterThanTheLongestWaveTakeNothingOffTheHeight) {
  HeaveSeries s = series({{0.8, 1 / 12.0, 0.3}}, 1200, 4);
  for (std::size_t i = 600 * 4; i < s.heave_m.size(); ++i)
    if (i % 40 >= 24) s.heave_m[i] = std::numeric_limits<double>::quiet_NaN();  // six seconds of every ten are known
  const estimator::SeaState sea = sea_of(spectrum_of(s.utime, s.heave_m));
  EXPECT_NEAR(sea.hm0_m, 4 * 0.8 / std::sqrt(2), 0.01);
  EXPECT_TRUE(sea.flags & flag::kGap);
}

// A sea of known moments: 400 components, random phases; 2 % is what twenty minutes of such a sea scatter by.
TEST(HeaveSpectrum, TellsTheMomentsOfASea) {
  RandomStream random(7, "sea");
  std::vector<Component> components;
  double m0 = 0, m1 = 0, m2 = 0;
  for (int k = 0; k < 400; ++k) {
    const double f = 0.06 + 0.0008 * (k + random.uniform()),
                 a = 0.05 * std::exp(-std::pow((f - 0.12) / 0.05, 2));
    components.push_back({a, f, random.uniform(0, kTwoPi)});
    m0 += a * a / 2;
    m1 += f * a * a / 2;
    m2 += f * f * a * a / 2;
  }
  const HeaveSeries s = series(components, 2400, 4);
  const estimator::SeaState sea = sea_of(spectrum_of(s.utime, s.heave_m));
  EXPECT_NEAR(sea.hm0_m / (4 * std::sqrt(m0)), 1, 0.03);
  EXPECT_NEAR(sea.tm01_s / (m0 / m1), 1, 0.02);
  EXPECT_NEAR(sea.tm02_s / std::sqrt(m0 / m2), 1, 0.02);
}

TEST(HeaveSpectrum, BridgesGapsAndKnowsNothingOfTooLittle) {
  HeaveSeries s = series({{0.5, 0.1, 0}}, 600, 10);
  for (std::size_t i = 1000; i < 1005; ++i) s.heave_m[i] = estimator::kUnknown;
  EXPECT_NEAR(sea_of(spectrum_of(s.utime, s.heave_m)).hm0_m, 2 / std::sqrt(2), 2e-3);
  EXPECT_TRUE(spectrum_of({}, {}).frequency_hz.empty());
  s.utime.back() =
      std::numeric_limits<std::int64_t>::max() / 2;  // centuries of gap are no reason to fill memory
  EXPECT_NEAR(sea_of(spectrum_of(s.utime, s.heave_m)).hm0_m, 2 / std::sqrt(2), 2e-3);
  EXPECT_LT(spectrum_of(s.utime, s.heave_m).duration_s, 600);
  EXPECT_TRUE(spectrum_of(std::span(s.utime).first(15), std::span(s.heave_m).first(15)).frequency_hz.empty());
  EXPECT_TRUE(std::isnan(sea_of({}).hm0_m));
}

// Groups of waves that come where windows weigh little count as much as any other: Hm0 is that of the record.
TEST(HeaveSpectrum, CountsEveryPartOfTheRecordAlike) {
  for (const double duration_s : {150.0, 330.0, 1000.0}) {
    HeaveSeries s = series({}, duration_s, 4);
    double n = 0, sum = 0, squares = 0;
    for (std::size_t i = 0; i < s.heave_m.size(); ++i) {
      const double t = static_cast<double>(i) / 4;
      s.heave_m[i] = (1 + 3 * std::exp(-t / 20)) * std::cos(kTwoPi * 0.12 * t);
      n += 1;
      sum += s.heave_m[i];
      squares += s.heave_m[i] * s.heave_m[i];
    }
    const double hm0_m = 4 * std::sqrt(squares / n - sum * sum / (n * n));
    EXPECT_NEAR(sea_of(spectrum_of(s.utime, s.heave_m)).hm0_m / hm0_m, 1, 0.005) << duration_s;
  }
}

// The straight line over a gap is no sea: minutes that are missing do not lower Hm0, whether their rows are empty or
// not there, and the flag tells of them.
TEST(HeaveSpectrum, LeavesOutWhatIsMissing) {
  const HeaveSeries s = series({{0.5, 0.1, 0}}, 900, 10);
  EXPECT_EQ(sea_of(spectrum_of(s.utime, s.heave_m)).flags, 0);
  HeaveSeries empty = s, missing;
  for (std::size_t i = 0; i < s.utime.size(); ++i) {
    if (i > 2000 && i < 5000) {
      empty.heave_m[i] = estimator::kUnknown;
    } else {
      missing.utime.push_back(s.utime[i]);
      missing.heave_m.push_back(s.heave_m[i]);
    }
  }
  for (const HeaveSeries& gap : {empty, missing}) {
    const estimator::SeaState sea = sea_of(spectrum_of(gap.utime, gap.heave_m));
    EXPECT_NEAR(sea.hm0_m, 2 / std::sqrt(2), 5e-3);
    EXPECT_NEAR(sea.duration_s, 600, 1);
    EXPECT_EQ(sea.flags, flag::kGap);
  }
}

TEST(NetcdfFile, HoldsHeaveWavesSpectrumAndParametersForAnyReader) {
  const Scratch scratch;
  const HeaveSeries heave = series({{0.8, 0.115, 0.3}}, 600, 2.56);
  const auto waves = waves_of(count_waves(heave.utime, heave.heave_m));
  const HeaveSpectrum spectrum = spectrum_of(heave.utime, heave.heave_m);
  Summary summary = summary_of("zero-up-crossing", waves);
  take_sea(summary, std::vector{sea_of(spectrum)});
  const auto path = scratch.path() / "record.nc";
  write_netcdf(path, {heave, waves, spectrum, summary, "waverig test", "a sine"});

  int file = 0, variable = 0, dimension = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_NOWRITE, &file), NC_NOERR);
  std::size_t size = 0;
  ASSERT_EQ(nc_inq_dimid(file, "time", &dimension), NC_NOERR);
  nc_inq_dimlen(file, dimension, &size);
  EXPECT_EQ(size, heave.utime.size());
  std::vector<double> back(size);
  ASSERT_EQ(nc_inq_varid(file, "heave", &variable), NC_NOERR);
  ASSERT_EQ(nc_get_var_double(file, variable, back.data()), NC_NOERR);
  EXPECT_EQ(back, heave.heave_m);
  std::vector<long long> time(size);
  nc_inq_varid(file, "time", &variable);
  ASSERT_EQ(nc_get_var_longlong(file, variable, time.data()), NC_NOERR);
  EXPECT_EQ(time.back(), heave.utime.back());
  double hm0 = 0;
  ASSERT_EQ(nc_inq_varid(file, "hm0", &variable), NC_NOERR);
  nc_get_var_double(file, variable, &hm0);
  EXPECT_EQ(hm0, summary.hm0_m);
  char standard_name[64] = {};
  ASSERT_EQ(nc_get_att_text(file, variable, "standard_name", standard_name), NC_NOERR);
  EXPECT_STREQ(standard_name, "sea_surface_wave_significant_height");
  EXPECT_NE(nc_inq_varid(file, "mean_direction", &variable), NC_NOERR);  // unknown: not there
  nc_close(file);
}

TEST(NetcdfFile, LeavesNothingWhereItCannotBeWritten) {
  const Scratch scratch;
  const HeaveSeries heave = series({{0.8, 0.115, 0.3}}, 60, 2.56);
  const Summary summary;
  EXPECT_THROW(write_netcdf(scratch.path() / "no" / "record.nc", {heave, {}, {}, summary, "", ""}),
               std::runtime_error);
  EXPECT_TRUE(std::filesystem::is_empty(scratch.path()));
}

}  // namespace
}  // namespace waverig::evaluation
