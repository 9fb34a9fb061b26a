#include "render/figures/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/kinematics/random.h"
#include "tests/render/example_campaign.h"

namespace waverig::render {
namespace {

TEST(Welch, TellsTheDensityOfWhiteNoise) {
  constexpr double kDensity = 0.01,
                   kInterval = 0.02;  // one-sided: variance of a sample = density^2 / (2 interval)
  RandomStream random(4, "welch");
  std::vector<double> values;
  for (int i = 0; i < 60000; ++i) values.push_back(random.gaussian(kDensity / std::sqrt(2 * kInterval)));
  const Spectrum s = welch(values, kInterval, 1024);
  double power = 0;
  for (std::size_t i = 2; i + 2 < s.density_rthz.size(); ++i) power += s.density_rthz[i] * s.density_rthz[i];
  EXPECT_NEAR(std::sqrt(power / static_cast<double>(s.density_rthz.size() - 4)), kDensity, 0.02 * kDensity);
  EXPECT_NEAR(s.frequency_hz.back(), 25, 1e-9);
}

TEST(Welch, PowerOfASineIsHalfItsAmplitudeSquared) {
  std::vector<double> values;
  for (int i = 0; i < 20000; ++i) values.push_back(3 * std::sin(2 * std::numbers::pi * 0.5 * i * 0.05));
  const Spectrum s = welch(values, 0.05, 2000);
  double power = 0;
  for (const double d : s.density_rthz) power += d * d * s.frequency_hz[0];
  EXPECT_NEAR(power, 4.5, 0.02);
}

TEST(Welch, GivesNothingForTooLittle) {
  EXPECT_TRUE(welch(std::vector<double>{1, 2, 3}, 0.1, 100).frequency_hz.empty());
  EXPECT_TRUE(welch({}, 0.1, 100).frequency_hz.empty());
}

TEST(Rest, IsWhatComesBeforeTheFirstMotion) {
  const RestRecords rest = rest_of(test::example_run());
  ASSERT_FALSE(rest.empty());
  EXPECT_NEAR(static_cast<double>(rest.specific_force_mps2[0].axes[2].size()) *
                  rest.specific_force_mps2[0].interval_s,
              20, 1.0);
}

TEST(Rest, EndsAtAGap) {
  evaluation::RunRecord run = test::example_run();
  run.imu.erase(run.imu.begin() + 400, run.imu.begin() + 420);
  const RestRecords rest = rest_of(run);
  EXPECT_EQ(rest.specific_force_mps2.at(0).axes[0].size(), 400U);
}

// harmonic tells no heave before its first wave, after its last, and at seams between two.
TEST(Spectra, AreOfTheHeaveAsFarAsItIsKnown) {
  evaluation::RunRecord run = test::example_run(12, 1.0, 240);
  const auto line_of = [&](const std::string& name) {
    const Figure figure = spectra_figure(run, kAuto, {});
    for (const Mark& mark : figure.panels.at(1).marks)
      if (const auto* line = std::get_if<Line>(&mark); line != nullptr && line->name == name) return *line;
    return Line{};
  };
  auto& heave = run.heave.at("harmonic");
  for (auto& sample : heave)
    if (sample.utime < run.steady_begin_utime + 7'000'000 || sample.utime > run.steady_end_utime - 3'000'000)
      sample.heave_m = estimator::kUnknown;
  heave[heave.size() / 2].heave_m = estimator::kUnknown;
  const Line told = line_of("harmonic"), truth = line_of("truth");
  ASSERT_FALSE(told.y.empty());
  EXPECT_NEAR(*std::ranges::max_element(told.y), *std::ranges::max_element(truth.y), 0.02);
  for (const double density : told.y) EXPECT_TRUE(std::isfinite(density));
  // Where nothing is known of the steady part, the figure says so.
  for (auto& sample : heave) sample.heave_m = estimator::kUnknown;
  std::string notes;
  const Figure figure = spectra_figure(run, kAuto, {});
  for (const Mark& mark : figure.panels.at(1).marks)
    if (const auto* note = std::get_if<Note>(&mark)) notes += note->text;
  EXPECT_EQ(notes, "no steady heave: harmonic");
}

// A short record has no ten periods; samples of a campaign without a calibration are not calibrated.
TEST(Spectra, SayWhatTheirBlocksAreAndAllanDeviationsOfWhat) {
  EXPECT_NE(spectra_figure(test::example_run(12, 1.0, 240), kAuto, {}).subtitle.find("blocks of 10 periods"),
            std::string::npos);
  const std::string brief = spectra_figure(test::example_run(12, 1.0, 48), kAuto, {}).subtitle;
  EXPECT_NE(brief.find("blocks of 4.0 periods"), std::string::npos) << brief;
  const RestRecords rest = rest_of(test::example_run());
  EXPECT_EQ(allan_figure(rest, true).subtitle.find("samples calibrated"), 0U);
  EXPECT_EQ(allan_figure(rest, false).subtitle.find("samples as recorded"), 0U);
}

}  // namespace
}  // namespace waverig::render
