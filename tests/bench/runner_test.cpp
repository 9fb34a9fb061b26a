// The bench over real transports in virtual time: whole runs, faults, and the safe end of each.
#include "rig/bench/runner.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <chrono>
#include <numeric>
#include <set>
#include <thread>
#include <tuple>

#include "lcmtypes/error.h"
#include "rig/bench/bench.h"
#include "rig/bench/frame_data.h"
#include "rig/bench/simulation/simulated_laboratory.h"
#include "tests/bench/short_sequence.h"

namespace waverig::rig::bench {
namespace {

SimulationSettings laboratory_with(std::vector<Fault> faults) {
  SimulationSettings settings;
  settings.faults = std::move(faults);
  return settings;
}

// A run in the open, so that the laboratory can be looked at afterwards.
struct OpenRun {
  ShortSequence files;
  Sequence sequence;
  VirtualTime time{1'704'067'200'000'000};
  SimulatedLaboratory laboratory;
  Reactor reactor{&time};
  Store store;

  explicit OpenRun(std::vector<Fault> faults = {}, const ShortSequence::Changes& changes = {}, const std::string& name = "scale_factor.toml",
                   const ShortSequence::Changes& of_laboratory = {})
      : files(name, changes),
        sequence((files.change("laboratory.toml", of_laboratory), load_sequence(files.file()))),
        laboratory(laboratory_with(std::move(faults)), sequence.laboratory, &time, time.now()),
        store(Store::create((std::filesystem::create_directories(files.out()), store_file(files.out())),
                            {sequence.title, sequence.procedure, "test", sequence.fingerprints, {}, time.now(), true, "running", {}})) {
    sequence.laboratory = laboratory.addressed();
  }
  std::string run() {
    Runner runner(sequence, reactor, store);
    std::string outcome = runner.run(false);
    reactor.sleep_until(reactor.now() + 5'000'000);
    return outcome;
  }
  bool safe() const { return std::abs(laboratory.source_A()) < 1e-12 && laboratory.chamber_target_degC() == 23; }
  std::vector<StepRow> failures() const {
    std::vector<StepRow> rows = store.steps();
    std::erase_if(rows, [](const StepRow& r) { return r.outcome == StepOutcome::kDone || r.outcome == StepOutcome::kMadeSafe; });
    return rows;
  }
};

constexpr double kWhileMeasuring = 6700;   // the first temperature has settled and its settings are under way

TEST(Runner, CarriesOutEveryPlannedStepOnceAndLeavesTheBenchSafe) {
  OpenRun run;
  EXPECT_EQ(run.run(), "done");
  EXPECT_TRUE(run.safe());
  const std::vector<StepRow> rows = run.store.steps();
  ASSERT_EQ(rows.size(), run.sequence.plan.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].index, static_cast<int>(i));
    EXPECT_EQ(rows[i].attempt, 1);
  }
  EXPECT_EQ(run.store.recordings().size(), 3U * (21 + 17));   // settings of Table 3 with their renewed zeros
  EXPECT_EQ(run.store.info().instruments.size(), 16U);
  const Analysis analysis = analyse(run.sequence, run.store);
  ASSERT_EQ(analysis.calibration.channels.size(), 2U);
  const UnitTruth truth = run.laboratory.unit_truth();
  for (const auto& [channel, index] : {std::pair{"gyro_2", 1}, {"accel_1", 6}}) {
    const ChannelTruth& t = truth.channels[static_cast<std::size_t>(index)];
    const auto& found = analysis.calibration.channel(channel);
    for (const double T : {5.0, 25.0, 45.0})   // 5 s instead of 100 s: a count is twenty times as coarse
      EXPECT_NEAR(found.dsf_N.at(T + truth.thermometer_offset_degC), cubic_at(t.dsf_N, T), 150e-6) << channel;
  }
}

TEST(Runner, KeepsEveryFrameOfAHundredHertzRecording) {
  OpenRun run;
  EXPECT_EQ(run.run(), "done");
  const auto sum = [](const std::vector<std::int32_t>& column) {
    return std::accumulate(column.begin(), column.end(), std::int64_t{0});
  };
  int kept = 0;
  for (const RecordingRow& row : run.store.recordings(true)) {
    EXPECT_EQ(row.ticks, 500);
    EXPECT_EQ(row.frames, 501);
    EXPECT_EQ(row.lost, 0);
    if (row.data.empty()) continue;
    ++kept;
    // Ticks, then N and P of each channel, from frame to frame.
    const std::vector<std::vector<std::int32_t>> columns = unpack_columns(row.data);
    ASSERT_EQ(columns.size(), 1 + 2 * row.channels.size());
    EXPECT_EQ(columns[0], std::vector<std::int32_t>(500, 1));
    for (std::size_t i = 0; i < row.channels.size(); ++i) {
      EXPECT_EQ(sum(columns[1 + 2 * i]), row.channels[i].N);
      EXPECT_EQ(sum(columns[2 + 2 * i]), row.channels[i].P);
    }
  }
  EXPECT_GT(kept, 0);
}

TEST(Runner, FramesBrokenAtFivePercentCostFramesButNoCharge) {
  OpenRun clean, broken({{"counts", FaultType::kCorrupt, 0, 1e12, 0.05}});
  EXPECT_EQ(clean.run(), "done");
  EXPECT_EQ(broken.run(), "done");
  const std::vector<RecordingRow> good = clean.store.recordings(), worse = broken.store.recordings();
  ASSERT_EQ(good.size(), worse.size());
  std::int64_t lost = 0, frames = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    lost += worse[i].lost;
    frames += worse[i].frames;
    // The totals in the frames that did arrive hold the charge of those that did not.
    const auto rate = [](const RecordingRow& r) {
      return static_cast<double>(r.channels[0].N - r.channels[0].P) / static_cast<double>(r.ticks);
    };
    EXPECT_NEAR(rate(worse[i]), rate(good[i]), 2e-4 * std::abs(rate(good[i])) + 1) << i;
  }
  EXPECT_NEAR(static_cast<double>(lost) / static_cast<double>(lost + frames), 0.05, 0.01);
}

TEST(Runner, TooManyLostFramesAreRetriedAndThenEndTheRun) {
  OpenRun run({{"counts", FaultType::kCorrupt, 0, 1e12, 0.3}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("counts: data lost"), std::string::npos) << outcome;
  EXPECT_EQ(run.failures().size(), 4U);   // one attempt and three retries
  EXPECT_TRUE(run.safe());
}

TEST(Runner, AHungInstrumentThatRecoversIsRetried) {
  OpenRun run({{"calibrator", FaultType::kHang, kWhileMeasuring, kWhileMeasuring + 12, 0}});
  EXPECT_EQ(run.run(), "done");
  ASSERT_FALSE(run.failures().empty());
  EXPECT_NE(run.failures().front().message.find("calibrator: no answer in time"), std::string::npos);
}

TEST(Runner, AnInstrumentThatHangsForGoodEndsTheRunByName) {
  OpenRun run({{"switch", FaultType::kHang, kWhileMeasuring, 1e12, 0}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("switch: no answer in time"), std::string::npos) << outcome;
  EXPECT_NE(outcome.find("scale_factor.toml:"), std::string::npos) << outcome;
  EXPECT_TRUE(run.safe());
}

TEST(Runner, AGatewayCutForAShortTimeIsRiddenOut) {
  OpenRun run({{"rack", FaultType::kDisappear, kWhileMeasuring, kWhileMeasuring + 10, 0}});
  EXPECT_EQ(run.run(), "done");
  ASSERT_FALSE(run.failures().empty());
  EXPECT_NE(run.failures().front().message.find("connection lost"), std::string::npos) << run.failures().front().message;
}

TEST(Runner, AChamberThatNeverSettlesEndsTheRun) {
  OpenRun run({{"chamber", FaultType::kHunt, 0, 1e12, 3.0}}, {{"timeout = \"6 h\"", "timeout = \"3 h\""}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("chamber: no answer in time: temperature"), std::string::npos) << outcome;
  EXPECT_TRUE(run.safe());
}

TEST(Runner, AnOutOfRangeReadingEndsTheRunBeforeAnythingElse) {
  OpenRun run({{"supply", FaultType::kWrong, 0, 1e12, 99.0}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("supply: out of range: voltage = 99 V"), std::string::npos) << outcome;
  EXPECT_TRUE(run.store.recordings().empty());
}

// As if the calibrator had not taken the level: what it says of it is something else.
TEST(Runner, ASettingThatReadsBackDifferentlyEndsTheRun) {
  OpenRun run({}, {}, "scale_factor.toml", {{"query = \"SOUR:CURR?\"", "query = \"SOUR:CURR:RANG?\""}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("current reads back"), std::string::npos) << outcome;
  EXPECT_TRUE(run.safe());
}

TEST(Runner, AnInstrumentsErrorQueueIsHeard) {
  OpenRun run({{"calibrator", FaultType::kError, kWhileMeasuring, 1e12, 0}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("calibrator: error reported: -300"), std::string::npos) << outcome;
}

TEST(Runner, AMissingInstrumentIsNamedBeforeTheFirstCommand) {
  OpenRun run({{"dmm_reference", FaultType::kDisappear, 0, 1e12, 0}});
  const std::string outcome = run.run();
  EXPECT_NE(outcome.find("dmm_reference: no answer in time"), std::string::npos) << outcome;
  EXPECT_TRUE(run.store.recordings().empty());
}

TEST(Runner, ASilentUnitIsNoticed) {
  OpenRun run({{"counts", FaultType::kSilent, kWhileMeasuring, 1e12, 0}});
  EXPECT_NE(run.run().find("counts: data lost"), std::string::npos);
}

TEST(Runner, StoppedByTheUserItEndsSafely) {
  OpenRun run;
  std::atomic<bool> stop{false};
  Reactor reactor(&run.time, &stop);
  RunnerHooks hooks;
  int steps = 0;
  hooks.progress = [&](const Progress&) { stop = ++steps == 60; };
  hooks.clear_stop = [&] { stop = false; };
  Runner runner(run.sequence, reactor, run.store, hooks);
  EXPECT_EQ(runner.run(false), "stopped by the user");
  reactor.sleep_until(reactor.now() + 5'000'000);
  EXPECT_TRUE(run.safe());
}

// Asked whether all is connected: by a user at the terminal, or as the sequence says where there is none.
TEST(Runner, APromptThatIsNotAnsweredWithYesEndsTheRun) {
  OpenRun asked, unattended({}, {{"unattended = \"continue\"", "unattended = \"abort\""}});
  RunnerHooks hooks;
  hooks.prompt = [](const PlannedStep&) { return false; };
  for (OpenRun* run : {&asked, &unattended}) {
    Runner runner(run->sequence, run->reactor, run->store, run == &asked ? hooks : RunnerHooks{});
    EXPECT_NE(runner.run(false).find("answered with no"), std::string::npos);
    run->reactor.sleep_until(run->reactor.now() + 5'000'000);
    EXPECT_TRUE(run->safe());
    EXPECT_TRUE(run->store.recordings().empty());
  }
}

TEST(Runner, AUserWhoStopsAgainAndAgainDoesNotStopTheSafeEnd) {
  OpenRun run;
  std::atomic<bool> stop{false};
  Reactor reactor(&run.time, &stop);
  RunnerHooks hooks;
  int steps = 0;
  hooks.progress = [&](const Progress&) { stop = ++steps >= 60; };   // nobody takes it back
  Runner runner(run.sequence, reactor, run.store, hooks);
  EXPECT_EQ(runner.run(false), "stopped by the user");
  reactor.sleep_until(reactor.now() + 5'000'000);
  EXPECT_TRUE(run.safe());
  for (const StepRow& row : run.store.steps()) EXPECT_NE(row.outcome, StepOutcome::kFailed) << row.what << ": " << row.message;
  EXPECT_EQ(run.store.steps().back().outcome, StepOutcome::kMadeSafe);
}

TEST(Runner, StoppedAtAnyMomentItEndsSafely) {
  RandomStream random(5, "stop");
  for (int i = 0; i < 10; ++i) {
    OpenRun run;
    std::atomic<bool> stop{false};
    Reactor reactor(&run.time, &stop);
    RunnerHooks hooks;
    hooks.clear_stop = [&] { stop = false; };
    Runner runner(run.sequence, reactor, run.store, hooks);
    std::jthread user([&, after_s = random.uniform(0.01, 0.4)] {   // in the middle of an answer, too
      std::this_thread::sleep_for(std::chrono::duration<double>(after_s));
      stop = true;
    });
    const std::string outcome = runner.run(false);
    user.join();
    stop = false;
    reactor.sleep_until(reactor.now() + 60'000'000);   // the output dies away from as much as 200 mA
    EXPECT_TRUE(outcome == "stopped by the user" || outcome == "done") << outcome;
    EXPECT_TRUE(run.safe()) << i << ": " << outcome;
    for (const StepRow& row : run.store.steps()) EXPECT_NE(row.outcome, StepOutcome::kFailed) << row.what << ": " << row.message;
  }
}

// A disk that is full from some step on: the store says so, after everything is safe.
TEST(Runner, AStoreThatTakesNoMoreEndsTheRunSafely) {
  for (const int full_at : {30, 60, 90}) {
    OpenRun run;
    rlimit before{};
    ::getrlimit(RLIMIT_FSIZE, &before);
    const auto ignored = ::signal(SIGXFSZ, SIG_IGN);
    RunnerHooks hooks;
    int steps = 0;
    hooks.progress = [&](const Progress&) {
      const rlimit none{1, before.rlim_max};
      if (++steps == full_at) ::setrlimit(RLIMIT_FSIZE, &none);
    };
    Runner runner(run.sequence, run.reactor, run.store, hooks);
    try {
      const std::string outcome = runner.run(false);
      ADD_FAILURE() << outcome;
    } catch (const UserError& error) {
      ADD_FAILURE() << error.what();
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("bench.sqlite: not everything could be written"), std::string::npos)
          << error.what();
    }
    ::setrlimit(RLIMIT_FSIZE, &before);
    ::signal(SIGXFSZ, ignored);
    run.reactor.sleep_until(run.reactor.now() + 60'000'000);
    EXPECT_TRUE(run.safe()) << full_at;
  }
}

// As the live picture of a run where its place is lost: what watches a run does not keep it from its safe end.
TEST(Runner, WhoWatchesARunDoesNotStopItsSafeEnd) {
  OpenRun run;
  RunnerHooks hooks;
  int steps = 0;
  hooks.progress = [&](const Progress&) {
    if (++steps >= 60) throw std::runtime_error("no picture");
  };
  Runner runner(run.sequence, run.reactor, run.store, hooks);
  EXPECT_THROW(runner.run(false), std::runtime_error);
  run.reactor.sleep_until(run.reactor.now() + 60'000'000);
  EXPECT_TRUE(run.safe());
}

// When the steps of a run without faults end, in seconds since the laboratory's start, a moment early: the next run
// has the same times.
std::vector<double> step_ends_s(OpenRun& run) {
  const std::int64_t begin = run.time.now();
  EXPECT_EQ(run.run(), "done");
  std::vector<double> ends_s;
  for (const StepRow& row : run.store.steps()) ends_s.push_back(1e-6 * static_cast<double>(row.ended_utime - begin) - 0.01);
  return ends_s;
}

TEST(Runner, AStepOfTheTearDownThatFailsIsTold) {
  const ShortSequence::Changes supply_off = {
      {"[[teardown]]\n", "[[teardown]]\nset = \"supply.output\"\nvalue = \"off\"\n\n[[teardown]]\n"}};
  OpenRun good({}, supply_off);
  const std::vector<double> ends_s = step_ends_s(good);
  const std::size_t first = ends_s.size() - 5;  // of five
  // Nothing of the supply is made safe besides: the step alone tells.
  OpenRun run({{"supply", FaultType::kHang, ends_s[first - 1], 1e12, 0}}, supply_off);
  RunnerHooks hooks;
  int failures = 0;
  std::string alarm;
  hooks.progress = [&](const Progress& progress) {
    failures = progress.failures;
    alarm = progress.alarm;
  };
  Runner runner(run.sequence, run.reactor, run.store, hooks);
  EXPECT_EQ(runner.run(false), "done with failures");
  EXPECT_EQ(failures, 1);
  EXPECT_NE(alarm.find("supply: no answer in time"), std::string::npos) << alarm;
  run.reactor.sleep_until(run.reactor.now() + 5'000'000);
  EXPECT_TRUE(run.safe());
  ASSERT_EQ(run.failures().size(), 1U);
  EXPECT_EQ(run.failures()[0].what, "set supply.output off");
  EXPECT_EQ(run.failures()[0].outcome, StepOutcome::kFailed);
}

// Nothing asks the generator before it is made safe: the first use of what fell silent only finds it out.
TEST(Runner, WhatCannotBeMadeSafeIsTriedOnceMoreAndThenTold) {
  OpenRun good;
  const double end_s = step_ends_s(good).back();
  OpenRun once({{"generator", FaultType::kHang, kWhileMeasuring, end_s + 0.5, 0}}),
      always({{"generator", FaultType::kHang, kWhileMeasuring, 1e12, 0}});
  EXPECT_EQ(once.run(), "done");
  EXPECT_EQ(always.run(), "done with failures");
  EXPECT_TRUE(once.safe());
  EXPECT_TRUE(always.safe()) << "the others are, whatever one does";
}

// By the unit's design: the converter's own scale is within 1 % of it.
TEST(Runner, ARecordingsCurrentIsHeldAgainstItsLimits) {
  const auto changed = [](const std::string& low, const std::string& high) -> ShortSequence::Changes {
    return {{"limits = [{ of = \"lost\"",
             "limits = [{ of = \"current\", low = \"" + low + "\", high = \"" + high + "\" }, { of = \"lost\""}};
  };
  OpenRun wide({}, changed("-210 mA", "210 mA"));
  EXPECT_EQ(wide.run(), "done");
  for (const auto& [low, high, found_mA] : {std::tuple{"-15 mA", "210 mA", -100}, {"-210 mA", "15 mA", 100}}) {
    OpenRun run({}, changed(low, high));  // the gyroscope's channel is the first to be given more
    const std::string outcome = run.run();
    const std::size_t at = outcome.find("counts: out of range: current = ");
    ASSERT_NE(at, std::string::npos) << outcome;
    EXPECT_NEAR(std::stod(outcome.substr(outcome.find("= ", at) + 2)), found_mA, 1) << outcome;
    run.reactor.sleep_until(run.reactor.now() + 60'000'000);  // the output dies away
    EXPECT_TRUE(run.safe());
  }
}

}  // namespace
}  // namespace waverig::rig::bench
