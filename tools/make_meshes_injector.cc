// An injector with a blunt round tip: turned on the z axis, tip at the origin, thumb rest above.
//
//     tip and tube   half ball of 2.5 mm, tube to z = 24
//     barrel         radius 7 from z = 30 to 84, finger flange of 12 at its end
//     plunger        rod of 3 with a thumb rest of 8, to z = 112
//
// 40 rings of 12 points and two ends: 482 vertices, 960 triangles.
#include <array>
#include <cmath>
#include <numbers>

#include "tools/make_meshes_loft.h"

namespace tact::tools {
namespace {

using model::Vec3;

constexpr int kPoints = 12;
constexpr double kTip_mm = 2.5;  // radius
constexpr double kTop_mm = 112.0;

struct Turn {
  double z_mm = 0.0, radius_mm = 0.0;
  int steps = 1;  // rings from the turn before to this one
};

constexpr std::array<Turn, 16> kTurns{{{2.5, 2.5, 1},
                                       {24, 2.5, 7},
                                       {27, 4.5, 1},
                                       {30, 7, 1},
                                       {84, 7, 10},
                                       {84.5, 9.5, 1},
                                       {85, 12, 1},
                                       {88, 12, 1},
                                       {88.5, 8, 1},
                                       {88.5, 3, 1},
                                       {108, 3, 7},
                                       {108.2, 5.5, 1},
                                       {108.5, 8, 1},
                                       {111.5, 8, 1},
                                       {112, 7, 1},
                                       {112, 3.5, 1}}};

std::vector<Vec3> ring_at(double z_mm, double radius_mm) {
  std::vector<Vec3> ring;
  for (int i = 0; i < kPoints; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * double(i) / kPoints;
    ring.push_back({radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad), z_mm});
  }
  return ring;
}

}  // namespace

model::Result<Shape> make_injector_shape() {
  std::vector<std::vector<Vec3>> ring;
  for (const double angle_deg : {22.0, 45.0, 68.0}) {  // up the half ball
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    ring.push_back(ring_at(kTip_mm * (1.0 - std::cos(angle_rad)), kTip_mm * std::sin(angle_rad)));
  }
  Turn last = kTurns.front();
  for (const Turn& turn : kTurns) {
    for (int i = 1; i <= turn.steps; ++i) {
      const double way = double(i) / turn.steps;
      ring.push_back(ring_at(last.z_mm + way * (turn.z_mm - last.z_mm),
                             last.radius_mm + way * (turn.radius_mm - last.radius_mm)));
    }
    last = turn;
  }
  return make_loft({0, 0, 0}, ring, {0, 0, kTop_mm});
}

}  // namespace tact::tools
