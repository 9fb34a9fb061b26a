#include "render/scene/mesh.h"

#include <array>
#include <cmath>
#include <numbers>

namespace waverig::render {

void Mesh::clear() {
  vertices.clear();
  indices.clear();
}

std::uint32_t Mesh::add_vertex(const Vector3d& p, const Vector3d& n, Color c) {
  const auto f = [](double v) { return static_cast<float>(v); };
  vertices.push_back({{f(p.x()), f(p.y()), f(p.z())}, {f(n.x()), f(n.y()), f(n.z())}, {c.r, c.g, c.b, c.a}});
  return static_cast<std::uint32_t>(vertices.size() - 1);
}

void Mesh::add_box(const Isometry3d& pose, const Vector3d& size, Color color) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const Vector3d n = side * Vector3d::Unit(axis), u = Vector3d::Unit((axis + 1) % 3),
                     v = Vector3d::Unit((axis + 2) % 3);
      const auto corner = [&](double a, double b) {
        return add_vertex(pose * (0.5 * size.cwiseProduct(n + a * u + b * v)), pose.linear() * n, color);
      };
      const std::uint32_t i = corner(-1, -1);
      corner(1, -1);
      corner(1, 1);
      corner(-1, 1);
      indices.insert(indices.end(), {i, i + 1, i + 2, i, i + 2, i + 3});
    }
  }
}

void Mesh::add_rod(const Vector3d& from, const Vector3d& to, double radius, Color color) {
  constexpr int kSides = 20;
  const Vector3d along = (to - from).normalized();
  const Vector3d u = along.unitOrthogonal(), v = along.cross(u);
  for (int k = 0; k < kSides; ++k) {
    const auto around = [&](int i) {
      const double angle = 2 * std::numbers::pi * i / kSides;
      return Vector3d(std::cos(angle) * u + std::sin(angle) * v);
    };
    const Vector3d a = around(k), b = around(k + 1);
    const std::uint32_t i = add_vertex(from + radius * a, a, color);
    add_vertex(from + radius * b, b, color);
    add_vertex(to + radius * b, b, color);
    add_vertex(to + radius * a, a, color);
    indices.insert(indices.end(), {i, i + 1, i + 2, i, i + 2, i + 3});
    for (const auto& [end, normal] : {std::pair(from, Vector3d(-along)), std::pair(to, along)}) {
      const std::uint32_t j = add_vertex(end, normal, color);
      add_vertex(end + radius * a, normal, color);
      add_vertex(end + radius * b, normal, color);
      indices.insert(indices.end(), {j, j + 1, j + 2});
    }
  }
}

void Mesh::add_sheet(const std::vector<Vector3d>& points, std::size_t columns, Color color) {
  if (columns < 2 || points.size() < 2 * columns) return;
  const std::size_t rows = points.size() / columns;
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (std::size_t r = 0; r < rows; ++r) {
    for (std::size_t c = 0; c < columns; ++c) {
      const auto at = [&](std::size_t row, std::size_t column) { return points[row * columns + column]; };
      const Vector3d dx = at(r, std::min(c + 1, columns - 1)) - at(r, c > 0 ? c - 1 : 0);
      const Vector3d dy = at(std::min(r + 1, rows - 1), c) - at(r > 0 ? r - 1 : 0, c);
      add_vertex(at(r, c), dx.cross(dy).normalized(), color);
    }
  }
  for (std::uint32_t r = 0; r + 1 < rows; ++r) {
    for (std::uint32_t c = 0; c + 1 < columns; ++c) {
      const std::uint32_t i = first + r * static_cast<std::uint32_t>(columns) + c,
                          j = i + static_cast<std::uint32_t>(columns);
      indices.insert(indices.end(), {i, i + 1, j + 1, i, j + 1, j});
    }
  }
}

void Mesh::add_shadow(const Mesh& of, const Vector3d& towards_lamp, double floor_m, Color color) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  for (const MeshVertex& v : of.vertices) {
    const Vector3d p(v.position[0], v.position[1], v.position[2]);
    add_vertex(p - towards_lamp * ((p.z() - floor_m) / towards_lamp.z()), Vector3d::UnitZ(), color);
  }
  for (const std::uint32_t i : of.indices) indices.push_back(first + i);
}

}  // namespace waverig::render
