// A bench that is killed at random moments goes on and gives the same result to the bit.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "lcmtypes/error.h"
#include "motion/kinematics/random.h"
#include "rig/bench/bench.h"
#include "tests/bench/short_sequence.h"

namespace waverig::rig::bench {
namespace {

BenchOptions options_for(const std::filesystem::path& out) {
  BenchOptions options;
  options.out = out;
  options.simulate = true;
  options.version = "test";
  options.resume = std::filesystem::exists(store_file(out)) && std::filesystem::file_size(store_file(out)) > 0;
  return options;
}

void expect_refused(const Sequence& sequence, const BenchOptions& options, const std::string& why) {
  try {
    run_bench(sequence, options);
    ADD_FAILURE() << "it went on";
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

// All that a run has measured, as text.
std::string everything(const Store& store) {
  std::string text = store.info().outcome + "\n";
  for (const StepRow& s : store.steps()) {
    text += std::to_string(s.index) + " " + std::to_string(s.attempt) + " " + s.path + " " + s.what + " " + s.message + " " +
            name_of(s.outcome) + " " + std::to_string(s.started_utime) + " " + std::to_string(s.ended_utime);
    if (s.value) text += " " + std::to_string(*s.value);
    text += "\n";
  }
  for (const RecordingRow& r : store.recordings(true)) {
    text += std::to_string(r.index) + " " + std::to_string(r.attempt) + " " + r.port + " " + std::to_string(r.start_utime) + " " +
            std::to_string(r.ticks) + " " + std::to_string(r.clock) + " " + std::to_string(r.reference) + " " +
            std::to_string(r.frames) + " " + std::to_string(r.lost) + " " + std::to_string(r.temperature);
    for (const ChannelCounts& c : r.channels) text += " " + c.channel + " " + std::to_string(c.N) + " " + std::to_string(c.P);
    text += " " + std::string(r.data.begin(), r.data.end()) + "\n";
  }
  for (const TraceRow& t : store.trace()) {
    text += t.port + " " + std::to_string(t.utime);
    for (const std::int64_t v : t.raw) text.append(" ").append(std::to_string(v));
    text += "\n";
  }
  return text;
}

class Killed : public testing::TestWithParam<const char*> {};

TEST_P(Killed, TenTimesItLosesAndRepeatsNothingAndGivesTheSameToTheBit) {
  ShortSequence::Changes changes;
  if (GetParam() == std::string("bias.toml"))   // two hours of ramp instead of twenty
    changes = {{"duration = \"25 h\" ", "# "}, {"count = 360", "count = 40"}, {"count = 360", "count = 40"}};
  const ShortSequence files(GetParam(), changes);
  const Sequence sequence = load_sequence(files.file());

  const auto started = std::chrono::steady_clock::now();
  EXPECT_EQ(run_bench(sequence, options_for(files.out("whole"))).outcome, "done");
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - started;

  RandomStream random(7, GetParam());
  const auto start = [&]() {
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        run_bench(sequence, options_for(files.out("killed")));
      } catch (...) {
        ::_exit(3);
      }
      ::_exit(0);
    }
    return child;
  };
  for (int kill = 0; kill < 10; ++kill) {
    const pid_t child = start();
    std::this_thread::sleep_for(random.uniform(0.01, 0.2) * whole);
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0);
  }
  const pid_t child = start();
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);

  const Store a = Store::open(store_file(files.out("whole"))), b = Store::open(store_file(files.out("killed")));
  EXPECT_EQ(a.steps().size(), sequence.plan.size());
  EXPECT_TRUE(everything(a) == everything(b));
  if (sequence.procedure == "scale_factor") {
    EXPECT_EQ(to_json(analyse(sequence, a).calibration), to_json(analyse(sequence, b).calibration));
  }
}

INSTANTIATE_TEST_SUITE_P(Bench, Killed, testing::Values("scale_factor.toml", "bias.toml"),
                         [](const auto& which) { return std::string(which.param).substr(0, std::strlen(which.param) - 5); });

TEST(Resume, RefusesAChangedSequenceAndAForeignDirectory) {
  ShortSequence files("scale_factor.toml");
  BenchOptions options = options_for(files.out());
  std::atomic<bool> stop{false};
  int steps = 0;
  options.stop = &stop;
  options.progress = [&](const Progress&) { stop = ++steps == 30; };
  options.clear_stop = [&] { stop = false; };
  EXPECT_EQ(run_bench(load_sequence(files.file()), options).outcome, "stopped by the user");
  EXPECT_THROW(run_bench(load_sequence(files.file()), options), UserError);   // a run is there already
  files.change("scale_factor.toml", {{"wait = \"5 s\"", "wait = \"6 s\""}});
  options.resume = true;
  EXPECT_THROW(run_bench(load_sequence(files.file()), options), UserError);
  files.change("scale_factor.toml", {{"wait = \"6 s\"", "wait = \"5 s\""}});
  EXPECT_EQ(run_bench(load_sequence(files.file()), options).outcome, "done");   // the chamber was let go: it settles anew
}

// A ramp of temperature that was broken off and torn down cannot go on where it stood.
TEST(Resume, RefusesToGoOnWithAnUninterruptedSequenceThatWasTornDown) {
  const ShortSequence files("bias.toml", {{"duration = \"25 h\" ", "# "}});
  const Sequence sequence = load_sequence(files.file());
  BenchOptions options = options_for(files.out());
  std::atomic<bool> stop{false};
  int steps = 0;
  options.stop = &stop;
  options.progress = [&](const Progress&) { stop = ++steps == 15; };
  options.clear_stop = [&] { stop = false; };
  EXPECT_EQ(run_bench(sequence, options).outcome, "stopped by the user");
  const std::size_t before = Store::open(store_file(files.out())).steps().size();
  options.resume = true;
  options.progress = nullptr;
  expect_refused(sequence, options, "torn down (stopped by the user), and its sequence cannot be interrupted");
  EXPECT_EQ(Store::open(store_file(files.out())).steps().size(), before);
}

// The store, which took no more, still says that the run goes on.
TEST(Resume, RefusesAnUninterruptedSequenceThatWasTornDownOnAFullDisk) {
  const ShortSequence files("bias.toml", {{"duration = \"25 h\" ", "# "}});
  const Sequence sequence = load_sequence(files.file());
  BenchOptions options = options_for(files.out());
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto ignored = ::signal(SIGXFSZ, SIG_IGN);
  int steps = 0;
  options.progress = [&](const Progress&) {
    const rlimit little{4000, before.rlim_max};
    if (++steps == 15) ::setrlimit(RLIMIT_FSIZE, &little);
  };
  EXPECT_THROW(run_bench(sequence, options), std::runtime_error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, ignored);
  ASSERT_EQ(Store::open(store_file(files.out())).info().outcome, "running");
  options.resume = true;
  options.progress = nullptr;
  expect_refused(sequence, options, "torn down (its store was not told why), and its sequence cannot be interrupted");
}

}  // namespace
}  // namespace waverig::rig::bench
