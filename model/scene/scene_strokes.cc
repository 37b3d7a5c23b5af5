// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene_strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::model::scene {
namespace {

constexpr std::array kActions{
    // in the order of Action
    Choice{"press", "move straight to depth_m below the touched point"},
    Choice{"hold", "stay"},
    Choice{"slide", "move along by offset_m"},
    Choice{"release", "open the grip in the first quarter of the time, then return to home_m"},
    Choice{"grip", "close the grip"},
    Choice{"pull", "move outward to height_m above the surface, with the grip closed"},
    Choice{"tear", "pull so far that the tear force is passed and the tissue lets go"},
    Choice{"turn", "turn the tool; a release turns it back"},
};
static_assert(kActions.size() == static_cast<std::size_t>(Action::kTurn) + 1);

constexpr std::array kPivots{
    Choice{"tip", "the middle of the probe spheres"},
    Choice{"handle", "tool.handle_m"},
};

// A grip that opened on the way home would pull at the tissue before it lets go.
constexpr double kOpening_ratio = 0.25;

constexpr Range kDurations_s{0.05, 60.0};
constexpr Range kHeights_m{0.0, 0.1};
constexpr Range kAngles_deg{-20.0, 20.0};  // of the simulated wrist (hal/sim/sim_wrist.h)

/// Error: the hand cannot be there.
std::optional<Error> check_place(const Vec3& p, const Limits& limits) {
  const bool inside = std::hypot(p.y, p.z) <= limits.workspace_radius_m &&
                      std::fabs(p.x) <= limits.workspace_half_length_m;
  if (inside) return std::nullopt;
  return Error{
      fmt::format("({:.4f}, {:.4f}, {:.4f}) m, outside the workspace of [limits]; move it inside",
                  p.x, p.y, p.z)};
}

/// Where the hand is while the strokes are written down one after the other.
class Writer {
 public:
  Writer(const HandScript& script, std::span<const contact::ProbeSphere> spheres)
      : script_(script), spheres_(spheres), inward_(normalized(script.inward)) {
    // The first way point is home, at rest, with an open grip.
    path_.push_back({.time_s = 0.0, .position_m = script.home_m + script.handle_m});
  }

  void write(const Stroke& stroke) {
    HandWaypoint next = path_.back();
    next.time_s += stroke.duration_s;
    next.straight_m = {};
    switch (stroke.action) {
      case Action::kHold:
        break;
      case Action::kPress:
        next.position_m = at_depth(stroke.depth_m);
        break;
      case Action::kPull:
      case Action::kTear:
        next.position_m = at_depth(-stroke.height_m);
        break;
      case Action::kSlide:
        // Kept for the strokes that follow: a pull goes up from where the slide ended.
        slid_m_ += stroke.offset_m;
        next.position_m += stroke.offset_m;
        break;
      case Action::kGrip:
        next.grip_ratio = 1.0;
        break;
      case Action::kRelease:
        if (is_closed()) open(kOpening_ratio * stroke.duration_s);
        next.grip_ratio = 0.0;
        next.position_m = script_.home_m + script_.handle_m;
        next.rotation_rad = {};
        slid_m_ = {};
        break;
      case Action::kTurn:
        turn(stroke, next);
        break;
    }
    path_.push_back(next);
  }

  bool is_closed() const { return path_.back().grip_ratio > 0.0; }
  const Vec3& position_m() const { return path_.back().position_m; }
  std::vector<HandWaypoint> take() { return std::move(path_); }

 private:
  // p(d) = contact point + slid - inward (reach - d), here with R handle
  Vec3 at_depth(double depth_m) const {
    const Quat r = quat_from_rotation_vector(path_.back().rotation_rad);
    // R offset . inward = offset . R^-1 inward
    const double reach = reach_m(spheres_, rotate(conjugate(r), inward_));
    return script_.site_m + slid_m_ - inward_ * (reach - depth_m) + rotate(r, script_.handle_m);
  }

  void turn(const Stroke& stroke, HandWaypoint& next) {
    if (!stroke.about_handle) {
      for (const contact::ProbeSphere& sphere : spheres_)
        next.straight_m += sphere.offset_m / static_cast<double>(spheres_.size());
      next.straight_m -= script_.handle_m;
    }
    const Quat before = quat_from_rotation_vector(next.rotation_rad);
    next.rotation_rad = stroke.angle_rad * normalized(stroke.axis);
    const Quat after = quat_from_rotation_vector(next.rotation_rad);
    const auto moved = [&](const Vec3& c) { return rotate(before, c) - rotate(after, c); };
    next.position_m += moved(next.straight_m);
    // For the strokes that follow: a pull goes up from where the tool's origin now is.
    slid_m_ += tangential(moved(next.straight_m + script_.handle_m), inward_);
  }

  void open(double after_s) {
    HandWaypoint opened = path_.back();
    opened.time_s += after_s;
    opened.grip_ratio = 0.0;
    path_.push_back(opened);
  }

  const HandScript& script_;
  std::span<const contact::ProbeSphere> spheres_;
  Vec3 inward_;
  Vec3 slid_m_;
  std::vector<HandWaypoint> path_;
};

void visit_turn(reader::Keys& keys, Stroke& stroke) {
  keys.vector("axis", {-1.0, 1.0}, "in W, any length but 0", stroke.axis);
  if (!(norm(stroke.axis) > 0.0))
    keys.refuse({"axis"}, "the axis of a turn has no direction; allowed: any length but 0");
  double angle_deg = 0.0;
  keys.number("angle_deg", kAngles_deg, "about it, from how the tool rests; 0 turns it back",
              angle_deg);
  stroke.angle_rad = angle_deg * std::numbers::pi / 180.0;
  keys.choice("about", kPivots, "what stays where it is", stroke.about_handle, Need::kOptional);
}

}  // namespace

void visit_stroke(reader::Keys& keys, Stroke& stroke) {
  stroke.position = keys.position_of("action");
  keys.one_of("action", kActions, [&](std::size_t index) {
    stroke.action = static_cast<Action>(index);
    switch (stroke.action) {
      case Action::kPress:
        keys.number("depth_m", {0.0, 0.05}, "of the lowest probe sphere, 0: at the surface",
                    stroke.depth_m);
        break;
      case Action::kSlide:
        keys.vector("offset_m", {-0.1, 0.1}, "from where the hand is, in W", stroke.offset_m);
        break;
      case Action::kPull:
      case Action::kTear:
        keys.number("height_m", kHeights_m, "of the lowest probe sphere above the surface",
                    stroke.height_m);
        break;
      case Action::kTurn:
        visit_turn(keys, stroke);
        break;
      default:
        break;
    }
    keys.number("duration_s", kDurations_s, "of the move", stroke.duration_s);
  });
}

double reach_m(std::span<const contact::ProbeSphere> spheres, const Vec3& inward) {
  double reach_m = -std::numeric_limits<double>::infinity();
  for (const contact::ProbeSphere& sphere : spheres) {
    // reach = max_i (offset_i . inward + radius_i)
    reach_m = std::max(reach_m, dot(sphere.offset_m, inward) + sphere.radius_m);
  }
  return reach_m;
}

std::vector<HandWaypoint> way_points(const HandScript& script,
                                     std::span<const contact::ProbeSphere> spheres,
                                     const Limits& limits, reader::SceneVisit& visit) {
  const auto refuse = [&](const reader::TextPosition& position, const std::string& why) {
    visit.note(reader::ProblemKind::kConflict, position, why);
  };
  // A place that the reader did not write himself is reported with its source.
  const bool apart = script.handle_m != Vec3{};
  if (const std::optional<Error> error = check_place(script.home_m + script.handle_m, limits))
    refuse(script.home_position,
           (apart ? "the handle at hand.home_m + tool.handle_m is " : "hand.home_m is ") +
               error->message);
  Writer writer(script, spheres);
  for (std::size_t i = 0; i < script.strokes.size(); ++i) {
    const Stroke& stroke = script.strokes[i];
    const std::string name = fmt::format("hand.stroke.{}", i);
    // An open grip holds nothing: the tool would only leave the surface.
    const bool pulls = stroke.action == Action::kPull || stroke.action == Action::kTear;
    if (pulls && !writer.is_closed())
      refuse(stroke.position, name + " pulls with an open grip; put a grip stroke before it");
    writer.write(stroke);
    // A release ends at home, which has been evaluated.
    if (stroke.action == Action::kRelease) continue;
    if (const std::optional<Error> error = check_place(writer.position_m(), limits))
      refuse(stroke.position,
             fmt::format("{} ends {}at {}", name, apart ? "with the handle " : "", error->message));
  }
  if (script.repeat && !script.strokes.empty() &&
      script.strokes.back().action != Action::kRelease) {
    refuse(script.strokes.back().position,
           "hand.repeat would make the hand jump home from here; end with a release stroke");
  }
  return writer.take();
}

}  // namespace tact::model::scene
