#include "rig/nodes/run_watch.h"

#include <gtest/gtest.h>

#include <cstring>
#include <waverig/alarm_t.hpp>
#include <waverig/heave_t.hpp>
#include <waverig/record_t.hpp>

#include "lcmtypes/channels.h"
#include "lcmtypes/phase.h"

namespace waverig::rig {
namespace {

class Heard {
 public:
  void record(RecordAction action, std::int64_t utime) {
    record_t m{};
    m.utime = utime;
    m.action = static_cast<std::int32_t>(action);
    bus_.publish(channel::kRecord, m);
    bus_.drain();
  }
  void heave(std::int64_t utime) {
    heave_t m{};
    m.utime = utime;
    bus_.publish("WAVERIG_HEAVE_someone", m);
    bus_.drain();
  }
  void alarm(std::int32_t severity, const char* text) {
    alarm_t m{};
    m.severity = severity;
    std::memcpy(m.text, text, std::strlen(text));
    bus_.publish(channel::kAlarm, m);
    bus_.drain();
  }

 private:
  Bus bus_;

 public:
  RunWatch watch{bus_};
};

TEST(RunWatch, CountsOnlyWhatIsSaidOfTheRecord) {
  Heard heard;
  heard.heave(1);
  EXPECT_EQ(heard.watch.estimates(), 0) << "no record yet";
  heard.record(RecordAction::kBegin, 10);
  heard.heave(11);
  heard.record(RecordAction::kEnd, 20);
  heard.heave(15);
  heard.heave(21);
  EXPECT_EQ(heard.watch.estimates(), 2) << "a method that never stops is not waited for";
}

TEST(RunWatch, AnEndWithoutABeginIsThatOfAnEarlierRecord) {
  Heard heard;
  heard.record(RecordAction::kEnd, 5);
  EXPECT_FALSE(heard.watch.ended());
  heard.record(RecordAction::kBegin, 10);
  EXPECT_TRUE(heard.watch.begun());
  heard.record(RecordAction::kEnd, 20);
  EXPECT_TRUE(heard.watch.ended());
}

TEST(RunWatch, KeepsTheFirstAlarmThatStoppedTheMotionAsOneLine) {
  Heard heard;
  heard.alarm(1, "a warning");
  EXPECT_EQ(heard.watch.stopped(), "");
  heard.alarm(2, "first\nalarm");
  heard.alarm(2, "second");
  EXPECT_EQ(heard.watch.stopped(), "first alarm");
}

}  // namespace
}  // namespace waverig::rig
