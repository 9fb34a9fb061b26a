#include "rig/nodes/recorder_node.h"

#include <gtest/gtest.h>

#include <waverig/imu_t.hpp>

#include "lcmtypes/channels.h"
#include "tests/campaign/temporary_directory.h"

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

}  // namespace
}  // namespace waverig::rig
