// Store: the memory of a run, one SQLite file in write-ahead mode. A step is committed, with its recordings
// and the state to go on from, in one transaction and on the disk before the next step begins.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

struct sqlite3;

namespace waverig::rig::bench {

struct RunInfo {
  std::string title, procedure, version;
  std::map<std::string, std::string> files;        // name: fingerprint
  std::map<std::string, std::string> instruments;  // name: identity as answered
  std::int64_t started_utime = 0;
  bool simulated = false;
  std::string outcome;   // running, done, failed (limits), or why it ended
  std::string sequence;  // file, as the run's directory keeps it and from there
};

enum class StepOutcome {
  kDone,
  kFailed,
  kAccepted,
  kMadeSafe
};  // accepted: failed, and the rule was to go on
const char* name_of(StepOutcome outcome);

struct StepRow {
  int index = 0, attempt = 0;
  std::string section, path, what, where;
  StepOutcome outcome = StepOutcome::kDone;
  std::string message;
  std::int64_t started_utime = 0, ended_utime = 0;
  std::optional<double> value;  // of a reading, SI
  std::string limits;           // what it was held against, as people read it
};

struct ChannelCounts {
  std::string channel;
  std::int64_t N = 0, P = 0;  // pulses in the recording
  double noise_A_sqrt_s = 0;  // from its own seconds; 0: too few
};

struct RecordingRow {
  int index = 0, attempt = 0;
  std::string port;
  std::map<std::string, std::string> tags;
  std::int64_t start_utime = 0, ticks = 0, clock = 0,
               reference = 0;  // length by the unit's clocks; reference pulses
  std::int64_t frames = 0, lost = 0, broken = 0;
  double temperature = 0, temperature_span = 0;  // degC
  std::vector<ChannelCounts> channels;
  std::vector<std::uint8_t> data;  // kept frames, compressed; see frame_data.h
};

// A port's frame now and then, raw: what the traces over a whole run are drawn from.
struct TraceRow {
  std::string port;
  std::int64_t utime = 0;
  std::vector<std::int64_t> raw;
};

// Enough to go on: the time, the simulated laboratory (empty on a real bench), the last frame of each port.
struct ResumeState {
  std::int64_t utime = 0;
  std::string world;
  std::map<std::string, std::vector<std::int64_t>> last_frames;
};

class Store {
 public:
  // Throws UserError where the file cannot be made or opened, or is none of ours.
  static Store create(const std::filesystem::path& file, const RunInfo& info);
  static Store open(const std::filesystem::path& file);
  // False where no run has begun: no file, or an SQLite file of nothing, as a kill could leave it once.
  static bool begun(const std::filesystem::path& file);
  Store(Store&&) noexcept;
  ~Store();

  void commit(const StepRow& step, const std::vector<RecordingRow>& recordings,
              const std::vector<TraceRow>& trace, const ResumeState& state);
  void set_instruments(const std::map<std::string, std::string>& instruments);
  void set_outcome(const std::string& outcome);

  RunInfo info() const;
  ResumeState resume_state() const;
  std::vector<StepRow> steps() const;   // in the order of execution
  std::vector<TraceRow> trace() const;  // in the order of time
  // with_data: also the kept frames.
  std::vector<RecordingRow> recordings(bool with_data = false) const;

 private:
  explicit Store(sqlite3* database) : database_(database) {}
  void execute(const char* sql) const;
  struct Statement;

  sqlite3* database_;
};

}  // namespace waverig::rig::bench
