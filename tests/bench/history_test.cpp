// The history keeps what was measured, and tells drift from uncertainty.
#include "rig/bench/history.h"

#include <gtest/gtest.h>

#include "lcmtypes/error.h"
#include "tests/bench/in_memory_bench.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

using estimator::FrontEndCalibration;

// One channel of one unit, measured by a laboratory of its own seed.
FrontEndCalibration measure(const UnitTruth& unit, int channel, std::uint64_t laboratory) {
  InMemoryBench bench(laboratory);
  bench.unit = unit;
  std::vector<estimator::ScaleFactorsAtTemperature> points;
  for (const double T : kTemperatures_degC) {
    bench.set_temperature(T);
    points.push_back({T, estimator::scale_factors_by_calibrator(bench.settings(channel), knowledge_of(channel))});
  }
  FrontEndCalibration calibration;
  calibration.id = "unit-scale_factor";
  calibration.measured = "2024-01-01T00:00:00Z";
  calibration.unit = "unit";
  calibration.procedure = "scale_factor";
  auto& found = calibration.channels.emplace_back();
  found.name = channel_name(channel);
  found.K_N0_C = found.K_P0_C = unit.channels[static_cast<std::size_t>(channel)].K_N0_C;
  estimator::fit_scale_factor_laws(points, found);
  return calibration;
}

int significant(const std::vector<Drift>& drifts) {
  return static_cast<int>(std::ranges::count_if(drifts, &Drift::significant));
}

TEST(Drift, OfAnUnchangedUnitIsRarelyCalledSignificantAndOfAChangedOneAlways) {
  int false_alarms = 0, found = 0, compared = 0;
  constexpr int kPairs = 100;
  for (std::uint64_t i = 1; i <= kPairs; ++i) {
    const UnitTruth unit = draw_unit({}, i);
    UnitTruth later = unit;
    later.channels[6].dsf_N[0] += 80e-6;
    const FrontEndCalibration first = measure(unit, 6, 1000 + i);
    const std::vector<Drift> same = compare(first, measure(unit, 6, 2000 + i), false);
    const std::vector<Drift> changed = compare(first, measure(later, 6, 3000 + i), false);
    ASSERT_EQ(same.size(), 2U);   // N and P
    compared += 2;
    false_alarms += significant(same);
    found += changed[0].significant();
    EXPECT_NEAR(changed[0].difference, 80e-6, 1.5 * changed[0].expanded);
    EXPECT_EQ(changed[0].quantity, Coefficient::kScaleN);
  }
  RecordProperty("false_alarms_percent", std::to_string(100.0 * false_alarms / compared));
  EXPECT_LE(false_alarms, 0.1 * compared);   // 5 % are expected; N and P of a pair go together
  EXPECT_EQ(found, kPairs);
}

TEST(Drift, IsSeenFinerWhereTheReferenceIsTheSame) {
  const UnitTruth unit = draw_unit({}, 5);
  UnitTruth later = unit;
  later.channels[6].dsf_P[0] += 12e-6;
  const FrontEndCalibration a = measure(unit, 6, 77), b = measure(later, 6, 77);
  EXPECT_FALSE(compare(a, b, false)[1].significant());
  const Drift fine = compare(a, b, true)[1];
  EXPECT_TRUE(fine.significant());
  EXPECT_LT(fine.expanded, 0.5 * compare(a, b, false)[1].expanded);
}

TEST(Drift, NeedsTwoCalibrationsOfOneUnitWithSomethingInCommon) {
  const FrontEndCalibration a = measure(draw_unit({}, 1), 6, 1);
  FrontEndCalibration other = a;
  other.unit = "another";
  EXPECT_THROW(compare(a, other, false), UserError);
  EXPECT_THROW(compare(a, measure(draw_unit({}, 1), 7, 1), false), UserError);   // another channel
}

TEST(History, KeepsEachCalibrationOnceAndNamesTheKnownOnes) {
  const TemporaryDirectory directory;
  const History history(directory / "calibrations");
  FrontEndCalibration a = measure(draw_unit({}, 1), 6, 1);
  EXPECT_EQ(history.keep(a), "unit-scale_factor");
  EXPECT_EQ(history.keep(a), "unit-scale_factor");
  FrontEndCalibration b = a;
  b.measured = "2023-01-01T00:00:00Z";
  EXPECT_EQ(history.keep(b), "unit-scale_factor-2");
  EXPECT_EQ(history.keep(b), "unit-scale_factor-2");
  const std::vector<FrontEndCalibration> all = history.all();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all.front().measured, "2023-01-01T00:00:00Z");   // in the order of measurement
  EXPECT_EQ(to_json(history.find("unit-scale_factor")), to_json(a));
  try {
    history.find("unit-bias");
    ADD_FAILURE() << "found what is not there";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("unit-scale_factor-2"), std::string::npos) << error.what();
  }
}

TEST(History, ThatIsNoHistoryIsAnError) {
  const TemporaryDirectory directory;
  EXPECT_THROW(History(directory / "none").all(), UserError);
  directory.write("broken.json", "{}");
  EXPECT_THROW(History(directory.path()).all(), UserError);
}

}  // namespace
}  // namespace waverig::rig::bench
