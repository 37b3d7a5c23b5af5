// SPDX-License-Identifier: Apache-2.0
// scene_strokes.h - what the simulated hand does, stroke by stroke, and the way points it becomes.
//
//     p(d) = contact point + slid - inward (reach - d),   reach = max_i (R offset_i . inward +
//                                                         radius_i)
//
//     p       where the hand wants the tool's origin, W
//     d       how deep the lowest probe sphere would be, m; at d = 0 it is at the contact
//     point inward  unit direction into the tissue, W;  R: how the tool is turned
//     slid    sum of the slides since the last release, and of what turns moved the origin along
//
// A way point is where the hand wants the handle: p + R handle. A turn leaves tip or handle in
// place.
// The hand holds the tool by a spring: what it reaches is less than what it wants. Set-up code
// only.
#pragma once

#include <span>
#include <vector>

#include "model/contact/contact.h"
#include "model/hand_path.h"
#include "model/limits.h"
#include "model/reader/scene_reader.h"

namespace tact::model::scene {

enum class Action { kPress, kHold, kSlide, kRelease, kGrip, kPull, kTear, kTurn };

struct Stroke {
  Action action = Action::kHold;
  double duration_s = 0.0;
  double depth_m = 0.0;             // press
  double height_m = 0.0;            // pull, tear
  Vec3 offset_m{};                  // slide
  Vec3 axis{};                      // turn; W, any length but zero
  double angle_rad = 0.0;           // turn; about the axis, from how the tool rests
  bool about_handle = false;        // turn; else about the tip, the middle of the probe spheres
  reader::TextPosition position{};  // in the scene file
};

struct HandScript {
  Vec3 home_m;
  Vec3 site_m;
  Vec3 inward;      // any length but zero
  Vec3 handle_m{};  // where the hand and the device hold the tool, tool frame of the file
  bool repeat = false;
  std::vector<Stroke> strokes;
  reader::TextPosition home_position;  // in the scene file
};

/// The keys of one [[hand.stroke]].
void visit_stroke(reader::Keys& keys, Stroke& stroke);

/// Extent of the tool from its origin along a unit direction, m.
double reach_m(std::span<const contact::ProbeSphere> spheres, const Vec3& inward);

/// From home through every stroke. Home and the end of each stroke lie inside the workspace, a pull
/// follows a grip, and a script that repeats ends at home; otherwise a conflict is noted.
std::vector<HandWaypoint> way_points(const HandScript& script,
                                     std::span<const contact::ProbeSphere> spheres,
                                     const Limits& limits, reader::SceneVisit& visit);

}  // namespace tact::model::scene
