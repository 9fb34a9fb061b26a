// Triangles of the rig's picture: boxes, cylinders and a sheet of water, in
// metres. Scene frame: x along the arm's azimuth (right in the picture), y away
// from the viewer, z up; origin at the shaft.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "render/color.h"

namespace waverig::render {

using Eigen::Isometry3d;
using Eigen::Vector3d;

struct MeshVertex {
  float position[3];
  float normal[3];
  float color[4];
};

struct Mesh {
  std::vector<MeshVertex> vertices;
  std::vector<std::uint32_t> indices;

  void clear();
  // A box of the given full sizes about the pose's origin.
  void add_box(const Isometry3d& pose, const Vector3d& size_m, Color color);
  // A straight bar between two points, round, with flat ends.
  void add_rod(const Vector3d& from, const Vector3d& to, double radius_m, Color color);
  // A surface over a grid of columns x rows points, row by row; normals from
  // its neighbours.
  void add_sheet(const std::vector<Vector3d>& points, std::size_t columns, Color color);

  // What another mesh leaves of the light on the floor; towards_lamp points up.
  void add_shadow(const Mesh& of, const Vector3d& towards_lamp, double floor_m, Color color);

 private:
  std::uint32_t add_vertex(const Vector3d& position, const Vector3d& normal, Color color);
};

}  // namespace waverig::render
