// The rig in three dimensions: towers, arm, gondola, sensor and the water it
// stands for, lit and antialiased.
//
// In deep water a particle of the surface runs on a circle (Gerstner 1804): the
// turning arm carries the gondola as such a particle, so the drawn water is the
// trochoidal wave whose particle it is. Its length is chosen for the picture; a
// wave of 12 s would be 225 m long. A run on a sea shows the buoy instead.
#pragma once
#include <memory>

#include "render/canvas.h"
#include "render/scene/rig_motion.h"
#include "render/scene/scene_parts.h"

namespace waverig::render {

struct SceneSettings {
  Theme theme = Theme::kPrint;
  double view_azimuth_rad = -0.42;  // of the camera about the vertical, 0: straight in front
  double view_height_rad = 0.24;    // above the horizon
  bool labels = true;
};

// One canvas's renderer of the scene; keeps buffers and targets from picture to
// picture.
class RigScene {
 public:
  RigScene(Canvas& canvas, const SceneSettings& settings);
  ~RigScene();

  // Font sizes and characters of the labels; before the canvas bakes its fonts.
  void prepare_fonts(float text_px);
  // Draws into the area of the target.
  void draw(const RigMotion& motion, const RigInstant& instant, const RenderTarget& target, const Rect& area,
            float text_px);

 private:
  struct Buffers;
  void draw_labels(const RigMotion& motion, const RigInstant& instant, const RenderTarget& target,
                   const Rect& area, float text_px);

  Canvas& canvas_;
  SceneSettings settings_;
  SceneParts parts_;
  Eigen::Matrix4d project_;  // scene to clip space, y down
  std::unique_ptr<Buffers> buffers_;
  std::unique_ptr<RenderTarget> large_;
};

}  // namespace waverig::render
