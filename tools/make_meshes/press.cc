// SPDX-License-Identifier: Apache-2.0
// A pressing tool: a ball of 4 mm on a shaft, and a handle. Turned on the z axis, tip at the
// origin.
//
//     ball and shaft   ball of 4 mm, shaft of 3 mm to z = 52
//     handle           from z = 56 to 150: a collar, two swells for the fingers, a round end
//
// 46 rings of 16 points and two ends: 738 vertices, 1 472 triangles.
#include <array>

#include "tools/make_meshes/loft.h"

namespace tact::tools::make_meshes {
namespace {

constexpr int kPoints = 16;
constexpr double kBall_mm = 4.0;
constexpr double kTop_mm = 150.0;

constexpr std::array<Turn, 19> kTurns{{{7.1, 3.0, 1},
                                       {10, 3.0, 1},
                                       {48, 3.0, 8},
                                       {52, 4.5, 1},
                                       {53, 8.5, 1},
                                       {56, 9.5, 1},
                                       {59, 9.5, 1},
                                       {60, 7.5, 1},
                                       {66, 8.2, 2},
                                       {78, 10.2, 3},
                                       {88, 10.4, 2},
                                       {99, 9.0, 3},
                                       {110, 9.0, 2},
                                       {124, 11.0, 3},
                                       {136, 11.6, 3},
                                       {142, 11.0, 2},
                                       {146, 9.2, 1},
                                       {148.6, 6.6, 1},
                                       {149.7, 3.4, 1}}};

constexpr std::array<double, 8> kBallAngle_deg{15.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0};

}  // namespace

model::Result<Shape> make_press_shape() {
  return make_turned({.points = kPoints,
                      .ball_mm = kBall_mm,
                      .ball_angle_deg = kBallAngle_deg,
                      .turns = kTurns,
                      .top_mm = kTop_mm});
}

}  // namespace tact::tools::make_meshes
