#include "rig/nodes/recorder_node.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>
#include <waverig/imu_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/event_log.h"
#include "tests/campaign/temporary_directory.h"
#include "tests/lcmtypes/synced_files.h"

namespace waverig::rig {
namespace {

TEST(RecorderNode, NamesTheChannelOnWhichMessagesWereLost) {
  const TemporaryDirectory temporary;
  Bus bus;
  RecorderNode node(bus, temporary / "run.lcm");
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    if (seq == 4 || seq == 5) continue;
    imu_t m{};
    m.seq = seq;
    bus.publish(channel::kImu, m);
  }
  bus.publish_raw("SHORT", "x", 1);
  bus.drain();
  node.close();
  EXPECT_EQ(node.events(), 9);
  EXPECT_EQ(node.missing(), (std::map<std::string, std::int64_t>{{std::string(channel::kImu), 2}}));
}

// What reads event logs expects their times to grow, whoever said what when.
TEST(RecorderNode, ItsTimesGrowAndLcmsOwnTestIsNoPartOfIt) {
  const TemporaryDirectory temporary;
  Bus bus;
  RecorderNode node(bus, temporary / "run.lcm");
  bus.publish_raw("LCM_SELF_TEST", "lcm self test", 13);
  imu_t m{};
  for (const std::int64_t utime : {5, 3, 9}) {
    m.utime = utime;
    m.seq = utime;
    bus.publish(channel::kImu, m);
  }
  bus.drain();
  EXPECT_FALSE(std::filesystem::exists(temporary / "run.lcm")) << "not named before it is whole";
  node.close();
  EventLogReader log(temporary / "run.lcm");
  std::vector<std::int64_t> times, seqs;
  for (LogEvent event; log.next(event);) {
    ASSERT_TRUE(event.decode(m));
    times.push_back(event.utime);
    seqs.push_back(m.seq);
  }
  EXPECT_EQ(times, (std::vector<std::int64_t>{5, 5, 9}));
  EXPECT_EQ(seqs, (std::vector<std::int64_t>{5, 3, 9}));
}

// A resumed sweep believes a log that has its name.
TEST(RecorderNode, ALogIsOnTheDiskBeforeItHasItsName) {
  const TemporaryDirectory temporary;
  Bus bus;
  RecorderNode node(bus, temporary / "run.lcm");
  synced_files().clear();
  node.close();
  EXPECT_EQ(synced_files(), (std::vector<std::string>{temporary / "run.lcm.part", temporary.path()}));
}

}  // namespace
}  // namespace waverig::rig
