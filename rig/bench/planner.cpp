#include "rig/bench/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "lcmtypes/error.h"

namespace waverig::rig::bench {
namespace {

constexpr std::size_t kStepsMax = 1'000'000;
constexpr double kLongest_s = 366 * 86400.0;  // of a step
constexpr int kDepthMax = 20;

class Planner {
 public:
  Planner(const Document& document, Sequence& sequence) : document_(document), sequence_(sequence) {}

  void unfold(const std::vector<RawStep>& steps, Section section, const Variables& variables,
              const std::string& path, int depth = 0) {
    if (depth > kDepthMax)
      throw UserError(steps.front().place + ": blocks within blocks: expected fewer than 20 levels");
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

  static std::string fill(const RawStep& step, const std::string& key, const std::string& text,
                          const Variables& variables) {
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
        refuse(
            step, key, text,
            known.empty() ? "no variable outside a loop" : fmt::format("one of {}", fmt::join(known, ", ")));
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

  static double quantity(const RawStep& step, const std::string& key, const std::string& base,
                         const Variables& variables, std::optional<std::string> fallback = {}) {
    const std::string given = text(step, key, variables, std::move(fallback));
    const double si = parse_quantity(given, base, step.place + ": " + key).si;
    if (base == "s" && !(si >= 0 && si <= kLongest_s))
      refuse(step, key, given, "a time that is not negative, of a year at most");
    return si;
  }

  void loop(const RawStep& step, Section section, const Variables& variables, const std::string& path,
            int depth) {
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
      for (const auto& [field, value] : item.fields)
        inner[variable + "." + field] = fill(step, field, value, variables);
      unfold(steps->second, section, inner, path + (path.empty() ? "" : "/") + variable + "=" + item.name,
             depth + 1);
    }
  }

  const Instrument& instrument_of(const RawStep& step, const std::string& key, const std::string& target,
                                  PlannedStep& planned) {
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
    if (setting == nullptr)
      refuse(step, "set", target, "a setting of that instrument in the laboratory file");
    planned.value = text(step, "value", variables);
    if (setting->text) {
      planned.command_value = planned.value;
    } else if (!setting->choices.empty()) {
      const auto choice = setting->choices.find(planned.value);
      std::vector<std::string> words;
      for (const auto& [word, command] : setting->choices) words.push_back(word);
      if (choice == setting->choices.end())
        refuse(step, "value", planned.value, fmt::format("one of {}", fmt::join(words, ", ")));
      planned.command_value = choice->second;
    } else {
      planned.value_si = parse_quantity(planned.value, setting->unit.base, step.place + ": value").si;
      if (planned.value_si < setting->low_si * (1 - 1e-12) - 1e-15 ||
          planned.value_si > setting->high_si * (1 + 1e-12))
        refuse(step, "value", planned.value,
               fmt::format("{} from {} to {}", target, show_quantity(setting->low_si, setting->unit.base),
                           show_quantity(setting->high_si, setting->unit.base)));
      planned.command_value = fmt::format("{:.9g}", planned.value_si / setting->unit.factor);
    }
  }

  const Reading& reading_of(const RawStep& step, const std::string& key, const Variables& variables,
                            PlannedStep& planned) {
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
      refuse(step, "timeout", text(step, "timeout", variables),
             "at least what is expected, and poll above 0 s");
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

  void plan_limits(const RawStep& step, const Variables& variables, const std::string& reading_base,
                   PlannedStep& planned) {
    static const std::map<std::string, std::string> kRecorded = {{"lost", "1"},
                                                                 {"temperature", "degC"},
                                                                 {"temperature_span", "degC"},
                                                                 {"current", "A"},
                                                                 {"noise", "A"}};
    for (const auto& fields : step.limits) {
      Limit limit{"value", reading_base, -HUGE_VAL, HUGE_VAL};
      for (const auto& [key, value] : fields)
        if (key != "of" && key != "low" && key != "high")
          refuse(step, "limits." + key, value, "of, low or high");
      if (planned.verb == Verb::kRecord) {
        limit.of = fields.contains("of") ? fields.at("of") : "";
        const auto base = kRecorded.find(limit.of);
        if (base == kRecorded.end())
          refuse(step, "limits.of", limit.of, "lost, temperature, temperature_span, current or noise");
        limit.base = base->second;
      }
      const auto bound = [&](const char* key, double& target) {
        if (fields.contains(key))
          target = parse_quantity(fill(step, key, fields.at(key), variables), limit.base,
                                  step.place + ": limits." + key)
                       .si;
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
      throw UserError(step.place +
                      ": expected one of set, read, wait, until, record, prompt, for in each step");
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
    if (sequence_.plan.size() >= kStepsMax)
      throw UserError(step.place + ": the plan has more than a million steps");
    sequence_.plan.push_back(std::move(planned));
  }

  const Document& document_;
  Sequence& sequence_;
};

}  // namespace

void unfold(const Document& document, const std::vector<RawStep>& steps, Section section,
            Sequence& sequence) {
  Planner(document, sequence).unfold(steps, section, {}, "");
}

}  // namespace waverig::rig::bench
