#include "lcmtypes/event_log.h"

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <waverig/imu_t.hpp>

#include "lcmtypes/error.h"

namespace waverig {
namespace {

class EventLog : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::temp_directory_path() /
            ("waverig_log_" + std::to_string(::getpid()) + "_" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".lcm");
    EventLogWriter writer(path_);
    imu_t message{};
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
    for (message.seq = 0; message.seq < kEvents; ++message.seq) {
      message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
      writer.write(1000 * message.seq, "IMU", bytes.data(), bytes.size());
    }
    writer.close();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  static constexpr std::int64_t kEvents = 10;
  std::filesystem::path path_;
};

TEST_F(EventLog, ReadsBackWhatWasWritten) {
  EventLogReader reader(path_);
  LogEvent event;
  imu_t message{};
  std::int64_t n = 0;
  while (reader.next(event)) {
    EXPECT_EQ(event.channel, "IMU");
    EXPECT_EQ(event.utime, 1000 * n);
    ASSERT_TRUE(event.decode(message));
    EXPECT_EQ(message.seq, n++);
  }
  EXPECT_EQ(n, kEvents);
}

TEST_F(EventLog, IsReadByTheStockLibraryToo) {
  lcm::LogFile stock(path_.string(), "r");
  ASSERT_TRUE(stock.good());
  std::int64_t n = 0;
  while (const lcm::LogEvent* event = stock.readNextEvent()) {
    EXPECT_EQ(event->eventnum, n);
    EXPECT_EQ(event->timestamp, 1000 * n++);
    EXPECT_EQ(event->channel, "IMU");
  }
  EXPECT_EQ(n, kEvents);
}

TEST_F(EventLog, TellsATruncatedLogFromAWholeOneAtEveryLength) {
  const auto size = std::filesystem::file_size(path_);
  const auto event_size = size / kEvents;
  for (auto cut = size - 1; cut > size - event_size; --cut) {
    std::filesystem::resize_file(path_, cut);
    EventLogReader reader(path_);
    LogEvent event;
    EXPECT_THROW({ while (reader.next(event)) {} }, UserError) << cut;
  }
}

// Event: sync, number, time, length of the channel's name at byte 20, of the data at byte 24.
TEST_F(EventLog, RefusesAnImplausibleLengthInsteadOfAllocatingIt) {
  const auto size = static_cast<long>(std::filesystem::file_size(path_) / kEvents);
  for (const long place : {24L, 20L, size}) {  // and no sync word where the second event begins
    SetUp();
    std::FILE* file = std::fopen(path_.c_str(), "r+b");
    std::fseek(file, place, SEEK_SET);
    const unsigned char huge[4] = {0x7f, 0xff, 0xff, 0xff};
    std::fwrite(huge, 1, 4, file);
    std::fclose(file);
    EventLogReader reader(path_);
    LogEvent event;
    try {
      while (reader.next(event)) {
      }
      FAIL() << place;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(place == size ? "sync word missing" : "not plausible"), std::string::npos)
          << error.what();
    }
  }
}

TEST(EventLogWriter, SaysWhereTheDiskDidNotTakeEverything) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EventLogWriter writer("/dev/full");
  writer.write(0, "IMU", "data", 4);
  EXPECT_THROW(writer.close(), std::runtime_error);
}

}  // namespace
}  // namespace waverig
