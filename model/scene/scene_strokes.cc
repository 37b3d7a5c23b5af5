// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene_strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::model::scene {
namespace {

constexpr std::array kActions{
    reader::Choice{"press", "move straight to depth_m below the touched point"},
    reader::Choice{"hold", "stay"},
    reader::Choice{"slide", "move along by offset_m"},
    reader::Choice{"release",
                   "open the grip in the first quarter of the time, then return to home_m"},
    reader::Choice{"grip", "close the grip"},
    reader::Choice{"pull", "move outward to height_m above the surface, with the grip closed"},
    reader::Choice{"tear", "pull so far that the tear force is passed and the tissue lets go"},
};
constexpr std::array kActionOf{Action::kPress, Action::kHold, Action::kSlide, Action::kRelease,
                               Action::kGrip,  Action::kPull, Action::kTear};
static_assert(kActions.size() == kActionOf.size());

// A grip that opened on the way home would pull at the tissue before it lets go.
constexpr double kOpeningRatio = 0.25;

constexpr reader::Range kDurations_s{0.05, 60.0};
constexpr reader::Range kHeights_m{0.0, 0.1};

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
  Writer(const HandScript& script, double reach_m)
      : script_(script), reach_m_(reach_m), inward_(normalized(script.inward)) {
    // The first way point is home, at rest, with an open grip.
    path_.push_back({.time_s = 0.0, .position_m = script.home_m});
  }

  void write(const Stroke& stroke) {
    HandWaypoint next = path_.back();
    next.time_s += stroke.duration_s;
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
        if (is_closed()) open(kOpeningRatio * stroke.duration_s);
        next.grip_ratio = 0.0;
        next.position_m = script_.home_m;
        slid_m_ = {};
        break;
    }
    path_.push_back(next);
  }

  bool is_closed() const { return path_.back().grip_ratio > 0.0; }
  const Vec3& position_m() const { return path_.back().position_m; }
  std::vector<HandWaypoint> take() { return std::move(path_); }

 private:
  // p(d) = site + slid - inward (reach - d)
  Vec3 at_depth(double depth_m) const {
    return script_.site_m + slid_m_ - inward_ * (reach_m_ - depth_m);
  }

  void open(double after_s) {
    HandWaypoint opened = path_.back();
    opened.time_s += after_s;
    opened.grip_ratio = 0.0;
    path_.push_back(opened);
  }

  const HandScript& script_;
  double reach_m_;
  Vec3 inward_;
  Vec3 slid_m_;
  std::vector<HandWaypoint> path_;
};

}  // namespace

void visit_stroke(reader::Keys& keys, Stroke& stroke) {
  stroke.place = keys.place_of("action");
  keys.one_of("action", kActions, [&](std::size_t index) {
    stroke.action = kActionOf[index];
    switch (stroke.action) {
      case Action::kPress:
        keys.number("depth_m", {0.0, 0.05}, "of the lowest probe sphere, 0 just touches",
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

std::vector<HandWaypoint> way_points(const HandScript& script, double reach_m, const Limits& limits,
                                     reader::SceneVisit& visit) {
  const auto refuse = [&](const reader::TextPlace& place, const std::string& why) {
    visit.note(reader::ProblemKind::kConflict, place, why);
  };
  if (const std::optional<Error> error = check_place(script.home_m, limits))
    refuse(script.home_place, "hand.home_m is " + error->sentence);
  Writer writer(script, reach_m);
  for (std::size_t i = 0; i < script.strokes.size(); ++i) {
    const Stroke& stroke = script.strokes[i];
    const std::string name = fmt::format("hand.stroke.{}", i);
    // An open grip holds nothing: the tool would only leave the surface.
    const bool pulls = stroke.action == Action::kPull || stroke.action == Action::kTear;
    if (pulls && !writer.is_closed())
      refuse(stroke.place, name + " pulls with an open grip; put a grip stroke before it");
    writer.write(stroke);
    // A release ends at home, which has been judged.
    if (stroke.action == Action::kRelease) continue;
    if (const std::optional<Error> error = check_place(writer.position_m(), limits))
      refuse(stroke.place, fmt::format("{} ends at {}", name, error->sentence));
  }
  if (script.repeat && !script.strokes.empty() &&
      script.strokes.back().action != Action::kRelease) {
    refuse(script.strokes.back().place,
           "hand.repeat would make the hand jump home from here; end with a release stroke");
  }
  return writer.take();
}

}  // namespace tact::model::scene
