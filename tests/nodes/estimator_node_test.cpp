#include "rig/nodes/estimator_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>
#include <waverig/heave_t.hpp>
#include <waverig/imu_t.hpp>
#include <waverig/record_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/flags.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {
namespace {

class Samples {
 public:
  Samples() : node_(bus_, "realtime", {}) {
    bus_.subscribe<heave_t>(channel::of_method(channel::kHeavePrefix, "realtime"),
                            [this](const heave_t& m) { heave.push_back(m); });
  }
  void record(RecordAction action) {
    record_t m{};
    m.utime = utime_;
    m.action = static_cast<std::int32_t>(action);
    bus_.publish(channel::kRecord, m);
    bus_.drain();
  }
  // Samples of a gentle movement with these numbers; one every 10 ms, heard or not.
  void send(std::int64_t from, std::int64_t to) {
    for (std::int64_t seq = from; seq < to; ++seq) {
      imu_t m{};
      m.utime = utime_ += 10000;
      m.seq = seq;
      m.accel_mps2[2] = -9.80665 + 0.5 * std::sin(1e-6 * static_cast<double>(utime_));
      m.accel_mps2[0] = 0.01 * std::cos(1e-6 * static_cast<double>(utime_));
      m.temperature_degC = 20;
      m.flags = flag::kNoMagnetometer;
      bus_.publish(channel::kImu, m);
      bus_.drain();
    }
  }
  void lose(int samples) { utime_ += 10000 * samples; }
  const EstimatorNode& node() const { return node_; }
  std::vector<heave_t> heave;

 private:
  Bus bus_;
  EstimatorNode node_;
  std::int64_t utime_ = 1000000;
};

TEST(EstimatorNode, FlagsTheSampleAfterOnesThatWereLost) {
  Samples samples;
  samples.record(RecordAction::kBegin);
  samples.send(0, 500);
  samples.lose(1);
  samples.send(501, 1000);
  samples.record(RecordAction::kEnd);
  EXPECT_EQ(samples.node().samples(), 999);
  EXPECT_EQ(samples.node().samples_missing(), 1);
  ASSERT_EQ(samples.heave.size(), 999u);
  for (const heave_t& m : samples.heave) EXPECT_EQ((m.flags & flag::kGap) != 0, m.seq == 501) << m.seq;
}

TEST(EstimatorNode, LeavesOutWhatStillGoesOnWithTheOldCount) {
  Samples samples;
  samples.send(40, 60);
  samples.record(RecordAction::kBegin);
  samples.send(60, 62);  // the acquisition has not heard of the record yet
  samples.send(0, 100);
  samples.record(RecordAction::kEnd);
  ASSERT_EQ(samples.heave.size(), 100u);
  EXPECT_EQ(samples.heave.front().seq, 0);
  EXPECT_EQ(samples.node().samples_missing(), 0);
  EXPECT_EQ(samples.node().records(), 1);
}

TEST(EstimatorNode, NoticesThatARecordsFirstSamplesWereLost) {
  Samples samples;
  samples.send(40, 60);
  samples.record(RecordAction::kBegin);
  samples.send(3, 100);
  samples.record(RecordAction::kEnd);
  EXPECT_EQ(samples.node().samples(), 97);
  EXPECT_EQ(samples.node().samples_missing(), 3);
  ASSERT_EQ(samples.heave.size(), 97u);
  for (const heave_t& m : samples.heave) EXPECT_EQ((m.flags & flag::kGap) != 0, m.seq == 3) << m.seq;
}

TEST(EstimatorNode, TellsWhatItsMethodLeavesOut) {
  Samples samples;
  samples.record(RecordAction::kBegin);
  samples.send(0, 500);
  samples.lose(-100);  // the clock is set back by a second
  samples.send(500, 1000);
  samples.record(RecordAction::kEnd);
  EXPECT_EQ(samples.node().watch().left_out(), 100);
  EXPECT_NE(samples.node().watch().words().find("set back by 1.0 s?"), std::string::npos)
      << samples.node().watch().words();
}

TEST(EstimatorNode, ServesRecordAfterRecord) {
  Samples samples;
  for (int i = 0; i < 3; ++i) {
    samples.record(RecordAction::kBegin);
    samples.send(0, 50);
    samples.record(RecordAction::kEnd);
    samples.send(50, 60);
  }
  EXPECT_EQ(samples.node().records(), 3);
  EXPECT_EQ(samples.node().samples(), 150);
  EXPECT_EQ(samples.node().watch().words(), "") << "what lies between two records is no gap in either";
  EXPECT_EQ(samples.heave.size(), 150u);
}

}  // namespace
}  // namespace waverig::rig
