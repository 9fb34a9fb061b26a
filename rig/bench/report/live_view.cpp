#include "rig/bench/report/live_view.h"

#include <fmt/format.h>

#include "lcmtypes/atomic_file.h"
#include "render/figure_writer.h"
#include "rig/bench/report/figures.h"

namespace waverig::rig::bench {
namespace {

constexpr const char* kPage =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
    "content=\"width=device-width, initial-scale=1\"><meta http-equiv=\"refresh\" "
    "content=\"5\"><title>waverig bench</title>"
    "</head>\n<body style=\"margin:0\"><img src=\"live.png\" alt=\"The bench's graph windows\" "
    "style=\"max-width:100%\"></body></html>\n";

}  // namespace

LiveView::LiveView(const Sequence& sequence, std::filesystem::path out, std::chrono::milliseconds refresh)
    : sequence_(sequence),
      out_(std::move(out)),
      refresh_(refresh),
      traces_(sequence.laboratory.unit,
              sequence.laboratory.port(sequence.laboratory.unit.counts_port)->layout) {}

void LiveView::take_over(const Store& store) {
  for (const TraceRow& row : store.trace()) traces_.add(row);
}

void LiveView::add(const TraceRow& row) {
  traces_.add(row);
  changed_ = true;
  draw_if_due();
}

void LiveView::show(const Progress& progress) {
  status_ = fmt::format("Step {} of {}: {} {}; {} left{}", progress.step->index + 1, progress.steps,
                        as_read(progress.step->path), as_read(describe_action(*progress.step)),
                        show_duration(progress.remaining_s),
                        progress.alarm.empty() ? "" : "; alarm: " + progress.alarm);
}

void LiveView::draw_if_due() {
  const auto now = std::chrono::steady_clock::now();
  if (!changed_ || now - drawn_ < refresh_) return;
  drawn_ = now;
  draw();
}

void LiveView::draw() {
  changed_ = false;
  if (sequence_.windows.empty()) return;
  const auto& png =
      render::png_bytes(windows_figure(sequence_.windows, traces_, sequence_.title, status_), canvas_, {});
  write_atomically(out_ / "live.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  if (!std::filesystem::exists(out_ / "live.html")) write_atomically(out_ / "live.html", kPage);
}

}  // namespace waverig::rig::bench
