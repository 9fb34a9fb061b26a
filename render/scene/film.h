// The rig in motion, with the live traces beside it: single pictures and films.
#pragma once
#include <filesystem>
#include <functional>

#include "render/figure_writer.h"
#include "render/scene/rig_scene.h"
#include "render/scene/video_writer.h"

namespace waverig::render {

struct FilmSettings {
  int width_px = 1280, height_px = 720;
  int frames_per_s = 30;
  double begin_s = kAuto,
         duration_s = kAuto;  // of the record; by default two periods from the
                              // steady part's start
  double speed = 1;           // record seconds per film second
  Theme theme = Theme::kDark;
  Provenance provenance{};
};

// Draws frames of one run; one thread's. Scene on the left, traces on the
// right.
class FilmFrames {
 public:
  FilmFrames(Canvas& canvas, const RigMotion& motion, const FilmSettings& settings);
  // The picture stays until the next one.
  const Image& at(double time_s);
  // The traces beside the scene.
  Figure traces(double time_s) const;

 private:
  Canvas& canvas_;
  const RigMotion& motion_;
  FilmSettings settings_;
  RigScene scene_;
  RenderTarget target_;
  float text_px_;
};

// Frame times of a film; throws UserError where begin, duration or speed make
// none.
std::vector<double> frame_times_s(const RigMotion& motion, const FilmSettings& settings);

// progress(frames done, frames in all) may be empty. Draws on one thread while
// another encodes.
void write_film(const RigMotion& motion, const FilmSettings& settings, const std::filesystem::path& path,
                const std::function<void(std::size_t, std::size_t)>& progress);

// A still of the rig alone, as PNG.
void save_rig_picture(const RigMotion& motion, double time_s, Canvas& canvas,
                      const std::filesystem::path& path, Theme theme, const Provenance& provenance);

}  // namespace waverig::render
