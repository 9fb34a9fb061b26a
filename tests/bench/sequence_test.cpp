// What a sequence and a laboratory may say, and how long the shipped procedures take.
#include "rig/bench/sequence.h"

#include <gtest/gtest.h>

#include "lcmtypes/error.h"
#include "rig/bench/laboratory.h"
#include "tests/bench/short_sequence.h"

namespace waverig::rig::bench {
namespace {

constexpr double kHour = 3600;

TEST(Sequence, RefusesWhatCannotWorkWithOneSentence) {
  const std::vector<std::pair<std::pair<std::string, std::string>, std::string>> wrong = {
      {{"gyros = [\"gyro_2\"]", "gyros = [\"gyro_9\"]"}, "expected \"all\" or some of gyro_1"},
      {{"set = \"calibrator.range\"", "set = \"calibrater.range\""}, "expected INSTRUMENT.NAME with one of unit, calibrator"},
      {{"range = \"22 mA\", level = \"5 mA\"", "range = \"22 mA\", level = \"5 A\""}, "expected calibrator.current from 0 A to 2.2 A"},
      {{"value = \"{setting.level}\"", "value = \"{setting.levle}\""}, "expected one of {channel}"},
      {{"within = \"0.3 degC\"", "within = \"0.3 V\""}, "expected a number with a unit of degC"},
      {{"in = [\"accels\"]", "in = [\"accelerometers\"]"}, "expected the name of a list"},
      {{"do = \"accel_channel\"", "do = \"accel\""}, "expected the name of a block"},
      {{"poll = \"30 s\"", "pol = \"30 s\""}, "unknown key"},
      {{"value = \"on\"", "value = \"yes\""}, "expected one of off, on"},
      {{"title = \"Scale", "duration = \"3 h\"\ntitle = \"Scale"}, "expected the plan's own"},
      {{"title = \"Scale", "duration = \"-38 h\"\ntitle = \"Scale"}, "expected a time above 0"},
      {{"wait = \"5 s\"", "wait = \"1e30 s\""}, "wait = \"1e30 s\": expected a time that is not negative, of a year at most"},
      {{"wait = \"5 s\"", "wait = \"-5 s\""}, "wait = \"-5 s\": expected a time that is not negative, of a year at most"},
      {{"timeout = \"6 h\"", "timeout = \"-6 h\""}, "expected a time that is not negative, of a year at most"},
  };
  for (const auto& [change, expected] : wrong) {
    const ShortSequence files("scale_factor.toml", {change});
    try {
      load_sequence(files.file());
      ADD_FAILURE() << "took " << change.second;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("scale_factor.toml:"), std::string::npos) << error.what();
    }
  }
}

// What waits without an end for an answer would never come to the tear-down.
TEST(Sequence, AnInstrumentIsWaitedForAnHourAtMost) {
  for (const std::string timeout : {"-3 s", "0 s", "1e9 s"}) {
    const ShortSequence files("laboratory.toml", {{"[[instrument]]\n", "[[instrument]]\ntimeout = \"" + timeout + "\"\n"}});
    try {
      load_laboratory(files.file());
      ADD_FAILURE() << "took " << timeout;
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find("timeout = '" + timeout + "': expected a time above 0, of an hour at most"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(Sequence, TheShippedProceduresAreAsLongAsTheDocumentSays) {
  const std::filesystem::path shipped = std::filesystem::path(WAVERIG_SOURCE_DIR) / "rig" / "sequences";
  EXPECT_NEAR(load_sequence(shipped / "scale_factor.toml").expected_s(), 38 * kHour, 0.02 * 38 * kHour);
  EXPECT_NEAR(load_sequence(shipped / "scale_factor_dmm.toml").expected_s(), 27.6 * kHour, 0.02 * 27.6 * kHour);
  EXPECT_NEAR(load_sequence(shipped / "bias.toml").expected_s(), 25 * kHour, 0.02 * 25 * kHour);
}

}  // namespace
}  // namespace waverig::rig::bench
