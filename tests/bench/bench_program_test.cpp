// waverig bench, waverig calibrations and waverig node instruments-sim from outside.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "motion/kinematics/random.h"
#include "rig/bench/store.h"
#include "tests/bench/short_sequence.h"
#include "tests/campaign/temporary_directory.h"

namespace waverig::rig::bench {
namespace {

using std::chrono::steady_clock;

// The program, running, its output in a file.
struct Program {
  pid_t pid;
  std::filesystem::path output;

  // largest_file: in bytes; what would be larger is not written.
  Program(const std::vector<std::string>& arguments, std::filesystem::path into, rlim_t largest_file = RLIM_INFINITY)
      : pid(-1), output(std::move(into)) {
    std::vector<char*> list = {const_cast<char*>(WAVERIG_PROGRAM)};
    for (const std::string& a : arguments) list.push_back(const_cast<char*>(a.c_str()));
    list.push_back(nullptr);
    pid = ::fork();
    if (pid != 0) return;
    const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(file, 1);
    ::dup2(file, 2);
    if (largest_file != RLIM_INFINITY) ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{largest_file, largest_file};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::execv(list[0], list.data());
    ::_exit(127);
  }
  int wait() {   // exit status, or minus the signal
    int status = 0;
    ::waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  std::string said() const { return bytes_of(output); }
};

struct Bench {
  ShortSequence files;
  explicit Bench(const ShortSequence::Changes& changes = {}) : files("scale_factor.toml", changes) {}

  std::vector<std::string> arguments(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> list = {"bench", files.file().string(), "--simulate", "--out", files.out(out).string()};
    list.insert(list.end(), more.begin(), more.end());
    return list;
  }
  Program start(const std::string& out, const std::vector<std::string>& more = {}) const {
    return {arguments(out, more), files.out(out + ".txt")};
  }
};

TEST(BenchProgram, ADryRunPrintsThePlanAndCommandsNothing) {
  const Bench bench;
  Program program({"bench", bench.files.file().string(), "--dry-run"}, bench.files.out("said.txt"));
  EXPECT_EQ(program.wait(), 0);
  for (const char* text : {" steps, ", "chamber.temperature", "teardown", "record "}) EXPECT_NE(program.said().find(text), std::string::npos) << text;
  EXPECT_FALSE(std::filesystem::exists(bench.files.out()));
}

TEST(BenchProgram, AWrongChannelIsRefusedInOneLineBeforeAnything) {
  const ShortSequence::Changes wrong = {{"gyros = [\"gyro_2\"]", "gyros = [\"gyro_9\"]"}};
  const Bench bench(wrong);
  Program program = bench.start("out");
  EXPECT_EQ(program.wait(), 2);
  const std::string said = program.said();
  EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  EXPECT_NE(said.find("scale_factor.toml:"), std::string::npos) << said;
  EXPECT_NE(said.find("gyro_9"), std::string::npos) << said;
  EXPECT_FALSE(std::filesystem::exists(bench.files.out()));
}

TEST(BenchProgram, AnInstrumentThatHangsEndsItWithStatusOneAndItsName) {
  const Bench bench;
  std::ofstream(bench.files.out("faults.toml")) << "[[fault]]\ndevice = \"switch\"\ntype = \"hang\"\nfrom = \"6700 s\"\n";
  Program program = bench.start("out", {"--simulation", bench.files.out("faults.toml").string()});
  EXPECT_EQ(program.wait(), 1);
  EXPECT_NE(program.said().find("alarm: switch: no answer in time"), std::string::npos) << program.said();
  EXPECT_NE(bytes_of(bench.files.out() / "junit.xml").find("switch: no answer in time"), std::string::npos);
  EXPECT_NE(bytes_of(bench.files.out() / "report.html").find("switch: no answer in time"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(bench.files.out() / "calibration.json"));
}

TEST(BenchProgram, KilledAndResumedItGivesTheSameFilesToTheByte) {
  const Bench bench;
  const auto started = steady_clock::now();
  ASSERT_EQ(bench.start("whole").wait(), 0);
  const std::chrono::duration<double> whole = steady_clock::now() - started;
  RandomStream random(11, "kill");
  int killed = 0;
  for (int i = 0; i < 5; ++i) {
    const bool begun = std::filesystem::exists(bench.files.out("killed") / "bench.sqlite");
    Program program = bench.start("killed", begun ? std::vector<std::string>{"--resume"} : std::vector<std::string>{});
    std::this_thread::sleep_for(random.uniform(0.1, 0.4) * whole);
    ::kill(program.pid, SIGKILL);
    killed += program.wait() == -SIGKILL;
  }
  EXPECT_GE(killed, 1);
  Program last = bench.start("killed", {"--resume"});
  ASSERT_EQ(last.wait(), 0) << last.said();
  for (const char* file : {"calibration.json", "channels.csv", "steps.csv", "junit.xml"})
    EXPECT_EQ(bytes_of(bench.files.out("whole") / file), bytes_of(bench.files.out("killed") / file)) << file;
}

// SIGHUP: the terminal was closed, the connection to it lost.
class Ended : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(BenchProgram, Ended, testing::Values(SIGTERM, SIGHUP));

TEST_P(Ended, LeavesTheBenchSafeAndSaysSo) {
  const Bench bench;
  Program program = bench.start("out");
  const auto recording = [&] {
    if (!std::filesystem::exists(bench.files.out() / "bench.sqlite")) return false;
    try {
      return !Store::open(bench.files.out() / "bench.sqlite").recordings().empty();
    } catch (const std::exception&) {   // it is being made
      return false;
    }
  };
  for (int i = 0; i < 3000 && !recording(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ::kill(program.pid, GetParam());
  EXPECT_EQ(program.wait(), 1);
  const Store store = Store::open(bench.files.out() / "bench.sqlite");
  EXPECT_EQ(store.info().outcome, "stopped by the user");
  std::vector<std::string> safe;
  for (const StepRow& s : store.steps())
    if (s.outcome == StepOutcome::kMadeSafe) safe.push_back(s.what);
  EXPECT_NE(std::ranges::find(safe, "set calibrator.output off"), safe.end());
  EXPECT_NE(std::ranges::find(safe, "set chamber.temperature 23 degC"), safe.end());
}

TEST(CalibrationsProgram, ListsShowsAndComparesWhatTheBenchKept) {
  const Bench bench;
  ASSERT_EQ(bench.start("first").wait(), 0);
  std::ofstream(bench.files.out("later.toml")) << "noise_seed = 2\nstart = \"2025-01-01\"\n[drift]\nscale = \"400 ppm\"\n";
  ASSERT_EQ(bench.start("second", {"--simulation", bench.files.out("later.toml").string()}).wait(), 0);
  const std::string history = bench.files.out("calibrations").string();
  const auto call = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "calibrations");
    arguments.insert(arguments.end(), {"--history", history});
    Program program(arguments, bench.files.out("said.txt"));
    const int status = program.wait();
    return std::pair(status, program.said());
  };
  const std::string a = "simulated-scale_factor-20240101T000000", b = "simulated-scale_factor-20250101T000000";
  const auto [listed, list] = call({"list"});
  EXPECT_EQ(listed, 0) << list;
  EXPECT_LT(list.find(a), list.find(b));
  const auto [shown, one] = call({"show", b});
  EXPECT_EQ(shown, 0) << one;
  for (const char* text : {"CAL-2A", "scale_factor.toml: ", "gyro_2", "calibrator"}) EXPECT_NE(one.find(text), std::string::npos) << text;
  const auto [compared, difference] = call({"compare", a, b, "--same-reference", "--chart", bench.files.out("chart.png").string()});
  EXPECT_EQ(compared, 1) << difference;
  EXPECT_NE(difference.find("drifted"), std::string::npos);
  EXPECT_TRUE(bytes_of(bench.files.out("chart.png")).starts_with("\x89PNG"));
  const auto [same, nothing] = call({"compare", a, a});
  EXPECT_EQ(same, 0) << nothing;
  const auto [unknown, complaint] = call({"show", "nobody"});
  EXPECT_EQ(unknown, 2) << complaint;
}

// A disk that takes no more: of the sequence's files, of the store, in the midst of the run.
TEST(BenchProgram, AFullDiskIsNoBadInput) {
  const Bench bench;
  for (const rlim_t bytes : {2'000, 20'000, 60'000, 400'000}) {
    const std::string name = "out" + std::to_string(bytes);
    Program program(bench.arguments(name), bench.files.out(name + ".txt"), bytes);
    EXPECT_EQ(program.wait(), 1) << program.said();
    const std::string said = program.said();
    EXPECT_NE(said.find("waverig: " + bench.files.out(name).string()), std::string::npos) << said;
    EXPECT_EQ(std::ranges::count(said, '\n'), 1) << said;
  }
}

TEST(BenchProgram, RefusesAHistoryThatCannotBeBeforeItRuns) {
  const Bench bench;
  std::ofstream(bench.files.out("file")) << "no folder";
  for (const char* name : {"file", "file/below"}) {
    Program program = bench.start("out", {"--history", bench.files.out(name).string()});
    EXPECT_EQ(program.wait(), 2) << program.said();
    EXPECT_EQ(program.said(), "waverig: " + bench.files.out(name).string() +
                                  ": cannot be made or written: expected a directory for the history\n");
    EXPECT_FALSE(std::filesystem::exists(bench.files.out("out"))) << "nothing was begun";
  }
}

struct Said {
  int status;
  std::string text;
};

Said calibrate(const ShortSequence& files, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"calibrate", "front-end"});
  Program program(arguments, files.out("said.txt"));
  const int status = program.wait();
  return {status, program.said()};
}

TEST(CalibrateFrontEnd, GivesTheBenchsOwnFilesToTheByteFromTheRunsDirectoriesAlone) {
  const ShortSequence files("scale_factor.toml",
                            {{"gyros = [\"gyro_2\"]", "gyros = [\"gyro_1\", \"gyro_2\", \"gyro_3\", \"gyro_4\", \"gyro_5\", \"gyro_6\"]"},
                             {"accels = [\"accel_1\"]", "accels = [\"accel_1\", \"accel_2\", \"accel_3\", \"accel_4\"]"},
                             {"[\"5 degC\", \"25 degC\", \"45 degC\"]", "[\"20 degC\"]"}});
  const ShortSequence ramp("bias.toml", {{"duration = \"25 h\" ", "# "}, {"count = 360", "count = 40"}, {"count = 360", "count = 40"}});
  const std::string scale = files.out("scale").string(), with = files.out("with").string(), without = files.out("without").string();
  const std::string factors = scale + "/calibration.json", file = files.out("afterwards.json").string();
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "bench");
    arguments.emplace_back("--simulate");
    Program program(arguments, files.out("said.txt"));
    ASSERT_EQ(program.wait(), 0) << program.said();
  };
  run({files.file().string(), "--out", scale});
  run({ramp.file().string(), "--out", with, "--scale-factors", factors});
  run({ramp.file().string(), "--out", without});
  // What the runs kept counts, not what has become of their files since.
  std::ofstream(files.file(), std::ios::app) << "nonsense";
  std::ofstream(ramp.file(), std::ios::app) << "nonsense";

  for (const std::string& directory : {scale, with, without}) {   // with: by the scale factors that the run went by
    const Said said = calibrate(files, {directory, "--out", file});
    EXPECT_EQ(said.status, 0) << said.text;
    EXPECT_EQ(bytes_of(file), bytes_of(directory + "/calibration.json"));
  }
  EXPECT_NE(bytes_of(file), bytes_of(with + "/calibration.json"));
  EXPECT_EQ(calibrate(files, {without, "--scale-factors", factors, "--out", file}).status, 0);
  EXPECT_EQ(bytes_of(file), bytes_of(with + "/calibration.json"));
  const Said refused = calibrate(files, {scale, "--scale-factors", factors, "--out", file});
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.text.find("expected it for a bias run"), std::string::npos) << refused.text;
}

TEST(CalibrateFrontEnd, RefusesWhatIsNoFinishedRunInOneLine) {
  const Bench bench;
  std::ofstream(bench.files.out("faults.toml")) << "[[fault]]\ndevice = \"switch\"\ntype = \"hang\"\nfrom = \"6700 s\"\n";
  ASSERT_EQ(bench.start("ended", {"--simulation", bench.files.out("faults.toml").string()}).wait(), 1);
  const std::string ended = bench.files.out("ended").string(), file = bench.files.out("x.json").string();
  std::filesystem::create_directories(bench.files.out("empty"));
  std::ofstream(bench.files.out("empty") / "bench.sqlite") << "no database";
  const std::vector<std::pair<std::string, std::string>> wrong = {{ended, "has not come to its end"},
                                                                  {bench.files.out("nowhere").string(), "no run is there"},
                                                                  {bench.files.out("empty").string(), "expected a bench store"}};
  for (const auto& [run, expected] : wrong) {
    const Said said = calibrate(bench.files, {run, "--out", file});
    EXPECT_EQ(said.status, 2) << said.text;
    EXPECT_EQ(std::ranges::count(said.text, '\n'), 1) << said.text;
    EXPECT_NE(said.text.find(expected), std::string::npos) << said.text;
    EXPECT_NE(said.text.find(run), std::string::npos) << said.text;
  }
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_EQ(calibrate(bench.files, {ended}).status, 2);   // nowhere to write
  EXPECT_EQ(calibrate(bench.files, {"--help"}).status, 0);
}

TEST(CalibrateFrontEnd, RefusesARunWhoseKeptFilesWereChanged) {
  const ShortSequence::Changes one_temperature = {{"[\"5 degC\", \"25 degC\", \"45 degC\"]", "[\"20 degC\"]"}};
  const Bench bench(one_temperature);
  ASSERT_EQ(bench.start("run").wait(), 0);
  const std::filesystem::path kept = bench.files.out("run") / "sequence" / "converter_unit.toml";
  std::ofstream(kept, std::ios::app) << "# 31 nC?\n";
  const Said said = calibrate(bench.files, {bench.files.out("run").string(), "--out", bench.files.out("x.json").string()});
  EXPECT_EQ(said.status, 2);
  EXPECT_NE(said.text.find("has changed since the run"), std::string::npos) << said.text;
}

// The same bench in real time, against instruments in another process.
TEST(InstrumentsSim, ServesABenchInRealTimeThatOnlyKnowsTheAddresses) {
  const Bench bench;
  const std::filesystem::path directory = bench.files.file().parent_path(), simulated = directory / "simulated.toml";
  std::ofstream(directory / "real_time.toml") << R"(title = "Real time"
procedure = "none"
laboratory = "simulated.toml"
[[setup]]
set = "supply.voltage"
value = "28 V"
[[setup]]
set = "supply.output"
value = "on"
[[setup]]
set = "unit.rate"
value = "100 Hz"
[[setup]]
wait = "1 s"
[[steps]]
read = "chamber.temperature"
limits = [{ low = "20 degC", high = "26 degC" }]
[[steps]]
record = ["counts"]
duration = "2 s"
channels = ["all"]
[[teardown]]
set = "unit.rate"
value = "0 Hz"
)";
  Program node({"node", "instruments-sim", (directory / "laboratory.toml").string(), "--write", simulated.string()}, directory / "node.txt");
  for (int i = 0; i < 1000 && !std::filesystem::exists(simulated); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  Program program({"bench", (directory / "real_time.toml").string(), "--out", bench.files.out("real").string()}, directory / "said.txt");
  EXPECT_EQ(program.wait(), 0) << program.said();
  const std::vector<RecordingRow> rows = Store::open(bench.files.out("real") / "bench.sqlite").recordings();
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].ticks, 200);
  EXPECT_EQ(rows[0].channels.size(), 10U);
  ::kill(node.pid, SIGTERM);
  EXPECT_EQ(node.wait(), 0);
  EXPECT_NE(node.said().find("gateway"), std::string::npos);
}

}  // namespace
}  // namespace waverig::rig::bench
