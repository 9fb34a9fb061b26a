#include "estimator/evaluation/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "estimator/evaluation/cells.h"
#include "lcmtypes/flags.h"
#include "motion/kinematics/random.h"

namespace waverig::evaluation {
namespace {

CellResult cell(double mean_m, double std_m, double expanded_m, const std::string& method = "m") {
  CellResult c;
  c.period_s = 6;
  c.height_m = 0.6;
  c.method = method;
  c.statistics.waves = 101;
  c.statistics.mean_height_m = mean_m;
  c.statistics.mean_true_height_m = 0.6;
  c.statistics.std_m = std_m;
  c.statistics.expanded_uncertainty_m = expanded_m;
  return c;
}

CellComparison compared(const CellResult& baseline, const CellResult& candidate) {
  return compare_cells(std::vector{baseline}, std::vector{candidate}).at(0);
}

TEST(Compare, FindsNothingInItself) {
  const auto c = compared(cell(0.61, 0.01, 0.002), cell(0.61, 0.01, 0.002));
  EXPECT_EQ(c.verdict, Verdict::kNotSignificant);
  EXPECT_FALSE(any_worse(std::vector{c}));
}

TEST(Compare, TellsBetterFromWorseBeyondTheStatedUncertainty) {
  // Standard uncertainty of the difference: hypot(2 mm, 2 mm) / 2 = 1.41 mm, significant from 2.83 mm.
  EXPECT_EQ(compared(cell(0.603, 0.01, 0.002), cell(0.6057, 0.01, 0.002)).mean_error_m.verdict,
            Verdict::kNotSignificant);
  EXPECT_EQ(compared(cell(0.603, 0.01, 0.002), cell(0.6059, 0.01, 0.002)).mean_error_m.verdict,
            Verdict::kWorse);
  EXPECT_EQ(compared(cell(0.6059, 0.01, 0.002), cell(0.603, 0.01, 0.002)).mean_error_m.verdict,
            Verdict::kBetter);
  // An error of the other sign is no worse.
  EXPECT_EQ(compared(cell(0.603, 0.01, 0.002), cell(0.597, 0.01, 0.002)).mean_error_m.verdict,
            Verdict::kNotSignificant);
}

TEST(Compare, JudgesTheScatterToo) {
  // Standard uncertainty of each: 10 mm / sqrt(200) = 0.71 mm; of the difference about 1 mm.
  EXPECT_EQ(compared(cell(0.6, 0.010, 0.002), cell(0.6, 0.0118, 0.002)).verdict, Verdict::kNotSignificant);
  EXPECT_EQ(compared(cell(0.6, 0.010, 0.002), cell(0.6, 0.0125, 0.002)).verdict, Verdict::kWorse);
  EXPECT_EQ(compared(cell(0.6, 0.0125, 0.002), cell(0.6, 0.010, 0.002)).verdict, Verdict::kBetter);
}

// The waves of a sea differ by nature: what counts is how far each was missed.
TEST(Compare, JudgesTheErrorOfSingleWavesOnSeas) {
  CellResult a = cell(0.6, 0.2, 0.002), b = cell(0.6, 0.1, 0.002);
  a.statistics.rmse_m = 0.01;
  b.statistics.rmse_m = 0.02;
  EXPECT_EQ(compared(a, b).std_m.verdict, Verdict::kBetter) << "regular waves";
  a.true_hm0_m = b.true_hm0_m = a.height_m;
  a.wave_rmse_sigma_m = b.wave_rmse_sigma_m = 0.001;
  a.wave_runs = b.wave_runs = 3;
  const CellComparison c = compared(a, b);
  EXPECT_EQ(c.std_m.verdict, Verdict::kWorse);
  EXPECT_EQ(c.std_m.baseline, 0.01);
  EXPECT_EQ(c.std_m.candidate, 0.02);
}

// A minute of a sea can be as lively as regular waves: what the results say counts, not the guess.
TEST(Compare, TakesTheMotionFromTheResultsWhereTheySayIt) {
  CellResult a = cell(0.6, 0.2, 0.002), b = cell(0.6, 0.1, 0.002);
  a.statistics.rmse_m = b.statistics.rmse_m = 0.01;
  a.true_hm0_m = 1.42 * a.height_m;
  b.true_hm0_m = 0.9 * b.height_m;
  a.motion = b.motion = Motion::kSea;
  EXPECT_EQ(compared(a, b).verdict, Verdict::kNotSignificant);
  a.motion = b.motion = Motion::kRegular;
  EXPECT_EQ(compared(a, b).std_m.verdict, Verdict::kBetter);
  a.motion = Motion::kUnknown;
  a.true_hm0_m = 1.21 * a.height_m;  // of a sea of one minute, in results of an older version
  EXPECT_TRUE(is_sea(a));
}

TEST(Compare, JudgesHm0OfASeaOfWavesEnough) {
  CellResult a = cell(0.6, 0.2, 0.002), b = a;
  a.motion = b.motion = Motion::kSea;
  a.statistics.rmse_m = b.statistics.rmse_m = 0.01;
  a.sea = {.sea = {.hm0_m = 1.005, .hm0_sigma_m = 0.003}, .true_hm0_m = 1};
  b.sea = {.sea = {.hm0_m = 0.98, .hm0_sigma_m = 0.004}, .true_hm0_m = 1};
  EXPECT_EQ(compared(a, b).hm0_error_m.verdict, Verdict::kWorse);  // 15 mm; 5 mm is one sigma
  EXPECT_EQ(compared(a, b).verdict, Verdict::kWorse);
  EXPECT_EQ(compared(b, a).verdict, Verdict::kBetter);
  b.sea.sea.hm0_m = 0.986;
  EXPECT_EQ(compared(a, b).verdict, Verdict::kNotSignificant);
  EXPECT_NE(comparison_table(std::vector{compared(a, b)}).find("Hm0 error cm"), std::string::npos);
  b.sea.sea.hm0_m = 0.5;
  b.sea.sea.flags = a.sea.sea.flags = flag::kTooFewWaves;
  EXPECT_EQ(compared(a, b).verdict, Verdict::kNotSignificant);
  const CellResult regular = cell(0.6, 0.01, 0.002);
  EXPECT_EQ(comparison_table(std::vector{compared(regular, regular)}).find("Hm0"), std::string::npos);
}

// Repeats of one sea, whose heave is missed by these rms.
struct Repeats {
  CellResult cell;
  std::vector<RunResult> runs;
  explicit Repeats(const std::vector<double>& rmse_m) : cell(evaluation::cell(0.6, 0.2, 0.002)) {
    cell.motion = Motion::kSea;
    cell.statistics.rmse_m = 0.01;
    double sum = 0;
    for (const double rmse : rmse_m) {
      RunResult run;
      run.period_s = cell.period_s;
      run.height_m = cell.height_m;
      run.method = cell.method;
      run.heave_rmse_m = rmse;
      runs.push_back(run);
      sum += rmse * rmse;
    }
    cell.heave_rmse_m = std::sqrt(sum / static_cast<double>(rmse_m.size()));
    tell_scatter(std::span(&cell, 1), runs);
  }
};

TEST(Compare, JudgesHeaveOfASeaByItsRepeats) {
  const Repeats a({0.010, 0.011, 0.012}), b({0.012, 0.013, 0.014}), c({0.020, 0.021, 0.022});
  EXPECT_NEAR(a.cell.heave_rmse_sigma_m, 0.001 / std::sqrt(3.0), 5e-6);
  // 2 mm are 2.4 standard uncertainties; of three repeats each it takes 2.9.
  EXPECT_EQ(compared(a.cell, b.cell).verdict, Verdict::kNotSignificant);
  EXPECT_EQ(compared(a.cell, c.cell).heave_rmse_m.verdict, Verdict::kWorse);
  EXPECT_EQ(compared(a.cell, c.cell).verdict, Verdict::kWorse);
  EXPECT_EQ(compared(c.cell, a.cell).verdict, Verdict::kBetter);
  const std::vector shown{compared(a.cell, c.cell)};
  EXPECT_NE(comparison_table(shown).find("heave rms cm"), std::string::npos) << comparison_table(shown);
  EXPECT_NE(comparison_csv(shown).find(",heave_rms_verdict\n"), std::string::npos) << comparison_csv(shown);
  EXPECT_NE(comparison_csv(shown).find(",worse\n"), std::string::npos) << comparison_csv(shown);
}

// One run says nothing of what the next would give: the others decide, as they did without it.
TEST(Compare, DoesNotJudgeHeaveOfASingleRun) {
  const Repeats one({0.010}), three({0.020, 0.021, 0.022});
  const CellComparison c = compared(one.cell, three.cell);
  EXPECT_EQ(c.heave_rmse_m.verdict, Verdict::kUnknown);
  EXPECT_EQ(c.heave_rmse_m.baseline, 0.010);
  EXPECT_EQ(c.verdict, Verdict::kNotSignificant);
}

// Repeats of one sea, whose single waves are missed by these rms.
CellResult of_waves(const std::vector<double>& rmse_m) {
  Repeats sea({0.01});
  RunResult run = sea.runs.front();
  sea.runs.clear();
  double sum = 0;
  for (const double rmse : rmse_m) {
    run.statistics.rmse_m = rmse;
    sea.runs.push_back(run);
    sum += rmse * rmse;
  }
  sea.cell.statistics.rmse_m = std::sqrt(sum / static_cast<double>(rmse_m.size()));
  tell_scatter(std::span(&sea.cell, 1), sea.runs);
  return sea.cell;
}

// The errors of neighbouring waves of a sea go together: a hundred waves are not a hundred numbers.
TEST(Compare, JudgesSingleWavesOfASeaByItsRepeats) {
  const CellResult a = of_waves({0.010, 0.011, 0.012}), b = of_waves({0.012, 0.013, 0.014}),
                   c = of_waves({0.020, 0.021, 0.022});
  EXPECT_EQ(compared(a, b).verdict, Verdict::kNotSignificant);  // 2.4 standard uncertainties, as above
  EXPECT_NEAR(compared(a, b).std_m.sigma, std::sqrt(2.0) * 0.001 / std::sqrt(3.0), 1e-5);
  EXPECT_EQ(compared(a, c).std_m.verdict, Verdict::kWorse);
  EXPECT_EQ(compared(a, c).verdict, Verdict::kWorse);
  EXPECT_EQ(compared(c, a).verdict, Verdict::kBetter);
}

TEST(Compare, DoesNotJudgeSingleWavesOfASingleRunOfASea) {
  const CellComparison c = compared(of_waves({0.010}), of_waves({0.020, 0.021, 0.022}));
  EXPECT_EQ(c.std_m.verdict, Verdict::kUnknown);
  EXPECT_EQ(c.std_m.baseline, 0.010);
  EXPECT_EQ(c.verdict, Verdict::kNotSignificant);
  CellResult lost = of_waves({0.010});
  lost.statistics.rmse_m = estimator::kUnknown;
  EXPECT_EQ(compared(of_waves({0.010}), lost).verdict, Verdict::kWorse) << "it says nothing any more";
}

TEST(Compare, SeldomCriesWolfOverSingleWavesOfASea) {
  RandomStream random(5, "waves");
  int wolves = 0;
  const int cells = 10000;
  for (int i = 0; i < cells; ++i) {
    const auto drawn = [&] {
      std::vector<double> rmse_m;
      for (int k = 0; k < 3; ++k) rmse_m.push_back(0.01 * (1 + random.gaussian(0.2)));
      return of_waves(rmse_m);
    };
    wolves += compared(drawn(), drawn()).verdict != Verdict::kNotSignificant ? 1 : 0;
  }
  EXPECT_LT(wolves, 0.055 * cells);
  EXPECT_GT(wolves, 0.015 * cells);
}

// Of one quality, by few repeats: no more than one in 22, as k = 2 promises; of two repeats fewer (Welch).
TEST(Compare, SeldomCriesWolfOverHeave) {
  RandomStream random(4, "heave");
  for (const int runs : {2, 3, 5}) {
    int wolves = 0;
    const int cells = 10000;
    for (int i = 0; i < cells; ++i) {
      const auto drawn = [&] {
        std::vector<double> rmse_m;
        for (int k = 0; k < runs; ++k) rmse_m.push_back(0.01 * (1 + random.gaussian(0.1)));
        return Repeats(rmse_m).cell;
      };
      wolves += compared(drawn(), drawn()).verdict != Verdict::kNotSignificant ? 1 : 0;
    }
    EXPECT_LT(wolves, 0.055 * cells) << runs;
    EXPECT_GT(wolves, 0.015 * cells) << runs;
  }
}

// Of a program that states no uncertainty nothing can be said but that it differs.
TEST(Compare, DoesNotJudgeByAnUncertaintyThatNobodyStates) {
  const CellResult a = cell(0.6, 0.01, estimator::kUnknown), b = cell(0.5, 0.01, estimator::kUnknown);
  EXPECT_EQ(compared(a, b).mean_error_m.verdict, Verdict::kUnknown);
  EXPECT_EQ(compared(a, b).verdict, Verdict::kUnknown);
  EXPECT_EQ(compared(a, a).verdict, Verdict::kNotSignificant);
  EXPECT_EQ(compared(a, cell(0.5, 0.02, estimator::kUnknown)).verdict, Verdict::kWorse) << "by its scatter";
}

TEST(Compare, IsWorseWhereEitherIsWorse) {
  EXPECT_EQ(compared(cell(0.62, 0.010, 0.002), cell(0.6, 0.02, 0.002)).verdict, Verdict::kWorse);
}

TEST(Compare, IsWorseWhereTheCandidateSaysNothing) {
  EXPECT_EQ(compared(cell(0.6, 0.01, 0.002), cell(estimator::kUnknown, 0.01, 0.002)).verdict,
            Verdict::kWorse);
}

TEST(Compare, MatchesCellsBySettingAndMethod) {
  const auto cells = compare_cells(std::vector{cell(0.6, 0.01, 0.002, "a"), cell(0.6, 0.01, 0.002, "b")},
                                   std::vector{cell(0.6, 0.01, 0.002, "c"), cell(0.6, 0.01, 0.002, "b")});
  ASSERT_EQ(cells.size(), 3u);
  EXPECT_EQ(cells[0].verdict, Verdict::kOnlyInBaseline);
  EXPECT_EQ(cells[1].verdict, Verdict::kNotSignificant);
  EXPECT_EQ(cells[2].verdict, Verdict::kOnlyInCandidate);
  EXPECT_FALSE(any_worse(cells));
  EXPECT_NE(comparison_csv(cells).find("\n6,60,b,not significant,0.0000,0.0000,"), std::string::npos)
      << comparison_csv(cells);
}

// Two campaigns of one and the same quality differ significantly in no more than one cell of ten: two tests a
// cell, each at k = 2.
TEST(Compare, SeldomCriesWolf) {
  RandomStream random(3, "compare");
  int wolves = 0;
  const int cells = 4000;
  for (int i = 0; i < cells; ++i) {
    const auto drawn = [&] {
      return cell(0.65 + random.gaussian(0.001), 0.01 * (1 + random.gaussian() / std::sqrt(200.0)), 0.002);
    };
    wolves += compared(drawn(), drawn()).verdict != Verdict::kNotSignificant ? 1 : 0;
  }
  EXPECT_LT(wolves, 0.11 * cells);
  EXPECT_GT(wolves, 0.07 * cells);
}

}  // namespace
}  // namespace waverig::evaluation
