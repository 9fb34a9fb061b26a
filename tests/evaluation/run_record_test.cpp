#include "estimator/evaluation/run_record.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <waverig/run_t.hpp>
#include <waverig/truth_t.hpp>

#include "estimator/messages.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/error.h"
#include "lcmtypes/event_log.h"
#include "lcmtypes/phase.h"
#include "tests/evaluation/scratch.h"

namespace waverig::evaluation {
namespace {

template <class Message>
void put(EventLogWriter& log, std::string_view channel, const Message& message) {
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  log.write(message.utime, channel, bytes.data(), bytes.size());
}

std::filesystem::path write_log(const Scratch& scratch) {
  const auto path = scratch.path() / "p06_h060_r1.lcm";
  EventLogWriter log(path);
  run_t run{};
  run.period_s = 6;
  run.height_m = 0.6;
  run.repeat = 1;
  for (const auto& [phase, utime] :
       {std::pair{Phase::kRest, 0}, {Phase::kSteady, 100}, {Phase::kRampOut, 300}, {Phase::kStopped, 400}}) {
    run.utime = utime;
    run.phase = static_cast<std::int32_t>(phase);
    put(log, channel::kRun, run);
  }
  truth_t truth{};
  truth.utime = 150;
  truth.heave_m = 0.25;
  truth.quat_NB[0] = 1;
  put(log, channel::kTruth, truth);
  estimator::ImuSample sample;
  sample.utime = 151;
  sample.f_B = {0, 0, -9.8};
  put(log, channel::kImu, estimator::message_of(sample));
  estimator::HeaveSample heave;
  heave.utime = 152;
  heave.heave_m = 0.24;
  put(log, channel::of_method(channel::kHeavePrefix, "harmonic"), estimator::message_of(heave));
  estimator::Wave wave;
  wave.start_utime = 153;
  wave.height_m = 0.59;
  put(log, channel::of_method(channel::kWavePrefix, "somebody else's"), estimator::message_of(wave));
  put(log, "FOREIGN", estimator::message_of(wave));
  log.close();
  return path;
}

TEST(RunRecord, BringsBackWhatTheLogHolds) {
  const Scratch scratch;
  const RunRecord r = load_run(write_log(scratch));
  EXPECT_EQ(r.run, "p06_h060_r1");
  EXPECT_EQ(r.period_s, 6);
  EXPECT_EQ(r.height_m, 0.6);
  EXPECT_EQ(r.repeat, 1);
  EXPECT_EQ(r.steady_begin_utime, 100);
  EXPECT_EQ(r.steady_end_utime, 300);
  ASSERT_EQ(r.truth.size(), 1u);
  EXPECT_EQ(r.truth[0].heave_m, 0.25);
  ASSERT_EQ(r.imu.size(), 1u);
  EXPECT_EQ(r.imu[0].f_B, Vector3d(0, 0, -9.8));
  EXPECT_EQ(r.heave.at("harmonic").at(0).heave_m, 0.24);
  EXPECT_EQ(r.waves.at("somebody else's").at(0).height_m, 0.59);
}

TEST(RunRecord, RefusesALogCutAnywhere) {
  const Scratch scratch;
  const auto whole = Scratch::read(write_log(scratch));
  int refused = 0, cuts = 0;
  for (std::size_t size = 1; size < whole.size(); size += 37, ++cuts) {
    const auto cut = scratch.write("cut.lcm", whole.substr(0, size));
    try {
      load_run(cut);  // only a cut between two events leaves a whole log
    } catch (const UserError& error) {
      EXPECT_NE(std::string(error.what()).find("cut.lcm"), std::string::npos);
      ++refused;
    }
  }
  EXPECT_GE(refused, cuts - 1);
}

// As sea_t was: its fingerprint and its fields, numbered.
TEST(RunRecord, ReadsASeaFromBeforeItToldItsSystematicPart) {
  const Scratch scratch;
  const auto path = scratch.path() / "old.lcm";
  std::vector<std::uint8_t> bytes;
  const auto put_word = [&](std::uint64_t word, int size) {
    while (size-- > 0) bytes.push_back(static_cast<std::uint8_t>(word >> (8 * size)));
  };
  put_word(0xdc3a2afadee2b96f, 8);
  put_word(1, 8);
  put_word(2, 8);
  for (int field = 3; field <= 16; ++field) put_word(std::bit_cast<std::uint64_t>(1.0 * field), 8);
  put_word(17, 4);
  const auto write = [&] {
    EventLogWriter log(path);
    log.write(1, channel::of_method(channel::kSeaPrefix, "spectral"), bytes.data(), bytes.size());
    log.close();
  };
  write();
  const RunRecord record = load_run(path);
  ASSERT_EQ(record.seas.at("spectral").size(), 1u);
  const estimator::SeaState& sea = record.seas.at("spectral").front();
  EXPECT_EQ(sea.start_utime, 1);
  EXPECT_EQ(sea.seq, 2);
  EXPECT_EQ(sea.duration_s, 3);
  EXPECT_EQ(sea.hm0_m, 4);
  EXPECT_EQ(sea.hm0_sigma_m, 5);
  EXPECT_TRUE(std::isnan(sea.hm0_systematic_sigma_m)) << "all of hm0_sigma_m, as far as one knows";
  EXPECT_EQ(sea.tp_s, 6);
  EXPECT_EQ(sea.check_factor, 16);
  EXPECT_EQ(sea.flags, 17);
  bytes[0] = 0xdd;  // neither the one nor the other
  write();
  EXPECT_THROW(load_run(path), UserError);
}

TEST(RunRecord, RefusesAMessageOfAnotherType) {
  const Scratch scratch;
  const auto path = scratch.path() / "foreign.lcm";
  EventLogWriter log(path);
  put(log, channel::kTruth, estimator::message_of(estimator::Wave{}));
  log.close();
  try {
    load_run(path);
    FAIL() << "loaded";
  } catch (const UserError& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("foreign.lcm"), std::string::npos) << said;
    EXPECT_NE(said.find("WAVERIG_TRUTH"), std::string::npos) << said;
    EXPECT_NE(said.find("expected truth_t"), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace waverig::evaluation
