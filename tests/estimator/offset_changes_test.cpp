#include "estimator/heave/offset_changes.h"

#include <gtest/gtest.h>

#include "estimator/heave/record_smoother.h"
#include "tests/estimator/sea_record.h"

namespace waverig::testing {
namespace {

using estimator::OffsetChange;

std::vector<OffsetChange> found_in(const std::vector<estimator::ImuSample>& samples) {
  estimator::Record record;
  for (const auto& sample : samples) record.add(sample);
  return estimator::smooth_record(record, {}).offset_changes;
}

struct Step {
  double at_s, mps2;
};

void change_offset(SeaRecord& record, const Step& step) {
  for (auto i = static_cast<std::size_t>(100 * step.at_s); i < record.samples.size(); ++i)
    record.samples[i].f_B.z() -= step.mps2;
}

TEST(OffsetChanges, AreFoundWithTheirTimeAndSize) {
  for (const SeaCase& sea : {SeaCase{.tp_s = 3, .hm0_m = 0.5, .duration_s = 600}, {.tp_s = 8, .hm0_m = 1.5, .duration_s = 900}})
    for (const std::uint64_t seed : {1, 2}) {
      SeaRecord record = sea_record(sea, seed);
      const std::vector<Step> steps{{200, 0.2}, {400, -0.1}};
      for (const Step& step : steps) change_offset(record, step);
      const auto found = found_in(record.samples);
      ASSERT_EQ(found.size(), steps.size()) << sea.tp_s << " s, seed " << seed;
      for (std::size_t i = 0; i < steps.size(); ++i) {
        EXPECT_NEAR(found[i].mps2, steps[i].mps2, 0.01);
        EXPECT_NEAR(static_cast<double>(found[i].utime) * kMicrosecond - 1, steps[i].at_s, 1);
      }
    }
}

struct Told : estimator::Output {
  std::vector<OffsetChange> changes;
  void offset_change(const OffsetChange& change) override { changes.push_back(change); }
};

TEST(OffsetChanges, AreToldByTheMethodsThatTakeThemOff) {
  SeaRecord record = sea_record({.tp_s = 3, .hm0_m = 0.5, .duration_s = 300}, 1);
  change_offset(record, {150, 0.2});
  for (const char* name : {"smoothed", "spectral"}) {
    const auto method = estimator::make_method(name, {});
    Told told;
    for (const auto& sample : record.samples) method->add(sample, told);
    method->finish(told);
    ASSERT_EQ(told.changes.size(), 1U) << name;
    EXPECT_NEAR(told.changes[0].mps2, 0.2, 0.01) << name;
  }
}

// Neither the lowest waves of a heavy sea, nor a rest, nor a sea that comes up or dies away.
TEST(OffsetChanges, AreNotFoundWhereThereAreNone) {
  for (const SeaCase& sea : {SeaCase{.tp_s = 3, .hm0_m = 0.5}, {.tp_s = 8, .hm0_m = 4}, {.tp_s = 12, .hm0_m = 4},
                             {.tp_s = 20, .hm0_m = 8}, {.tp_s = 20, .hm0_m = 8, .duration_s = 300}})
    for (const std::uint64_t seed : {1, 2})
      EXPECT_TRUE(found_in(sea_record(sea, seed).samples).empty()) << sea.tp_s << " s, seed " << seed;
  const SeaCase run{.tp_s = 9, .hm0_m = 2, .duration_s = 60};
  EXPECT_TRUE(found_in(runs_and_rests(run, run, 60, 5, 1).record.samples).empty());
  const SeaCase low{.tp_s = 5, .hm0_m = 0.3, .duration_s = 600}, high{.tp_s = 14, .hm0_m = 5, .duration_s = 600};
  EXPECT_TRUE(found_in(changing_record(low, high, 300, 30, 1).samples).empty());
  EXPECT_TRUE(found_in(changing_record(high, low, 300, 30, 1).samples).empty());
}


// The instant is looked for at nodes a quarter of a second apart, however plain the change is.
TEST(OffsetChanges, StateWhenWithinASigmaThatHolds) {
  for (const double at_s : {300.0, 300.06, 300.12, 300.19})
    for (const double mps2 : {0.1, 1.0, 3.0}) {
      SeaRecord record = sea_record({.tp_s = 6, .hm0_m = 1, .duration_s = 600}, 3);
      change_offset(record, {at_s, mps2});
      const auto found = found_in(record.samples);
      ASSERT_EQ(found.size(), 1u) << at_s << " s, " << mps2;
      EXPECT_LT(std::abs(static_cast<double>(found[0].utime) * kMicrosecond - 1 - at_s), 2.5 * found[0].sigma_s)
          << at_s << " s, " << mps2 << " m/s2";
    }
}

}  // namespace
}  // namespace waverig::testing
