// SPDX-License-Identifier: Apache-2.0
// An injector with a blunt round tip: turned on the z axis, tip at the origin, thumb rest above.
//
//     tip and tube   half ball of 2.5 mm, tube to z = 24
//     barrel         radius 7 from z = 30 to 84, finger flange of 12 at its end
//     plunger        rod of 3 with a thumb rest of 8, to z = 112
//
// 40 rings of 12 points and two ends: 482 vertices, 960 triangles.
#include <array>

#include "tools/make_meshes/loft.h"

namespace tact::tools::make_meshes {
namespace {

constexpr int kPoints = 12;
constexpr double kTip_mm = 2.5;  // radius
constexpr double kTop_mm = 112.0;

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

constexpr std::array<double, 3> kBallAngle_deg{22.0, 45.0, 68.0};

}  // namespace

model::Result<Shape> make_injector_shape() {
  return make_turned({.points = kPoints,
                      .ball_mm = kTip_mm,
                      .ball_angle_deg = kBallAngle_deg,
                      .turns = kTurns,
                      .top_mm = kTop_mm});
}

}  // namespace tact::tools::make_meshes
