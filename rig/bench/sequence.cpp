#include "rig/bench/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lcmtypes/error.h"
#include "rig/settings/toml_reader.h"

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kStepsMax = 1'000'000;
constexpr double kDurationTolerance = 0.02;
constexpr int kDepthMax = 20;

using Variables = std::map<std::string, std::string>;

// One step as it stands in the file.
struct RawStep {
  std::string file, place;
  std::map<std::string, std::string> texts;
  std::vector<std::string> channels, ports, in;
  std::vector<std::map<std::string, std::string>> limits;
  std::map<std::string, std::string> tags;
  bool join = false, keep = false;
  int count = 0, retries = 0;
  bool has(const std::string& key) const { return texts.contains(key); }
};

struct ListItem {
  std::string name;
  Variables fields;
};

struct Document {
  std::map<std::string, std::vector<ListItem>> lists;
  std::map<std::string, std::vector<RawStep>> blocks;
};

std::map<std::string, std::string> all_texts(TomlTable table) {
  std::map<std::string, std::string> fields;
  for (const std::string& key : table.keys()) fields[key] = table.text(key, {});
  return fields;
}

RawStep read_step(TomlTable& table, int retries) {
  RawStep step;
  step.place = table.place_of("");
  for (const char* key : {"set", "read", "wait", "until", "prompt", "for", "do", "value", "near", "within", "hold", "poll",
                          "timeout", "expect", "duration", "unattended", "on_failure"})
    if (table.has(key)) step.texts[key] = table.text(key, {});
  if (table.has("record")) {
    step.ports = table.texts("record", {});
    step.texts["record"] = step.ports.front();
  }
  if (table.has("channels")) step.channels = table.texts("channels", {});
  if (table.has("in")) step.in = table.texts("in", {});
  step.count = static_cast<int>(table.integer("count", 0, {0, 1e6}));
  step.retries = static_cast<int>(table.integer("retries", retries, {0, 100}));
  step.join = table.boolean("join", false);
  step.keep = table.boolean("keep", false);
  for (TomlTable& limit : table.tables("limits")) step.limits.push_back(all_texts(limit));
  step.tags = all_texts(table.table("tags"));
  return step;
}

std::vector<RawStep> read_steps(TomlTable& table, std::string_view key, int retries) {
  std::vector<RawStep> steps;
  for (TomlTable& step : table.tables(key)) steps.push_back(read_step(step, retries));
  return steps;
}

// Unfolds loops into planned steps, each checked against the laboratory.
class Planner {
 public:
  Planner(const Document& document, Sequence& sequence) : document_(document), sequence_(sequence) {}

  void unfold(const std::vector<RawStep>& steps, Section section, const Variables& variables, const std::string& path,
              int depth = 0) {
    if (depth > kDepthMax) throw UserError(steps.front().place + ": blocks within blocks: expected fewer than 20 levels");
    for (const RawStep& step : steps) {
      if (step.has("for"))
        loop(step, section, variables, path, depth);
      else
        plan(step, section, variables, path);
    }
  }

 private:
  [[noreturn]] static void refuse(const RawStep& step, const std::string& key, const std::string& value,
                                  const std::string& expected) {
    throw UserError(fmt::format("{}: {} = \"{}\": expected {}", step.place, key, value, expected));
  }

  static std::string fill(const RawStep& step, const std::string& key, const std::string& text, const Variables& variables) {
    std::string result;
    for (std::size_t at = 0; at < text.size();) {
      if (text[at] != '{') {
        result += text[at++];
        continue;
      }
      const std::size_t end = text.find('}', at);
      const std::string name = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
      const auto found = variables.find(name);
      if (found == variables.end()) {
        std::vector<std::string> known;
        for (const auto& [variable, value] : variables) known.push_back("{" + variable + "}");
        refuse(step, key, text, known.empty() ? "no variable outside a loop" : fmt::format("one of {}", fmt::join(known, ", ")));
      }
      result += found->second;
      at = end + 1;
    }
    return result;
  }

  static std::string text(const RawStep& step, const std::string& key, const Variables& variables,
                          std::optional<std::string> fallback = {}) {
    const auto found = step.texts.find(key);
    if (found == step.texts.end()) {
      if (fallback) return *fallback;
      throw UserError(fmt::format("{}: {} is missing: expected it beside the step's verb", step.place, key));
    }
    return fill(step, key, found->second, variables);
  }

  static double quantity(const RawStep& step, const std::string& key, const std::string& base, const Variables& variables,
                         std::optional<std::string> fallback = {}) {
    return parse_quantity(text(step, key, variables, std::move(fallback)), base, step.place + ": " + key).si;
  }

  void loop(const RawStep& step, Section section, const Variables& variables, const std::string& path, int depth) {
    const std::string variable = step.texts.at("for"), block = text(step, "do", variables);
    const auto steps = document_.blocks.find(block);
    if (steps == document_.blocks.end()) refuse(step, "do", block, "the name of a block of this file");
    std::vector<ListItem> items;
    if (step.count > 0) {
      for (int i = 1; i <= step.count; ++i) items.push_back({std::to_string(i), {}});
    } else {
      for (const std::string& name : step.in) {
        const auto list = document_.lists.find(name);
        if (list == document_.lists.end()) refuse(step, "in", name, "the name of a list of this file");
        items.insert(items.end(), list->second.begin(), list->second.end());
      }
    }
    if (items.empty()) refuse(step, "for", variable, "in = [\"LIST\"] or count = N beside it");
    for (const ListItem& item : items) {
      Variables inner = variables;
      inner[variable] = item.name;
      for (const auto& [field, value] : item.fields) inner[variable + "." + field] = fill(step, field, value, variables);
      unfold(steps->second, section, inner, path + (path.empty() ? "" : "/") + variable + "=" + item.name, depth + 1);
    }
  }

  const Instrument& instrument_of(const RawStep& step, const std::string& key, const std::string& target, PlannedStep& planned) {
    const std::size_t dot = target.find('.');
    planned.instrument = target.substr(0, dot);
    planned.name = dot == std::string::npos ? "" : target.substr(dot + 1);
    const Instrument* instrument = sequence_.laboratory.instrument(planned.instrument);
    if (instrument == nullptr || planned.name.empty()) {
      std::vector<std::string> known;
      for (const Instrument& i : sequence_.laboratory.instruments) known.push_back(i.name);
      refuse(step, key, target, fmt::format("INSTRUMENT.NAME with one of {}", fmt::join(known, ", ")));
    }
    return *instrument;
  }

  void plan_set(const RawStep& step, const Variables& variables, PlannedStep& planned) {
    const std::string target = text(step, "set", variables);
    const Setting* setting = instrument_of(step, "set", target, planned).setting(planned.name);
    if (setting == nullptr) refuse(step, "set", target, "a setting of that instrument in the laboratory file");
    planned.value = text(step, "value", variables);
    if (setting->text) {
      planned.command_value = planned.value;
    } else if (!setting->choices.empty()) {
      const auto choice = setting->choices.find(planned.value);
      std::vector<std::string> words;
      for (const auto& [word, command] : setting->choices) words.push_back(word);
      if (choice == setting->choices.end()) refuse(step, "value", planned.value, fmt::format("one of {}", fmt::join(words, ", ")));
      planned.command_value = choice->second;
    } else {
      planned.value_si = parse_quantity(planned.value, setting->unit.base, step.place + ": value").si;
      if (planned.value_si < setting->low_si * (1 - 1e-12) - 1e-15 || planned.value_si > setting->high_si * (1 + 1e-12))
        refuse(step, "value", planned.value,
               fmt::format("{} from {} to {}", target, show_quantity(setting->low_si, setting->unit.base),
                           show_quantity(setting->high_si, setting->unit.base)));
      planned.command_value = fmt::format("{:.9g}", planned.value_si / setting->unit.factor);
    }
  }

  const Reading& reading_of(const RawStep& step, const std::string& key, const Variables& variables, PlannedStep& planned) {
    const std::string target = text(step, key, variables);
    const Reading* reading = instrument_of(step, key, target, planned).reading(planned.name);
    if (reading == nullptr) refuse(step, key, target, "a reading of that instrument in the laboratory file");
    return *reading;
  }

  void plan_until(const RawStep& step, const Variables& variables, PlannedStep& planned) {
    const std::string base = reading_of(step, "until", variables, planned).unit.base;
    planned.near_si = quantity(step, "near", base, variables);
    planned.within_si = quantity(step, "within", base, variables);
    planned.duration_s = quantity(step, "hold", "s", variables, "0 s");
    planned.poll_s = quantity(step, "poll", "s", variables, "10 s");
    planned.timeout_s = quantity(step, "timeout", "s", variables);
    planned.expected_s = quantity(step, "expect", "s", variables);
    if (planned.poll_s <= 0 || planned.timeout_s < planned.expected_s)
      refuse(step, "timeout", text(step, "timeout", variables), "at least what is expected, and poll above 0 s");
  }

  void plan_record(const RawStep& step, const Variables& variables, PlannedStep& planned) {
    planned.duration_s = planned.expected_s = quantity(step, "duration", "s", variables);
    planned.timeout_s = quantity(step, "timeout", "s", variables, "10 s");
    for (const std::string& port : step.ports) {
      planned.ports.push_back(fill(step, "record", port, variables));
      if (sequence_.laboratory.port(planned.ports.back()) == nullptr)
        refuse(step, "record", planned.ports.back(), "a port of the laboratory file");
    }
    for (const std::string& channel : step.channels) {
      const std::string name = fill(step, "channels", channel, variables);
      std::vector<std::string> known;
      for (const auto& c : sequence_.laboratory.unit.channels) known.push_back(c.name);
      if (name == "all")
        planned.channels = known;
      else if (sequence_.laboratory.unit.channel(name) == nullptr)
        refuse(step, "channels", name, fmt::format("\"all\" or some of {}", fmt::join(known, ", ")));
      else
        planned.channels.push_back(name);
    }
    for (const auto& [key, value] : step.tags) planned.tags[key] = fill(step, key, value, variables);
    planned.join = step.join;
    planned.keep = step.keep;
  }

  void plan_limits(const RawStep& step, const Variables& variables, const std::string& reading_base, PlannedStep& planned) {
    static const std::map<std::string, std::string> kRecorded = {
        {"lost", "1"}, {"temperature", "degC"}, {"temperature_span", "degC"}, {"current", "A"}, {"noise", "A"}};
    for (const auto& fields : step.limits) {
      Limit limit{"value", reading_base, -HUGE_VAL, HUGE_VAL};
      for (const auto& [key, value] : fields)
        if (key != "of" && key != "low" && key != "high") refuse(step, "limits." + key, value, "of, low or high");
      if (planned.verb == Verb::kRecord) {
        limit.of = fields.contains("of") ? fields.at("of") : "";
        const auto base = kRecorded.find(limit.of);
        if (base == kRecorded.end()) refuse(step, "limits.of", limit.of, "lost, temperature, temperature_span, current or noise");
        limit.base = base->second;
      }
      const auto bound = [&](const char* key, double& target) {
        if (fields.contains(key))
          target = parse_quantity(fill(step, key, fields.at(key), variables), limit.base, step.place + ": limits." + key).si;
      };
      bound("low", limit.low_si);
      bound("high", limit.high_si);
      planned.limits.push_back(limit);
    }
  }

  void plan(const RawStep& step, Section section, const Variables& variables, const std::string& path) {
    PlannedStep planned;
    planned.index = static_cast<int>(sequence_.plan.size());
    planned.section = section;
    planned.path = path;
    planned.where = step.place;
    planned.retries = step.retries;
    const std::string rule = text(step, "on_failure", variables, "abort");
    if (rule != "abort" && rule != "continue") refuse(step, "on_failure", rule, "abort or continue");
    planned.abort = rule == "abort";
    std::vector<std::string> verbs;
    for (const char* verb : {"set", "read", "wait", "until", "record", "prompt"})
      if (step.has(verb)) verbs.emplace_back(verb);
    if (verbs.size() != 1)
      throw UserError(step.place + ": expected one of set, read, wait, until, record, prompt, for in each step");
    std::string base = "1";
    if (verbs[0] == "set") {
      planned.verb = Verb::kSet;
      plan_set(step, variables, planned);
    } else if (verbs[0] == "read") {
      planned.verb = Verb::kRead;
      base = reading_of(step, "read", variables, planned).unit.base;
      for (const auto& [key, value] : step.tags) planned.tags[key] = fill(step, key, value, variables);
    } else if (verbs[0] == "wait") {
      planned.verb = Verb::kWait;
      planned.duration_s = planned.expected_s = quantity(step, "wait", "s", variables);
      if (planned.duration_s < 0) refuse(step, "wait", text(step, "wait", variables), "a time that is not negative");
    } else if (verbs[0] == "until") {
      planned.verb = Verb::kUntil;
      plan_until(step, variables, planned);
    } else if (verbs[0] == "record") {
      planned.verb = Verb::kRecord;
      plan_record(step, variables, planned);
    } else {
      planned.verb = Verb::kPrompt;
      planned.text = text(step, "prompt", variables);
      planned.unattended = text(step, "unattended", variables, "continue");
      planned.timeout_s = quantity(step, "timeout", "s", variables, "10 min");
      if (planned.unattended != "continue" && planned.unattended != "abort")
        refuse(step, "unattended", planned.unattended, "continue or abort");
    }
    plan_limits(step, variables, base, planned);
    if (sequence_.plan.size() >= kStepsMax) throw UserError(step.place + ": the plan has more than a million steps");
    sequence_.plan.push_back(std::move(planned));
  }

  const Document& document_;
  Sequence& sequence_;
};

Document read_document(TomlTable& root, int retries) {
  Document document;
  TomlTable lists = root.table("lists"), tables = root.table("tables");
  for (const std::string& name : lists.keys())
    for (const std::string& item : lists.texts(name, {})) document.lists[name].push_back({item, {}});
  for (const std::string& name : tables.keys()) {
    if (document.lists.contains(name)) tables.refuse(name, "a name that no list has");
    for (TomlTable& item : tables.tables(name)) {
      Variables fields;
      for (const std::string& key : item.keys()) fields[key] = item.text(key, {});
      document.lists[name].push_back({item.text("name", {}), std::move(fields)});
    }
  }
  TomlTable blocks = root.table("blocks");
  for (const std::string& name : blocks.keys()) document.blocks[name] = read_steps(blocks, name, retries);
  return document;
}

}  // namespace

const char* name_of(Verb verb) {
  switch (verb) {
    case Verb::kSet: return "set";
    case Verb::kRead: return "read";
    case Verb::kWait: return "wait";
    case Verb::kUntil: return "until";
    case Verb::kRecord: return "record";
    case Verb::kPrompt: return "prompt";
  }
  return "";
}

const char* name_of(Section section) {
  switch (section) {
    case Section::kSetup: return "setup";
    case Section::kSteps: return "steps";
    case Section::kTeardown: return "teardown";
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
  sequence.procedure = root.choice("procedure", {}, {"scale_factor", "bias", "none"});
  sequence.uninterrupted = root.boolean("uninterrupted", false);
  if (root.has("duration"))
    sequence.duration_s = parse_quantity(root.text("duration", {}), "s", root.place_of("duration") + ": duration").si;
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
  const int retries = static_cast<int>(root.integer("retries", 0, {0, 100}));   // where a step does not say
  const Document document = read_document(root, retries);
  Planner planner(document, sequence);
  for (const auto& [key, section] : {std::pair{"setup", Section::kSetup}, {"steps", Section::kSteps}, {"teardown", Section::kTeardown}})
    planner.unfold(read_steps(root, key, retries), section, {}, "");
  root.refuse_unknown_keys();
  if (sequence.plan.empty()) root.refuse("steps", "at least one step");
  if (sequence.duration_s > 0 && std::abs(sequence.expected_s() - sequence.duration_s) > kDurationTolerance * sequence.duration_s)
    root.refuse("duration", fmt::format("the plan's own {}, within 2 %", show_duration(sequence.expected_s())));
  return sequence;
}

std::string describe(const Sequence& sequence) {
  struct Line {
    const PlannedStep* first = nullptr;
    int count = 0;
    double time_s = 0;
    std::vector<std::string> values;
  };
  std::vector<Line> lines;   // steps of the same place in the file, folded
  std::map<std::string, std::size_t> line_of;
  std::vector<std::string> used;
  for (const PlannedStep& step : sequence.plan) {
    const std::string key = std::string(name_of(step.section)) + step.where;
    const auto [entry, added] = line_of.try_emplace(key, lines.size());
    if (added) lines.emplace_back().first = &step;
    Line& line = lines[entry->second];
    ++line.count;
    line.time_s += step.expected_s;
    const std::string value = step.verb == Verb::kSet ? step.value : step.verb == Verb::kRecord ? fmt::format("{}", fmt::join(step.channels, " ")) : "";
    if (!value.empty() && std::ranges::find(line.values, value) == line.values.end()) line.values.push_back(value);
    if (!step.instrument.empty() && std::ranges::find(used, step.instrument) == used.end()) used.push_back(step.instrument);
  }
  std::string text = fmt::format("{}\n{} steps, {}\n\nInstruments\n", sequence.title, sequence.plan.size(), show_duration(sequence.expected_s()));
  for (const std::string& name : used) {
    const Instrument& i = *sequence.laboratory.instrument(name);
    text += fmt::format("  {:<12} {:<20} {}\n", name, i.kind, i.address);
  }
  const char* section = "";
  for (const Line& line : lines) {
    const PlannedStep& step = *line.first;
    if (std::string_view(section) != name_of(step.section)) text += fmt::format("\n{}\n", section = name_of(step.section));
    std::string what;
    if (step.verb == Verb::kSet || step.verb == Verb::kRead) what = step.instrument + "." + step.name;
    if (step.verb == Verb::kUntil)
      what = fmt::format("{}.{} within {:g} of its target for {}, at most {}", step.instrument, step.name, step.within_si,
                         show_duration(step.duration_s), show_duration(step.timeout_s));
    if (step.verb == Verb::kWait) what = show_duration(step.duration_s);
    if (step.verb == Verb::kRecord) what = fmt::format("{} for {}:", fmt::join(step.ports, ", "), show_duration(step.duration_s));
    if (step.verb == Verb::kPrompt) what = "\"" + step.text + "\", unattended: " + step.unattended;
    const std::size_t shown = std::min<std::size_t>(line.values.size(), 4);
    if (shown > 0)
      what += fmt::format(" {}{}", fmt::join(line.values.begin(), line.values.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                          shown < line.values.size() ? fmt::format(", … ({} values)", line.values.size()) : "");
    text += fmt::format("  {:<7}{}{}{}\n", name_of(step.verb), what, line.count > 1 ? fmt::format("  x {}", line.count) : "",
                        line.time_s > 0 ? ", " + show_duration(line.time_s) : "");
  }
  return text;
}

}  // namespace waverig::rig::bench
