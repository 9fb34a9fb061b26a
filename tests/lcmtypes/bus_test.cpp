#include "lcmtypes/bus.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <waverig/heave_t.hpp>
#include <waverig/imu_t.hpp>

#include "lcmtypes/error.h"

namespace waverig {
namespace {

TEST(Bus, DeliversEveryMessageOfABurstInOrder) {
  Bus bus;
  std::int64_t expected = 0;
  bus.subscribe<imu_t>("IMU", [&](const imu_t& m) { EXPECT_EQ(m.seq, expected++); });
  imu_t message{};
  for (message.seq = 0; message.seq < 1000; ++message.seq) bus.publish("IMU", message);
  EXPECT_EQ(bus.drain(), 1000);
  EXPECT_EQ(expected, 1000);
}

TEST(Bus, TakesAChannelNameLiterally) {
  Bus bus;
  int received = 0;
  bus.subscribe<imu_t>("A.B+", [&](const imu_t&) { ++received; });
  bus.publish("AxBB", imu_t{});
  bus.publish("A.B+", imu_t{});
  bus.drain();
  EXPECT_EQ(received, 1);
}

TEST(Bus, NeverDeliversAMessageOfAnotherTypeOrSize) {
  Bus bus;
  int received = 0;
  bus.subscribe<imu_t>("IMU", [&](const imu_t&) { ++received; });
  bus.publish("IMU", heave_t{});
  const char junk[3] = {1, 2, 3};
  bus.publish_raw("IMU", junk, sizeof junk);
  std::vector<std::uint8_t> wrong_fingerprint(static_cast<std::size_t>(imu_t{}.getEncodedSize()), 0);
  bus.publish_raw("IMU", wrong_fingerprint.data(), wrong_fingerprint.size());
  bus.drain();
  EXPECT_EQ(received, 0);
  EXPECT_EQ(bus.malformed(), 3);
}

TEST(Bus, CarriesAHandlersExceptionPastLcmAndGoesOn) {
  Bus bus;
  int received = 0;
  bus.subscribe<imu_t>("IMU", [&](const imu_t&) {
    if (++received == 1) throw std::runtime_error("first");
  });
  bus.publish("IMU", imu_t{});
  bus.publish("IMU", imu_t{});
  EXPECT_THROW(bus.handle(), std::runtime_error);
  EXPECT_TRUE(bus.handle());
  EXPECT_EQ(received, 2);
}

TEST(Bus, ReportsTheFirstOfTwoFailures) {
  Bus bus;
  bus.subscribe<imu_t>("IMU", [](const imu_t&) { throw std::runtime_error("first"); });
  bus.subscribe<imu_t>("IMU", [](const imu_t&) { throw std::runtime_error("second"); });
  bus.publish("IMU", imu_t{});
  try {
    bus.handle();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "first");
  }
}

// LCM's own default drops all but thirty that wait.
TEST(Bus, DropsNothingThatWaitsOnANetworkEither) {
  const std::string url = "udpm://239.255.76.67:" + std::to_string(20000 + ::getpid() % 20000) + "?ttl=0";
  std::unique_ptr<Bus> bus;
  try {
    bus = std::make_unique<Bus>(url);
  } catch (const UserError& error) {
    GTEST_SKIP() << error.what();
  }
  constexpr std::int64_t kBurst = 100;  // fits into the smallest socket buffer
  std::int64_t received = 0;
  bus->subscribe<imu_t>("IMU", [&](const imu_t& m) { EXPECT_EQ(m.seq, received++); });
  imu_t message{};
  for (message.seq = 0; message.seq < kBurst; ++message.seq) bus->publish("IMU", message);
  while (received < kBurst && bus->handle(5000)) {
  }
  EXPECT_EQ(received, kBurst);
}

TEST(Bus, AllowsPublishingInsideAHandler) {
  Bus bus;
  bool answered = false;
  bus.subscribe<imu_t>("IMU", [&](const imu_t&) { bus.publish("HEAVE", heave_t{}); });
  bus.subscribe<heave_t>("HEAVE", [&](const heave_t&) { answered = true; });
  bus.publish("IMU", imu_t{});
  bus.drain();
  EXPECT_TRUE(answered);
}

TEST(Bus, RefusesAnUnknownProviderWithASentence) { EXPECT_THROW(Bus("nonsense://"), UserError); }

}  // namespace
}  // namespace waverig
