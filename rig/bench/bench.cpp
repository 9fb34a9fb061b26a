#include "rig/bench/bench.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <memory>
#include <string_view>

#include "lcmtypes/disk.h"
#include "lcmtypes/error.h"
#include "rig/bench/simulation/simulated_laboratory.h"

namespace waverig::rig::bench {
namespace {

// What the lock's file says, the one written over the other: that finds room on a full disk too.
constexpr std::string_view kUnderWay = "under way\n", kTornDown = "torn down\n";
static_assert(kUnderWay.size() == kTornDown.size());

// Only one bench at a time in a directory; the lock goes with the process, however it ends. Its file tells a
// run that was torn down from one that was killed, where the store takes no more.
class DirectoryLock {
 public:
  explicit DirectoryLock(const std::filesystem::path& directory)
      : descriptor_(::open((directory / "bench.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    const std::error_code error(descriptor_ < 0 ? errno : 0, std::generic_category());
    if (error)
      refuse_place(error, fmt::format("{}: cannot be written: {}; expected a writable directory",
                                      directory.string(), error.message()));
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
    ::close(descriptor_);
    throw UserError(fmt::format("{}: another bench is at work there: expected a directory of its own",
                                directory.string()));
  }
  ~DirectoryLock() { ::close(descriptor_); }
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

  std::error_code say(std::string_view state) const {
    const bool said = ::pwrite(descriptor_, state.data(), state.size(), 0) == std::ssize(state) &&
                      ::fsync(descriptor_) == 0;
    return {said ? 0 : errno, std::generic_category()};
  }
  bool says(std::string_view state) const {
    std::string said(state.size(), '\0');
    return ::pread(descriptor_, said.data(), said.size(), 0) == std::ssize(said) && said == state;
  }

 private:
  int descriptor_;
};

std::int64_t system_utime() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

void check_same(const Sequence& sequence, const RunInfo& info, bool torn_down, const BenchOptions& options) {
  for (const auto& [name, print] : sequence.fingerprints) {
    const auto found = info.files.find(name);
    if (found == info.files.end() || found->second != print)
      throw UserError(
          fmt::format("{}: it has changed since the run in {} began: expected it unchanged, or a new run",
                      name, options.out.string()));
  }
  if (info.simulated != options.simulate)
    throw UserError(fmt::format("{}: the run there is {}: expected --resume {} --simulate",
                                options.out.string(), info.simulated ? "simulated" : "real",
                                info.simulated ? "with" : "without"));
  const bool running = info.outcome == "running";
  if (sequence.uninterrupted && !info.outcome.starts_with("done") && (!running || torn_down))
    throw UserError(
        fmt::format("{}: the run there ended and was torn down ({}), and its sequence cannot be interrupted: "
                    "expected a new run",
                    options.out.string(), running ? "its store was not told why" : info.outcome));
}

}  // namespace

BenchResult run_bench(const Sequence& given, const BenchOptions& options) {
  std::filesystem::create_directories(options.out);
  const DirectoryLock lock(options.out);
  const std::filesystem::path file = store_file(options.out);
  const std::int64_t begin = options.simulate ? options.simulation.start_utime : system_utime();
  RunInfo fresh{given.title, given.procedure, options.version,  given.fingerprints,
                {},          begin,           options.simulate, "running",
                {}};
  if (!options.resume && !Store::begun(file)) fresh.sequence = keep_files(given, options.out);
  Store store = options.resume ? Store::open(file) : Store::create(file, fresh);
  const RunInfo info = store.info();
  if (options.resume) {
    check_same(given, info, lock.says(kTornDown), options);
    if (info.outcome.starts_with("done")) return {info.outcome, true};
  }
  if (const std::error_code error = lock.say(kUnderWay))
    refuse_place(
        error, fmt::format("{}: not everything could be written: {}", options.out.string(), error.message()));

  const ResumeState state = store.resume_state();
  Sequence sequence = given;
  std::unique_ptr<VirtualTime> time;
  std::unique_ptr<SimulatedLaboratory> laboratory;
  if (options.simulate) {
    time = std::make_unique<VirtualTime>(std::max(state.utime, info.started_utime));
    laboratory = std::make_unique<SimulatedLaboratory>(options.simulation, given.laboratory, time.get(),
                                                       info.started_utime, state.world);
    sequence.laboratory = laboratory->addressed();
  }
  Reactor reactor(time.get(), options.stop);
  RunnerHooks hooks;
  hooks.progress = options.progress;
  hooks.prompt = options.prompt;
  hooks.trace = options.trace;
  hooks.clear_stop = options.clear_stop;
  hooks.breaks_off = [&] { lock.say(kTornDown); };
  if (laboratory) hooks.world_snapshot = [&] { return laboratory->snapshot(); };
  Runner runner(sequence, reactor, store, std::move(hooks));
  const std::string outcome = runner.run(options.resume);
  return {outcome, outcome.starts_with("done")};
}

}  // namespace waverig::rig::bench
