// LiveView: the sequence's graph windows as a picture that is drawn anew while the bench runs (live.png,
// replaced whole, and live.html that shows it and loads it again).
#pragma once
#include <chrono>
#include <filesystem>
#include <string>

#include "render/canvas.h"
#include "rig/bench/report/traces.h"
#include "rig/bench/runner.h"

namespace waverig::rig::bench {

class LiveView {
 public:
  // refresh: of real time between two pictures.
  LiveView(const Sequence& sequence, std::filesystem::path out, std::chrono::milliseconds refresh);

  void take_over(const Store& store);  // what a run that is gone on with has behind it
  void add(const TraceRow& row);
  void show(const Progress& progress);  // for the line below the title
  void draw();

 private:
  void draw_if_due();

  const Sequence& sequence_;
  std::filesystem::path out_;
  std::chrono::milliseconds refresh_;
  std::chrono::steady_clock::time_point drawn_;
  Traces traces_;
  render::Canvas canvas_;
  std::string status_;
  bool changed_ = false;
};

}  // namespace waverig::rig::bench
