#include "model/contact.h"

#include <algorithm>
#include <cmath>

namespace tact::model {
namespace {

Vec3 tangential(const Vec3& v, const Vec3& normal) RT_SAFE { return v - dot(v, normal) * normal; }

double at_least_zero(double v) RT_SAFE { return v > 0.0 ? v : 0.0; }

// The part of a tangential vector along which the nearest point can move: all of it on a face, the
// edge's share on an edge, nothing in a vertex.
Vec3 movable(const SurfaceView& s, const Place& place, const Vec3& v) RT_SAFE {
  const TriangleCorners& corner = s.triangle[place.triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    if (place.weight[i] != 0.0) continue;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (place.weight[j] == 0.0 || place.weight[k] == 0.0) return {};
    const Vec3 along = normalized(s.vertex_m[corner[k]] - s.vertex_m[corner[j]]);
    return dot(v, along) * along;
  }
  return v;
}

}  // namespace

void Contact::reset() RT_SAFE {
  for (std::size_t i = 0; i < kMaxSpheres; ++i) scene_.law->leave(i);
  probe_ = {};
  touch_ = {};
  closed_ = closing_ = false;
  before_.reset();
}

// A free probe watches the two sheets that its cell names; one in contact follows its own site.
Site Contact::search(Probe& probe) RT_SAFE {
  const SurfaceView& surface = scene_.surface;
  const std::uint32_t cell = scene_.seeds.cell_of(probe.centre_m);
  if (cell != probe.cell) {
    probe.cell = cell;
    probe.candidate = scene_.seeds.cell[cell];
  }
  Site best = follow(surface, probe.candidate[0], probe.centre_m);
  probe.candidate[0] = best.place.triangle;
  if (probe.candidate[1] == kNoTriangle) return best;
  const Site other = follow(surface, probe.candidate[1], probe.centre_m);
  probe.candidate[1] = other.place.triangle;
  return std::abs(other.distance_m) < std::abs(best.distance_m) ? other : best;
}

void Contact::touch(const Tool& tool) RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    Probe& probe = probe_[i];
    const Vec3 centre_m = tool.position_m + rotate(tool.orientation, scene_.spheres[i].offset_m);
    if (!is_finite(centre_m)) {
      probe = {};
      touch_[i] = {};
      scene_.law->leave(i);
      continue;
    }
    probe.moved_m = probe.seen ? centre_m - probe.centre_m : Vec3{};
    probe.centre_m = centre_m;
    probe.site = touch_[i].state == TouchState::kFree
                     ? search(probe)
                     : follow(scene_.surface, probe.site.place.triangle, centre_m);
    const double depth_m = scene_.spheres[i].radius_m - probe.site.distance_m;
    // A distance cannot change by more than the movement: the rest is a nearest point that jumped.
    const double before_m = probe.seen ? probe.depth_m : 0.0;
    probe.deepened_m = at_least_zero(depth_m - before_m - norm(probe.moved_m));
    probe.depth_m = depth_m;
    probe.seen = true;
  }
}

Wrench Contact::feel(const Tool& tool, bool blade_may_cut) RT_SAFE {
  watch_grip(tool.grip_ratio);
  Wrench sum;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    Probe& probe = probe_[i];
    SphereTouch& touch = touch_[i];
    if (!probe.seen) continue;
    change_state(probe, touch);
    if (touch.state == TouchState::kTouching) feel_touching(probe, touch);
    if (touch.state == TouchState::kTouching && closing_) hold(probe, touch);
    if (touch.state == TouchState::kHeld) feel_held(probe, touch);
    sum.force_N += touch.force_N;
    sum.torque_Nm += cross(probe.centre_m - tool.position_m, touch.force_N);
  }
  use_blade(tool, blade_may_cut);
  scene_.law->advance();
  return sum;
}

void Contact::use_blade(const Tool& tool, bool may_cut) RT_SAFE {
  if (!scene_.blade) return;
  if (may_cut && before_) scene_.law->cut(sweep(*scene_.blade, *before_, tool));
  before_ = tool;
}

void Contact::watch_grip(double grip_ratio) RT_SAFE {
  const bool was_closed = closed_;
  if (grip_ratio >= scene_.parameters.grip_close_ratio) closed_ = true;
  if (!(grip_ratio >= scene_.parameters.grip_open_ratio)) closed_ = false;  // NaN opens
  closing_ = closed_ && !was_closed;
}

void Contact::change_state(const Probe& probe, SphereTouch& touch) RT_SAFE {
  if (touch.state == TouchState::kHeld && !closed_) let_go(probe, touch);
  if (touch.state == TouchState::kHeld) return;
  if (!(probe.depth_m > 0.0)) {
    touch = {.place = probe.site.place,
             .surface_point_m = probe.site.point_m,
             .normal = probe.site.normal};
    scene_.law->leave(index_of(touch));
  } else {
    touch.state = TouchState::kTouching;
  }
}

SiteResponse Contact::ask_law(SphereTouch& touch) RT_SAFE {
  const SiteResponse site = scene_.law->respond({.sphere = index_of(touch),
                                                 .place = touch.place,
                                                 .normal = touch.normal,
                                                 .depth_m = touch.depth_m,
                                                 .held = touch.state == TouchState::kHeld});
  touch.law_status = site.law.status;
  return site;
}

void Contact::feel_touching(Probe& probe, SphereTouch& touch) RT_SAFE {
  const ContactParameters& p = scene_.parameters;
  touch.place = probe.site.place;
  touch.surface_point_m = probe.site.point_m;
  touch.normal = probe.site.normal;
  // d = r - phi - slack
  touch.slack_m = std::min(touch.slack_m + probe.deepened_m, probe.depth_m);
  touch.depth_m = probe.depth_m - touch.slack_m;
  const SiteResponse site = ask_law(touch);
  const LawResponse& law = site.law;
  // t moves with the tool in the tangent plane, up to k_t |t| = mu F
  touch.shift_m = tangential(touch.shift_m + probe.moved_m, touch.normal);
  const double k_t = p.sliding_stiffness_N_per_m;
  const double spring_N = k_t * norm(touch.shift_m);
  const double cap_N = p.friction_ratio * law.force_N;
  if (spring_N > cap_N) touch.shift_m *= cap_N / spring_N;
  // F = F(d) n - k_t t - dU/ds
  touch.force_N = law.force_N * touch.normal - k_t * touch.shift_m -
                  movable(scene_.surface, touch.place, site.slope_N);
  touch.energy_J = law.energy_J + 0.5 * k_t * dot(touch.shift_m, touch.shift_m);
}

void Contact::hold(Probe& probe, SphereTouch& touch) RT_SAFE {
  probe.held_centre_m = probe.centre_m;
  probe.held_normal = touch.normal;
  probe.held_shift_m = touch.shift_m;
  probe.held_depth_m = touch.depth_m;
  touch.state = TouchState::kHeld;
}

void Contact::feel_held(Probe& probe, SphereTouch& touch) RT_SAFE {
  const Vec3 moved_m = probe.centre_m - probe.held_centre_m;
  touch.normal = probe.held_normal;
  touch.depth_m = probe.held_depth_m - dot(moved_m, touch.normal);
  touch.shift_m = probe.held_shift_m + tangential(moved_m, touch.normal);
  const LawResponse law = ask_law(touch).law;
  const double k_t = scene_.parameters.sliding_stiffness_N_per_m;
  // F = F(d) n - k_t t, F(d) < 0 while pulling
  touch.force_N = law.force_N * touch.normal - k_t * touch.shift_m;
  touch.energy_J = law.energy_J + 0.5 * k_t * dot(touch.shift_m, touch.shift_m);
  const double pull_N = std::hypot(at_least_zero(-law.force_N), k_t * norm(touch.shift_m));
  if (!(pull_N <= scene_.parameters.tear_force_N)) {
    let_go(probe, touch);
    change_state(probe, touch);
    if (touch.state == TouchState::kTouching) feel_touching(probe, touch);
  }
}

// The tool may have been dragged to where tissue is stiffer: the largest depth, up to that held,
// that stores no more here than the held one does there. kHalvings bound the work.
double Contact::affordable_depth_m(const Probe& probe, const SphereTouch& held) RT_SAFE {
  constexpr int kHalvings = 12;
  const auto energy_J = [&](const Place& place, const Vec3& normal, double depth_m, bool is_held)
                            RT_SAFE {
                              return scene_.law
                                  ->respond({.sphere = index_of(held),
                                             .place = place,
                                             .normal = normal,
                                             .depth_m = depth_m,
                                             .held = is_held})
                                  .law.energy_J;
                            };
  double high_m = std::min(probe.depth_m, held.depth_m), low_m = 0.0;
  if (!(high_m > 0.0)) return 0.0;
  const double held_J = energy_J(held.place, held.normal, held.depth_m, true);
  const auto affords = [&](double depth_m) RT_SAFE {
    return energy_J(probe.site.place, probe.site.normal, depth_m, false) <= held_J;
  };
  if (affords(high_m)) return high_m;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle_m = 0.5 * (low_m + high_m);
    (affords(middle_m) ? low_m : high_m) = middle_m;
  }
  return low_m;
}

// Back to the surface with no more depth or energy than the held site had, and no stored shift.
// Pressed tissue remembers on: forgotten relaxation would come back as a stiffer push.
void Contact::let_go(const Probe& probe, SphereTouch& touch) RT_SAFE {
  touch.state = TouchState::kTouching;
  touch.slack_m = at_least_zero(probe.depth_m - affordable_depth_m(probe, touch));
  if (!(touch.depth_m > 0.0)) scene_.law->leave(index_of(touch));
  touch.shift_m = {};
}

}  // namespace tact::model
