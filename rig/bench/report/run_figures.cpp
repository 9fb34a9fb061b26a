// How a run went: live windows, temperature profile, procedure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "motion/kinematics/frames.h"
#include "rig/bench/report/figures.h"

namespace waverig::rig::bench {
std::string as_read(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, "\u2212");
  for (const auto& [ascii, read] : {std::pair{"degC", "°C"}, {" uA", " µA"}, {" uV", " µV"}})
    if (const std::size_t at = text.find(ascii); at != std::string::npos)
      text.replace(at, std::strlen(ascii), read);
  return text;
}

namespace {

using render::Axis;
using render::Bars;
using render::Figure;
using render::Line;
using render::Panel;

constexpr double kHour_s = 3600;

double hours(std::int64_t utime, std::int64_t start_utime) {
  return static_cast<double>(utime - start_utime) * kMicrosecond / kHour_s;
}

// From 0: the first thing that is shown happens a little later.
Axis since_beginning() { return {.label = "Time since the beginning", .unit = "h", .low = 0, .padding = 0}; }

struct CurrentUnit {
  const char* name;
  double factor;
};

CurrentUnit unit_for(double largest_A) {
  if (largest_A >= 1e-3) return {"mA", 1e3};
  if (largest_A >= 1e-6) return {"µA", 1e6};
  return {"nA", 1e9};
}

Panel window_panel(const LiveWindow& window, const Traces& traces) {
  Panel panel{.title = window.title,
              .x = {.label = "Time", .scale = render::Scale::kTime, .padding = 0},
              .legend = render::Legend::kAbove};
  double largest_A = 0;
  for (const std::string& channel : window.channels) {
    if (channel == "temperature") continue;
    for (const double i : traces.current_A(channel))
      if (std::isfinite(i)) largest_A = std::max(largest_A, std::abs(i));
  }
  const CurrentUnit unit = unit_for(largest_A);
  for (const std::string& channel : window.channels) {
    Line line{.x = traces.time_s(), .name = channel};
    if (channel == "temperature") {
      panel.y = {.label = "Unit", .unit = "°C"};
      line.y = traces.temperature_degC();
    } else {
      panel.y = {.label = "Current", .unit = unit.name};
      for (const double i : traces.current_A(channel)) line.y.push_back(unit.factor * i);
    }
    panel.marks.emplace_back(std::move(line));
  }
  if (window.channels.size() == 1) panel.legend = render::Legend::kNone;
  return panel;
}

// Steps that were carried out to the end, the last attempt of each.
std::map<int, StepRow> finished_steps(const Store& store) {
  std::map<int, StepRow> rows;
  for (StepRow& row : store.steps())
    if (row.outcome == StepOutcome::kDone || row.outcome == StepOutcome::kAccepted)
      rows.insert_or_assign(row.index, std::move(row));
  return rows;
}

std::string variable(const std::string& path, std::string_view name) {  // "temperature=5 degC/channel=…"
  const std::string key = std::string(name) + "=";
  const std::size_t at = path.starts_with(key)                       ? 0
                         : path.find("/" + key) == std::string::npos ? std::string::npos
                                                                     : path.find("/" + key) + 1;
  if (at == std::string::npos) return "";
  const std::size_t from = at + key.size();
  return path.substr(from, path.find('/', from) - from);
}

// A row a category, a bar from the beginning to the end of everything that belongs to it.
class Gantt {
 public:
  void add(const std::string& category, const std::string& series, double from, double to) {
    const auto row = std::ranges::find(categories_, category);
    const double at = static_cast<double>(row - categories_.begin());
    if (row == categories_.end()) categories_.push_back(category);
    auto bars = std::ranges::find(bars_, series, &Bars::name);
    if (bars == bars_.end())
      bars = bars_.insert(bars_.end(), {.name = series, .width = 0.7, .horizontal = true});
    bars->at.push_back(at);
    bars->base.push_back(from);
    bars->value.push_back(to);
  }
  Panel panel(std::string title, Axis x) const {
    Panel p{.title = std::move(title),
            .x = std::move(x),
            .y = {.categories = categories_},
            .legend = render::Legend::kAbove};
    // The first category on top.
    std::ranges::reverse(p.y.categories);
    for (Bars bars : bars_) {
      for (double& at : bars.at) at = static_cast<double>(categories_.size()) - 1 - at;
      p.marks.emplace_back(std::move(bars));
    }
    return p;
  }

 private:
  std::vector<std::string> categories_;
  std::vector<Bars> bars_;
};

Panel whole_procedure(const Sequence& sequence, const std::map<int, StepRow>& steps, std::int64_t start) {
  struct Block {
    double from, to;
    std::string series;
  };
  std::vector<std::pair<std::string, Block>> blocks;  // neighbouring recordings of one channel are one
  for (const auto& [index, row] : steps) {
    const PlannedStep& step = sequence.plan[static_cast<std::size_t>(index)];
    if (step.verb != Verb::kRecord && step.verb != Verb::kUntil) continue;
    const std::string channel = variable(row.path, "channel"),
                      temperature = variable(row.path, "temperature");
    const std::string category = step.verb == Verb::kUntil ? "settle"
                                 : !channel.empty()        ? channel
                                                           : row.path.substr(0, row.path.find('='));
    const double from = hours(row.started_utime, start), to = hours(row.ended_utime, start);
    const std::string series = as_read(temperature);
    if (!blocks.empty() && blocks.back().first == category && blocks.back().second.series == series)
      blocks.back().second.to = to;
    else
      blocks.push_back({category, {from, to, series}});
  }
  Gantt gantt;
  for (const auto& [category, block] : blocks) gantt.add(category, block.series, block.from, block.to);
  return gantt.panel("(a) The whole run", since_beginning());
}

// The settings of the first channel at the first temperature.
std::optional<Panel> one_channel(const Sequence& sequence, const std::map<int, StepRow>& steps) {
  Gantt gantt;
  std::string block, channel;
  std::int64_t start = 0;
  for (const auto& [index, row] : steps) {
    const std::string setting = variable(row.path, "setting");
    if (setting.empty()) continue;
    const std::string own = row.path.substr(0, row.path.find("/setting="));
    if (block.empty()) {
      block = own;
      channel = variable(row.path, "channel");
      start = row.started_utime;
    }
    if (own != block) break;
    const bool records = sequence.plan[static_cast<std::size_t>(index)].verb == Verb::kRecord;
    gantt.add(as_read(setting), records ? "recording" : "setting and settling",
              60 * hours(row.started_utime, start), 60 * hours(row.ended_utime, start));
  }
  if (block.empty()) return std::nullopt;
  return gantt.panel(fmt::format("(b) The settings of {}", channel),
                     {.label = "Time since its first setting", .unit = "min", .low = 0, .padding = 0});
}

}  // namespace

Figure windows_figure(const std::vector<LiveWindow>& windows, const Traces& traces, const std::string& title,
                      const std::string& subtitle) {
  Figure figure{.title = title,
                .subtitle = subtitle,
                .share_x = true,
                .height_mm = 30 + 50.0 * static_cast<double>(windows.size())};
  for (const LiveWindow& window : windows) figure.panels.push_back(window_panel(window, traces));
  return figure;
}

Figure temperature_figure(const Sequence& sequence, const Store& store, const Traces& traces) {
  const std::int64_t start = store.info().started_utime;
  Figure figure{.title = "Temperature profile", .subtitle = sequence.title, .height_mm = 85};
  Panel panel{
      .x = since_beginning(), .y = {.label = "Temperature", .unit = "°C"}, .legend = render::Legend::kAbove};
  Line unit{.name = "unit", .look = {.color = 0}},
      target{.name = "chamber, told", .look = {.color = render::kFaintInk, .dash = render::Dash::kDashed}};
  for (std::size_t i = 0; i < traces.time_s().size(); ++i) {
    unit.x.push_back(traces.time_s()[i] / kHour_s - static_cast<double>(start) * kMicrosecond / kHour_s);
    unit.y.push_back(traces.temperature_degC()[i]);
  }
  render::Points recorded{.name = "recordings",
                          .look = {.color = 1, .marker = render::Marker::kCircle, .marker_pt = 2}};
  for (const RecordingRow& row : store.recordings()) {
    if (row.port != sequence.laboratory.unit.counts_port) continue;
    recorded.x.push_back(hours(row.start_utime, start));
    recorded.y.push_back(row.temperature);
  }
  double last = render::kAuto;
  for (const StepRow& row : store.steps()) {
    const PlannedStep& step = sequence.plan[static_cast<std::size_t>(row.index)];
    const double now = hours(row.ended_utime, start);
    if (step.verb == Verb::kSet && step.instrument == "chamber" && step.name == "temperature") {
      target.x.insert(target.x.end(), {now, now});
      target.y.insert(target.y.end(), {last, step.value_si});
      last = step.value_si;
    }
    if (!target.x.empty()) {
      target.x.push_back(now);
      target.y.push_back(last);
    }
  }
  panel.marks = {std::move(target), std::move(unit), std::move(recorded)};
  figure.panels.push_back(std::move(panel));
  return figure;
}

Figure procedure_figure(const Sequence& sequence, const Store& store) {
  const std::map<int, StepRow> steps = finished_steps(store);
  Figure figure{.title = "Procedure", .subtitle = sequence.title, .height_mm = 90};
  figure.panels.push_back(whole_procedure(sequence, steps, store.info().started_utime));
  if (std::optional<Panel> settings = one_channel(sequence, steps)) {
    figure.panels.push_back(std::move(*settings));
    figure.height_mm = 190;
    figure.row_heights = {1, 1.4};
  }
  return figure;
}

}  // namespace waverig::rig::bench
