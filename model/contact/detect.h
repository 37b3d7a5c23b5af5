// SPDX-License-Identifier: Apache-2.0
// detect.h - where each sphere is, from step to step, on any path.
//
//     found outside   -> free        found overlapping the organ -> inside
//     free            -> touching    the nearest point of all is nearer than r
//     free            -> inside      deeper than its movement explains: it came through a hole of
//                                    an open surface
//     inside          -> free        wholly outside: phi >= r
//     touching        -> free        r - phi - slack <= 0 at the proxy; at once touching again,
//                                    with an offset, where some part of the organ is nearer than r
//     touching        -> lets go     wholly outside, and either beyond its law or with nothing of
//                                    the organ between it and its place: its depth shrinks to 0
//     lets go         -> free
//     touching        -> found again  its place has no answer any more
//
// Closing and opening the grip lead from touching to held and back, a pull farther than the surface
// from held to free (contact.h).
#pragma once

#include "model/contact/contact_scene.h"
#include "model/contact/organ_contact.h"

namespace tact::model::contact {

/// Of a radius, the way of a step: no sphere passes a sheet between two of them.
inline constexpr double kWay_ratio = 0.5;
/// Of a radius: a sphere without force searches so far ahead.
inline constexpr double kAhead_ratio = 4.0;

/// One step of a sphere whose centre has moved.
void step(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
          const Vec3& moved_m) RT_SAFE;

/// Ends its contact.
void leave(const ContactScene& scene, OrganContact& organ, Sphere& sphere,
           ContactState state) RT_SAFE;

/// Is the whole sphere outside of the organ at rest? The answer stands until it may have moved out,
/// or in.
bool is_outside(const ContactScene& scene, Sphere& sphere) RT_SAFE;

/// Is nothing of the organ between a sphere at `centre_m` and the surface point that it belongs to?
bool is_open_way(const ContactScene& scene, const Vec3& surface_point_m,
                 const Vec3& centre_m) RT_SAFE;

}  // namespace tact::model::contact
