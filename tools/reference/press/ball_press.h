// SPDX-License-Identifier: Apache-2.0
// ball_press.h - the tool's tip pressed into tissue at large strain, where what it touches is found
// by the solver and not known beforehand.
#pragma once

#include "tools/reference/calculix/calculix.h"
#include "tools/reference/organ/organ_body.h"

namespace tact::tools::reference {

/// The ball rests on the site `tip.at_m` and goes along `tip.axis` by `depth_m`. It may touch faces
/// within two of its radii; `tip.radius_m` is that of the ball.
BallContact ball_on(const OrganBody& body, const Circle& tip, double depth_m);

/// Of a circle as large as what touches the ball, seen along its way. `displacement_m` by node.
double touched_radius_m(const OrganBody& body, const BallContact& contact, const model::Vec3& axis,
                        const std::vector<model::Vec3>& displacement_m);

}  // namespace tact::tools::reference
