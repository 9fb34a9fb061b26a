#include "render/scene/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "lcmtypes/error.h"

namespace waverig::render {
namespace {

constexpr double kSceneShare = 0.58;  // of a frame's width
constexpr double kWindowPeriods = 2;  // of the traces
constexpr double kMostFrames = 1e6;   // nine hours
constexpr double kDotsPerInch = 72;   // a figure of this resolution has a pixel a point

int even(double px) { return 2 * static_cast<int>(px / 2); }

// The samples of a window, as they were up to now. Before the first of all stands that one, a point that
// shows nothing: a film's beginning lacks no data.
template <class Sample, class Value>
Line line_of(const std::vector<Sample>& samples, std::int64_t start, double from_s, double to_s,
             Value value) {
  Line line;
  const auto utime = [&](double s) { return start + std::llround(s / kMicrosecond); };
  auto it = std::lower_bound(samples.begin(), samples.end(), utime(from_s),
                             [](const Sample& s, std::int64_t t) { return s.utime < t; });
  for (; it != samples.end() && (it->utime <= utime(to_s) || it == samples.begin()); ++it) {
    line.x.push_back(static_cast<double>(it->utime - start) * kMicrosecond);
    line.y.push_back(value(*it));
  }
  return line;
}

}  // namespace

FilmFrames::FilmFrames(Canvas& canvas, const RigMotion& motion, const FilmSettings& settings)
    : canvas_(canvas),
      motion_(motion),
      settings_(settings),
      scene_(canvas, {.theme = settings.theme}),
      target_(settings.width_px, settings.height_px, false),
      text_px_(std::max(9.0F, static_cast<float>(settings.height_px) / 48)) {
  scene_.prepare_fonts(text_px_);
}

Figure FilmFrames::traces(double time_s) const {
  const evaluation::RunRecord& run = motion_.run();
  const double window_s = kWindowPeriods * std::max(1.0, run.period_s);
  const double from_s = std::max(0.0, time_s - window_s), amplitude_cm = 100 * motion_.radius_m();
  Figure figure{
      .columns = 1,
      .share_x = true,
      .width_mm = (settings_.width_px - even(kSceneShare * settings_.width_px)) / kDotsPerInch * 25.4,
      .height_mm = settings_.height_px / kDotsPerInch * 25.4,
      .dots_per_inch = kDotsPerInch,
      .theme = settings_.theme,
      .text_scale = static_cast<double>(text_px_) / 7.5 * 0.88};
  const double width_scale = figure.text_scale;
  const Axis time{.label = "Time", .unit = "s", .low = from_s, .high = from_s + window_s};
  const auto panel = [&](const char* title, const char* unit, double low, double high) {
    Panel p{
        .title = title, .x = time, .y = {.unit = unit, .low = low, .high = high}, .legend = Legend::kNone};
    return p;
  };
  const auto add = [&](Panel& p, Line line, int color, double width, Dash dash = Dash::kSolid) {
    line.look = {.color = color, .width_pt = width * width_scale, .dash = dash};
    p.marks.emplace_back(std::move(line));
  };
  const auto* heave = run.heave.contains(motion_.method()) ? &run.heave.at(motion_.method()) : nullptr;
  const auto start = run.start_utime;

  Panel heave_panel = panel("Heave: truth, and estimate", "cm", -1.35 * amplitude_cm, 1.35 * amplitude_cm);
  add(heave_panel, line_of(run.truth, start, from_s, time_s, [](const auto& s) { return 100 * s.heave_m; }),
      kInk, 1.6);
  if (heave != nullptr) {
    Line estimate = line_of(*heave, start, from_s, time_s, [](const auto& s) { return 100 * s.heave_m; });
    const double offset = 100 * motion_.heave_offset_m();
    for (double& y : estimate.y) y -= offset;
    add(heave_panel, std::move(estimate), motion_.color(), 1.3, Dash::kDashed);
  }
  Panel tilt_panel = panel("Pitch: truth, and estimate", "\u00B0", kAuto, kAuto);
  const auto pitch_deg = [](const Quaterniond& q) { return euler_of(q).pitch_rad / kDegree; };
  add(tilt_panel, line_of(run.truth, start, from_s, time_s, [&](const auto& s) { return pitch_deg(s.q_NB); }),
      kInk, 1.6);
  if (heave != nullptr)
    add(tilt_panel, line_of(*heave, start, from_s, time_s, [&](const auto& s) { return pitch_deg(s.q_NB); }),
        motion_.color(), 1.3, Dash::kDashed);
  // Tilt is small beside noise: the axis keeps still.
  double largest_deg = 1;
  for (const evaluation::TruthSample& s : run.truth)
    largest_deg = std::max(largest_deg, std::abs(pitch_deg(s.q_NB)));
  tilt_panel.y.low = -1.4 * largest_deg;
  tilt_panel.y.high = 1.4 * largest_deg;

  Panel force_panel = panel("Specific force", "m/s\u00B2", kAuto, kAuto);
  double largest_mps2 = 0.05;
  for (std::size_t i = 0; i < run.imu.size(); i += 16)
    largest_mps2 = std::max(largest_mps2, std::abs(run.imu[i].f_B.z() + kStandardGravity));
  force_panel.y.low = -1.3 * largest_mps2;
  force_panel.y.high = 1.3 * largest_mps2;
  force_panel.legend = Legend::kAbove;
  Line forward = line_of(run.imu, start, from_s, time_s, [](const auto& s) { return s.f_B.x(); });
  Line down =
      line_of(run.imu, start, from_s, time_s, [](const auto& s) { return s.f_B.z() + kStandardGravity; });
  forward.name = "x (forward)";
  down.name = "z (down) + g";
  add(force_panel, std::move(forward), axis_color(0), 0.8);
  add(force_panel, std::move(down), axis_color(2), 0.8);
  figure.panels = {std::move(heave_panel), std::move(tilt_panel), std::move(force_panel)};
  return figure;
}

const Image& FilmFrames::at(double time_s) {
  const int split = even(kSceneShare * settings_.width_px);
  const float height = static_cast<float>(settings_.height_px);
  const Figure figure = traces(time_s);
  ::waverig::render::prepare_fonts(figure, canvas_.fonts());
  const Color background = theme_colors(settings_.theme).background;
  canvas_.context().make_current();
  target_.bind();
  glDisable(GL_SCISSOR_TEST);
  glClearColor(background.r, background.g, background.b, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  scene_.draw(motion_, motion_.at(time_s), target_, {0, 0, static_cast<float>(split), height}, text_px_);
  canvas_.draw_over(target_, {static_cast<float>(split), 0, static_cast<float>(settings_.width_px), height},
                    [&](Painter& painter) { paint(figure, painter, canvas_.fonts()); });
  return canvas_.read(target_);
}

std::vector<double> frame_times_s(const RigMotion& motion, const FilmSettings& settings) {
  const double begin_s = std::isfinite(settings.begin_s) ? settings.begin_s : motion.begin_s();
  const double period_s = motion.run().period_s > 0 ? motion.run().period_s : 10;
  double duration_s = std::isfinite(settings.duration_s) ? settings.duration_s : 2 * period_s;
  const double last_s =
      static_cast<double>(motion.run().truth.back().utime - motion.run().start_utime) * kMicrosecond;
  if (!(begin_s >= 0) || begin_s >= last_s)
    throw UserError(
        fmt::format("--begin {:g}: expected seconds within the record of {:.1f} s", begin_s, last_s));
  if (!(duration_s > 0)) throw UserError(fmt::format("--seconds {:g}: more than 0 s expected", duration_s));
  if (!(settings.speed > 0))
    throw UserError(fmt::format("--speed {:g}: more than 0 expected", settings.speed));
  duration_s = std::min(duration_s, last_s - begin_s);
  std::vector<double> times_s;
  const double step_s = settings.speed / settings.frames_per_s;
  if (!(duration_s / step_s < kMostFrames))
    throw UserError(fmt::format("--speed {:g}: {:.3g} frames; expected a film of less than {:g}",
                                settings.speed, duration_s / step_s, kMostFrames));
  for (double t = 0; t < duration_s - 1e-9; t = step_s * static_cast<double>(times_s.size()))
    times_s.push_back(begin_s + t);
  if (times_s.empty()) times_s.push_back(begin_s);  // of a moment
  return times_s;
}

void write_film(const RigMotion& motion, const FilmSettings& settings, const std::filesystem::path& path,
                const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::vector<double> times_s = frame_times_s(motion, settings);
  VideoWriter video(path, {.width_px = settings.width_px,
                           .height_px = settings.height_px,
                           .frames_per_s = settings.frames_per_s,
                           .title = "waverig run " + motion.run().run,
                           .comment = fmt::format("waverig {}; seed {}; {}", settings.provenance.version,
                                                  settings.provenance.seed, settings.provenance.command)});
  // One thread draws, the caller's encodes; a few frames may wait between them.
  constexpr std::size_t kMostWaiting = 3;
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Image> waiting;
  std::exception_ptr failure;
  bool drawn = false, stop = false;
  std::jthread painter([&] {
    try {
      Canvas canvas;
      FilmFrames frames(canvas, motion, settings);
      for (const double t : times_s) {
        Image frame = frames.at(t);
        std::unique_lock lock(mutex);
        changed.wait(lock, [&] { return waiting.size() < kMostWaiting || stop; });
        if (stop) return;
        waiting.push_back(std::move(frame));
        changed.notify_all();
      }
    } catch (...) {
      const std::scoped_lock lock(mutex);
      failure = std::current_exception();
    }
    const std::scoped_lock lock(mutex);
    drawn = true;
    changed.notify_all();
  });
  try {
    for (std::size_t done = 0;;) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return !waiting.empty() || drawn; });
      if (waiting.empty()) break;
      const Image frame = std::move(waiting.front());
      waiting.pop_front();
      changed.notify_all();
      lock.unlock();
      video.add(frame);
      if (progress) progress(++done, times_s.size());
    }
  } catch (...) {
    const std::scoped_lock lock(mutex);
    stop = true;
    changed.notify_all();
    throw;
  }
  if (failure) std::rethrow_exception(failure);
  video.finish();
}

void save_rig_picture(const RigMotion& motion, double time_s, Canvas& canvas,
                      const std::filesystem::path& path, Theme theme, const Provenance& provenance) {
  constexpr int kWidth = 1400, kHeight = 1000;
  constexpr float kText = 24;
  RigScene scene(canvas, {.theme = theme});
  scene.prepare_fonts(kText);
  const RenderTarget target(kWidth, kHeight, false);
  scene.draw(motion, motion.at(time_s), target, {0, 0, kWidth, kHeight}, kText);
  PngSettings settings{.dots_per_inch = 200,
                       .text = embedded_text("The rig in run " + motion.run().run, provenance)};
  const std::vector<std::uint8_t>& bytes = canvas.png().encode(canvas.read(target), settings);
  write_file(path, bytes.data(), bytes.size());
}

}  // namespace waverig::render
