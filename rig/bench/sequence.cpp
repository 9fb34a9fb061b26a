#include "rig/bench/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lcmtypes/error.h"
#include "rig/bench/planner.h"
#include "rig/bench/sequence_document.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {
namespace {

constexpr double kDurationTolerance = 0.02;

}  // namespace

const char* name_of(Verb verb) {
  switch (verb) {
    case Verb::kSet:
      return "set";
    case Verb::kRead:
      return "read";
    case Verb::kWait:
      return "wait";
    case Verb::kUntil:
      return "until";
    case Verb::kRecord:
      return "record";
    case Verb::kPrompt:
      return "prompt";
  }
  return "";
}

const char* name_of(Section section) {
  switch (section) {
    case Section::kSetup:
      return "setup";
    case Section::kSteps:
      return "steps";
    case Section::kTeardown:
      return "teardown";
  }
  return "";
}

double Sequence::expected_s() const {
  double sum = 0;
  for (const PlannedStep& step : plan) sum += step.expected_s;
  return sum;
}

Sequence load_sequence(const std::filesystem::path& file) {
  TomlFile toml(file);
  TomlTable& root = toml.root();
  Sequence sequence;
  sequence.file = file;
  sequence.title = root.text("title", {});
  sequence.procedure = root.choice("procedure", {}, {"scale_factor", "scale_factor_dmm", "bias", "none"});
  sequence.uninterrupted = root.boolean("uninterrupted", false);
  if (root.has("duration"))
    sequence.duration_s =
        parse_quantity(root.text("duration", {}), "s", root.place_of("duration") + ": duration").si;
  if (root.has("duration") && !(sequence.duration_s > 0)) root.refuse("duration", "a time above 0");
  sequence.laboratory = load_laboratory(file.parent_path() / root.text("laboratory", {}));
  if (root.has("unit")) load_unit(file.parent_path() / root.text("unit", {}), sequence.laboratory);
  sequence.fingerprints = sequence.laboratory.fingerprints;
  sequence.fingerprints[file.filename().string()] = fingerprint(file);
  for (TomlTable& window : root.tables("window")) {
    sequence.windows.push_back({window.text("title", {}), window.texts("channels", {})});
    for (const std::string& channel : sequence.windows.back().channels)
      if (channel != "temperature" && sequence.laboratory.unit.channel(channel) == nullptr)
        window.refuse("channels", "channels of the unit, or temperature");
  }
  const int retries = static_cast<int>(root.integer("retries", 0, {0, 100}));  // where a step does not say
  const Document document = read_document(root, retries);
  for (const auto& [key, section] :
       {std::pair{"setup", Section::kSetup}, {"steps", Section::kSteps}, {"teardown", Section::kTeardown}})
    unfold(document, read_steps(root, key, retries), section, sequence);
  root.refuse_unknown_keys();
  if (sequence.plan.empty()) root.refuse("steps", "at least one step");
  if (sequence.duration_s > 0 &&
      std::abs(sequence.expected_s() - sequence.duration_s) > kDurationTolerance * sequence.duration_s)
    root.refuse("duration",
                fmt::format("the plan's own {}, within 2 %", show_duration(sequence.expected_s())));
  return sequence;
}

std::string describe(const Sequence& sequence) {
  struct Line {
    const PlannedStep* first = nullptr;
    int count = 0;
    double time_s = 0;
    std::vector<std::string> values;
  };
  std::vector<Line> lines;  // steps of the same place in the file, folded
  std::map<std::string, std::size_t> line_of;
  std::vector<std::string> used;
  for (const PlannedStep& step : sequence.plan) {
    const std::string key = std::string(name_of(step.section)) + step.where;
    const auto [entry, added] = line_of.try_emplace(key, lines.size());
    if (added) lines.emplace_back().first = &step;
    Line& line = lines[entry->second];
    ++line.count;
    line.time_s += step.expected_s;
    const std::string value = step.verb == Verb::kSet      ? step.value
                              : step.verb == Verb::kRecord ? fmt::format("{}", fmt::join(step.channels, " "))
                                                           : "";
    if (!value.empty() && std::ranges::find(line.values, value) == line.values.end())
      line.values.push_back(value);
    if (!step.instrument.empty() && std::ranges::find(used, step.instrument) == used.end())
      used.push_back(step.instrument);
  }
  std::string text = fmt::format("{}\n{} steps, {}\n\nInstruments\n", sequence.title, sequence.plan.size(),
                                 show_duration(sequence.expected_s()));
  for (const std::string& name : used) {
    const Instrument& i = *sequence.laboratory.instrument(name);
    text += fmt::format("  {:<12} {:<20} {}\n", name, i.kind, i.address);
  }
  const char* section = "";
  for (const Line& line : lines) {
    const PlannedStep& step = *line.first;
    if (std::string_view(section) != name_of(step.section))
      text += fmt::format("\n{}\n", section = name_of(step.section));
    std::string what;
    if (step.verb == Verb::kSet || step.verb == Verb::kRead) what = step.instrument + "." + step.name;
    if (step.verb == Verb::kUntil)
      what = fmt::format("{}.{} within {:g} of its target for {}, at most {}", step.instrument, step.name,
                         step.within_si, show_duration(step.duration_s), show_duration(step.timeout_s));
    if (step.verb == Verb::kWait) what = show_duration(step.duration_s);
    if (step.verb == Verb::kRecord)
      what = fmt::format("{} for {}:", fmt::join(step.ports, ", "), show_duration(step.duration_s));
    if (step.verb == Verb::kPrompt) what = "\"" + step.text + "\", unattended: " + step.unattended;
    const std::size_t shown = std::min<std::size_t>(line.values.size(), 4);
    if (shown > 0)
      what += fmt::format(
          " {}{}",
          fmt::join(line.values.begin(), line.values.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
          shown < line.values.size() ? fmt::format(", … ({} values)", line.values.size()) : "");
    text += fmt::format("  {:<7}{}{}{}\n", name_of(step.verb), what,
                        line.count > 1 ? fmt::format("  x {}", line.count) : "",
                        line.time_s > 0 ? ", " + show_duration(line.time_s) : "");
  }
  return text;
}

}  // namespace waverig::rig::bench
