// SPDX-License-Identifier: Apache-2.0
// detect.h - state transitions of each sphere, for any path of the tool.
//
// To locate a sphere is to search its nearest point without a start; ending is a part of contact.
//
//     located outside -> free       located overlapping the organ -> inside
//     free            -> contact    the nearest point of the surface is nearer than r
//     free            -> inside     deeper than its displacement: it came through a hole of an
//                                   open surface
//     inside          -> free       entirely outside: phi >= r
//     contact         -> free       r - phi - offset <= 0 at the proxy; in contact again in the
//                                   same step, with an offset, if another part is nearer than r
//     contact         -> ending     entirely outside, and either beyond its law or with nothing of
//                                   the organ between it and its surface point: depth shrinks to 0
//     ending          -> free
//     contact         -> located again   no solution for 0.1 s or one radius of motion
//
// Closing and opening the grip lead from contact to held and back. Held becomes free if the sphere
// was pulled out of the surface (contact.h).
#pragma once

#include "model/contact/contact_scene.h"
#include "model/contact/organ_contact.h"

namespace tact::model::contact {

/// Longest step over the radius: no sphere passes through a sheet within a step.
inline constexpr double kWay_ratio = 0.5;
/// Search distance of a free sphere over the radius.
inline constexpr double kAhead_ratio = 4.0;

/// One step of a sphere whose centre has moved.
void step(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
          const Vec3& moved_m) RT_SAFE;

/// Ends the contact; the sphere gets this state.
void leave(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
           ContactState state) RT_SAFE;

/// True if the whole sphere is outside of the organ at rest. Cached until the sphere has moved far
/// enough to change the result.
bool is_outside(const ContactScene& scene, Sphere& sphere) RT_SAFE;

/// True if nothing of the organ is between a sphere at `centre_m` and its surface point.
bool is_open_way(const ContactScene& scene, const Vec3& surface_point_m,
                 const Vec3& centre_m) RT_SAFE;

}  // namespace tact::model::contact
