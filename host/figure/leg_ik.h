// SPDX-License-Identifier: Apache-2.0
// leg_ik.h - hip and ankle are tracked; where is the knee? Two bones in the plane of the leg.
//
//     D = |P2 - P1|, kept within |L1 - L2| .. L1 + L2 ,   phi = direction of P2 - P1 (0 at D = 0)
//     cos(interior_knee) = (L1^2 + L2^2 - D^2) / (2 L1 L2) ,   flexion = pi - interior_knee
//     cos(interior_hip)  = (L1^2 + D^2 - L2^2) / (2 L1 D) ,    interior_ankle likewise
//     thigh = phi + bend interior_hip ,   shank = thigh - bend flexion              CC-10
//
//     P1 hip, P2 ankle, m (x forward, y up)     L1 thigh, L2 calf, m     angles rad, from +x
//     counter-clockwise     bend +1: knee on the counter-clockwise side of the ray hip - ankle
//
// The sines come from the triangle's area, because an acos near 1 has half its digits left.
// At D = 0 with L1 = L2 the leg is folded and both other interior angles are pi/2 by convention.
// Source: CC-10; the law of cosines is reconstructed, the source lost its formulas.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace tact::host::figure {

enum class LegStatus : std::uint8_t { kOk, kUnreachable, kInvalid };
enum class Bend : std::int8_t { kCounterClockwise = 1, kClockwise = -1 };

struct Leg {
  double thigh_m = 0.0;  // L1 > 0, as the body plan has it
  double calf_m = 0.0;   // L2 > 0
  Bend bend = Bend::kCounterClockwise;
};

struct LegPose {
  LegStatus status = LegStatus::kInvalid;
  Eigen::Vector2d knee_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d ankle_m = Eigen::Vector2d::Zero();  // the wanted one, or the nearest in reach
  double interior_hip_rad = 0.0;
  double interior_knee_rad = 0.0;
  double interior_ankle_rad = 0.0;
  double flexion_knee_rad = 0.0;
  double thigh_angle_rad = 0.0;
  double shank_angle_rad = 0.0;
};

/// CC-10. Too far or too near: the closest pose on the ray, kUnreachable. A number that is not
/// finite or a bone without length: kInvalid.
LegPose pose_leg(const Leg& leg, const Eigen::Vector2d& hip_m, const Eigen::Vector2d& ankle_m);

}  // namespace tact::host::figure
