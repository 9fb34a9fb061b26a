// What stands in the scene at an instant, as triangles: the rig or the buoy, the floor and the water. Frame
// of mesh.h.
#pragma once
#include <cstddef>
#include <vector>

#include "render/figure.h"
#include "render/scene/mesh.h"
#include "render/scene/rig_motion.h"

namespace waverig::render {

class SceneParts {
 public:
  explicit SceneParts(Theme theme) : theme_(theme) {}

  void build(const RigMotion& motion, const RigInstant& at);  // in place of what stood there
  Mesh solid, clear;                                          // opaque, and what is seen through

  static Vector3d towards_lamp();  // of length one

 private:
  void build_rig(const RigMotion& motion, const RigInstant& at);
  void build_buoy(const RigMotion& motion, const RigInstant& at);
  void add_floor(double reach_m, double floor_m);
  void add_water(const std::vector<Vector3d>& surface, std::size_t columns, double floor_m);

  Theme theme_;
};

}  // namespace waverig::render
