#include "render/scene/scene_parts.h"

#include <array>
#include <cmath>
#include <numbers>

namespace waverig::render {
namespace {

// Sizes of the drawn rig that no record tells, in metres; the arm's length is
// the run's.
constexpr double kGondolaWidth = 0.22, kGondolaHeight = 0.15, kHanger = 0.16;

Vector3d arm_tip(const RigMotion& motion, const RigInstant& at) {
  return motion.radius_m() * Vector3d(std::cos(at.arm_angle_rad), 0, std::sin(at.arm_angle_rad));
}

// The gondola hangs on the tip; the sensor sits in it. swing: about the shaft's
// direction.
Isometry3d gondola_pose(const Vector3d& pivot, const Quaterniond& q_SB) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = pivot;
  // The body's z points down, the scene's up.
  pose.linear() = q_SB.toRotationMatrix() * Vector3d(1, -1, -1).asDiagonal();
  return pose;
}

}  // namespace

Vector3d SceneParts::towards_lamp() { return Vector3d(-0.45, -0.62, 0.75).normalized(); }

void SceneParts::build(const RigMotion& motion, const RigInstant& at) {
  solid.clear();
  clear.clear();
  if (motion.on_sea())
    build_buoy(motion, at);
  else
    build_rig(motion, at);
}

// The floor, tiled by half metres, larger where those would be a haze, and what stands on it keeps from the
// lamp.
void SceneParts::add_floor(double reach, double floor_z) {
  const bool dark = theme_ == Theme::kDark;
  const Color floor = dark ? rgb(0x39424D) : rgb(0xDDE2E7),
              joint = mixed(floor, rgb(0x000000), dark ? 0.35F : 0.12F);
  const Mesh things = solid;
  Isometry3d ground = Isometry3d::Identity();
  ground.translation() = Vector3d(0, 0, floor_z - 0.01);
  solid.add_box(ground, {16 * reach, 16 * reach, 0.02}, floor);
  const double tile_m = 0.5 * std::ceil(reach / 2), joint_m = 0.016 * tile_m;
  for (double at_m = -8 * reach; at_m < 8 * reach; at_m += tile_m) {
    ground.translation() = Vector3d(at_m, 0, floor_z);
    solid.add_box(ground, {joint_m, 16 * reach, 0.002}, joint);
    ground.translation() = Vector3d(0, at_m, floor_z);
    solid.add_box(ground, {16 * reach, joint_m, 0.002}, joint);
  }
  solid.add_shadow(things, towards_lamp(), floor_z + 0.004, mixed(floor, rgb(0x000000), 0.28F));
}

// surface: rows of `columns` points, the nearest row first; its front goes down to the floor.
void SceneParts::add_water(const std::vector<Vector3d>& surface, std::size_t columns, double floor_z) {
  const bool dark = theme_ == Theme::kDark;
  std::vector<Vector3d> front;
  for (std::size_t column = 0; column < columns; ++column)
    front.emplace_back(surface[column].x(), surface[column].y(), floor_z);
  front.insert(front.end(), surface.begin(), surface.begin() + static_cast<std::ptrdiff_t>(columns));
  clear.add_sheet(surface, columns, dark ? rgb(0x2A7FB8, 0.80F) : rgb(0x3F97D0, 0.80F));
  clear.add_sheet(front, columns, dark ? rgb(0x124A70, 0.82F) : rgb(0x2E7DB3, 0.72F));
}

// The water passes through the buoy: beside it stands what came by before and what comes by after, a period
// as long as a wave of the rig's.
void SceneParts::build_buoy(const RigMotion& motion, const RigInstant& at) {
  const double r = motion.radius_m(), reach = r + 0.45, floor_z = -(1.2 * r + 0.75), size = 0.16 * reach;
  const auto add_hull = [&](Mesh& mesh, const Isometry3d& pose, double grown, Color hull, Color mast) {
    const auto place = [&](double up) { return Vector3d(pose * Vector3d(0, 0, up * size)); };
    mesh.add_rod(place(-0.7), place(0.7), 1.1 * grown * size, hull);
    mesh.add_rod(place(0.7), place(2.6), 0.16 * grown * size, mast);
    mesh.add_rod(place(2.6), place(2.9), 0.34 * grown * size, mast);
  };
  add_hull(solid, gondola_pose(at.sensor_m, at.q_SB), 1, rgb(0xF2B705), rgb(0x5C6773));
  add_floor(reach, floor_z);
  if (at.estimated) {
    const Vector3d shift(0, 0, at.estimated_heave_m - at.sensor_m.z());
    const Color ghost = with_alpha(palette(theme_, motion.color()), 0.30F);
    add_hull(clear, gondola_pose(at.sensor_m + shift, at.estimated_q_SB), 1.08, ghost, ghost);
  }
  constexpr std::size_t kColumns = 160, kRows = 12;
  const double half_width = 5 * reach, near_y = -0.5 * reach, far_y = 2.2 * reach;
  const double seconds_per_m = 0.55 / std::max(r, 0.12) * motion.run().period_s / (2 * std::numbers::pi);
  std::array<double, kColumns> x{}, z{};
  for (std::size_t column = 0; column < kColumns; ++column) {
    x[column] = -half_width + 2 * half_width * static_cast<double>(column) / (kColumns - 1);
    z[column] = motion.at(at.time_s + seconds_per_m * (x[column] - at.sensor_m.x())).sensor_m.z();
  }
  std::vector<Vector3d> surface;
  for (std::size_t row = 0; row < kRows; ++row) {
    const double y = near_y + (far_y - near_y) * static_cast<double>(row) / (kRows - 1);
    for (std::size_t column = 0; column < kColumns; ++column) surface.emplace_back(x[column], y, z[column]);
  }
  add_water(surface, kColumns, floor_z);
}

void SceneParts::build_rig(const RigMotion& motion, const RigInstant& at) {
  const Color steel = rgb(0x9AA5B1), frame = rgb(0x5C6773), arm = rgb(0xD9822B), gondola = rgb(0xE9EDF2),
              sensor = rgb(0x0B6E4F);
  const double r = motion.radius_m();
  const double floor_z = -(r + 0.75), depth_y = 0.34;

  // 1. The stand: two A-frames behind the arm's plane, and the shaft between them and the arm.
  for (const double y : {depth_y, depth_y + 0.28}) {
    for (const double side : {-1.0, 1.0})
      solid.add_rod({side * 0.62 * (r + 0.4), y, floor_z}, {0, y, 0}, 0.03, frame);
    solid.add_rod({-0.34 * (r + 0.4), y, 0.55 * floor_z}, {0.34 * (r + 0.4), y, 0.55 * floor_z}, 0.02, frame);
  }
  solid.add_rod({0, -0.06, 0}, {0, depth_y + 0.34, 0}, 0.035, steel);
  Isometry3d motor = Isometry3d::Identity();
  motor.translation() = Vector3d(0, depth_y + 0.42, 0);
  solid.add_box(motor, {0.16, 0.2, 0.16}, rgb(0x37474F));

  // 2. The arm with its counterweight.
  const Vector3d tip = arm_tip(motion, at), along(std::cos(at.arm_angle_rad), 0, std::sin(at.arm_angle_rad));
  Isometry3d beam = Isometry3d::Identity();
  beam.linear() = Eigen::AngleAxisd(-at.arm_angle_rad, Vector3d::UnitY()).toRotationMatrix();
  const double back = 0.16 + 0.25 * r;
  beam.translation() = 0.5 * (r - back) * along;
  solid.add_box(beam, {r + back + 0.06, 0.045, 0.055}, arm);
  Isometry3d weight = beam;
  weight.translation() = -back * along;
  solid.add_box(weight, {0.11, 0.1, 0.13}, frame);
  solid.add_rod({0, -0.05, 0}, {0, 0.05, 0}, 0.055, steel);

  // 3. The gondola, its hangers, and the sensor in it.
  const Vector3d pivot = tip + Vector3d(0, -0.09, 0);
  solid.add_rod(tip + Vector3d(0, 0.05, 0), pivot + Vector3d(0, -0.14, 0), 0.014, steel);
  const Isometry3d hang = gondola_pose(pivot, at.q_SB);
  const auto in_gondola = [](const Isometry3d& pose, const Vector3d& place) {
    Isometry3d out = pose;
    out.translation() = pose * place;
    return out;
  };
  for (const double x : {-0.4, 0.4})
    solid.add_rod(pivot, hang * Vector3d(x * kGondolaWidth, 0, -kHanger), 0.009, steel);
  const Vector3d body(0, 0, -kHanger - 0.5 * kGondolaHeight);
  solid.add_box(in_gondola(hang, body), {kGondolaWidth, 0.16, kGondolaHeight}, gondola);
  solid.add_box(in_gondola(hang, body + Vector3d(0, -0.085, 0)), {0.075, 0.012, 0.05}, sensor);

  // 4. The estimate: the gondola where the method believes it to be.
  if (at.estimated) {
    const Vector3d shift(0, 0, at.estimated_heave_m - at.sensor_m.z());
    const Isometry3d believed = gondola_pose(pivot + shift, at.estimated_q_SB);
    clear.add_box(in_gondola(believed, body), {kGondolaWidth * 1.08, 0.175, kGondolaHeight * 1.08},
                  with_alpha(palette(theme_, motion.color()), 0.30F));
  }

  // 5. The floor.
  const double reach = r + 0.45;
  add_floor(reach, floor_z);

  // 6. The water in a flume behind: the trochoidal wave (Gerstner 1804) whose particle the gondola is, as
  // high as true.
  constexpr std::size_t kColumns = 120, kRows = 12;
  const double k = 0.55 / std::max(r, 0.12), level = -kHanger - 0.5 * kGondolaHeight;
  const double half_width = 5 * reach, near_y = depth_y + 0.62, far_y = near_y + 1.6 * reach;
  std::vector<Vector3d> surface;
  for (std::size_t row = 0; row < kRows; ++row) {
    const double y = near_y + (far_y - near_y) * static_cast<double>(row) / (kRows - 1);
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double x0 = -half_width + 2 * half_width * static_cast<double>(column) / (kColumns - 1);
      const double phase = at.arm_angle_rad + k * x0;
      surface.emplace_back(x0 + r * std::cos(phase), y, level + r * std::sin(phase));
    }
  }
  add_water(surface, kColumns, floor_z);
}

}  // namespace waverig::render
