// Sequence: what the bench does, from a file (TOML), and the plan it unfolds into: every step with its
// instrument, value and limits, checked against the laboratory before the first command. rig/sequences/*.toml
// show every key.
//
// A step has one verb: set, read, wait, until, record, prompt, or for … do (a loop over a block of steps). In
// every text {name} stands for a loop's variable, {name.field} for a field of it where the list holds tables.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "rig/bench/laboratory.h"

namespace waverig::rig::bench {

enum class Verb { kSet, kRead, kWait, kUntil, kRecord, kPrompt };
enum class Section { kSetup, kSteps, kTeardown };

const char* name_of(Verb verb);
const char* name_of(Section section);

// A measured quantity and what it must lie between. of: "value" of a reading; of a recording lost,
// temperature, temperature_span, current, noise.
struct Limit {
  std::string of, base;
  double low_si = 0, high_si = 0;
};

struct PlannedStep {
  int index = 0;
  Section section = Section::kSteps;
  std::string path;   // loop variables, "temperature=5 degC/channel=gyro_1"
  std::string where;  // FILE:LINE
  Verb verb = Verb::kWait;
  std::string instrument, name;                                  // set, read, until
  std::string value;                                             // set: as written
  std::string command_value;                                     // set: as the instrument is told
  double value_si = 0;                                           // set: of a quantity
  double duration_s = 0;                                         // wait; record; until: how long it must hold
  double near_si = 0, within_si = 0, poll_s = 0, timeout_s = 0;  // until; timeout also of a recording
  double expected_s = 0;                                         // for the plan
  std::vector<std::string> ports, channels;
  std::map<std::string, std::string> tags;  // kept with a recording
  bool join = false;                        // a recording begins where the last one of its port ended
  bool keep = false;                        // it keeps every frame of its channels
  std::vector<Limit> limits;
  int retries = 0;
  bool abort = true;             // when the retries are used up; else the run goes on, marked
  std::string text, unattended;  // prompt
};

struct LiveWindow {
  std::string title;
  std::vector<std::string> channels;
};

struct Sequence {
  std::filesystem::path file;
  std::string title, procedure;  // scale_factor, scale_factor_dmm, bias, none
  double duration_s = 0;         // stated; 0: not
  bool uninterrupted = false;    // after a tear-down it cannot go on where it stood
  Laboratory laboratory;
  std::vector<LiveWindow> windows;
  std::vector<PlannedStep> plan;                    // set-up, steps, tear-down
  std::map<std::string, std::string> fingerprints;  // of every file behind it

  double expected_s() const;
};

// Throws UserError naming file, line, key, value and what was expected: an unknown instrument, channel, list
// or variable, a value out of an instrument's range, a plan that is not as long as it says.
Sequence load_sequence(const std::filesystem::path& file);

// The plan as people read it: loops folded, instruments, total time.
std::string describe(const Sequence& sequence);

}  // namespace waverig::rig::bench
