// SPDX-License-Identifier: Apache-2.0
#include "model/contact/contact.h"

#include <algorithm>
#include <cmath>

#include "model/contact/detect.h"

namespace tact::model::contact {
namespace {

constexpr int kMaxTickSteps = 64;  // per period

/// Interpolates between two poses. Orientations by the normalised mix, along the shorter rotation:
/// q(s) = ((1 - s) a + s b) / |(1 - s) a + s b|, where b is -b if a . b < 0.
Tool between(const Tool& from, const Tool& to, double share) RT_SAFE {
  const Quat &a = from.orientation, &b = to.orientation;
  // q and -q are the same orientation: take the smaller rotation.
  const double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0.0 ? -1.0 : 1.0;
  const auto mix = [&](double p, double q) RT_SAFE { return (1.0 - share) * p + share * q; };
  Quat turn{mix(a.w, sign * b.w), mix(a.x, sign * b.x), mix(a.y, sign * b.y), mix(a.z, sign * b.z)};
  const double size =
      std::sqrt(turn.w * turn.w + turn.x * turn.x + turn.y * turn.y + turn.z * turn.z);
  if (size > 0.0) turn = {turn.w / size, turn.x / size, turn.y / size, turn.z / size};
  return {.position_m = (1.0 - share) * from.position_m + share * to.position_m,
          .orientation = turn,
          .velocity_mps = to.velocity_mps,
          .angular_velocity_radps = to.angular_velocity_radps,
          .grip_ratio = mix(from.grip_ratio, to.grip_ratio)};
}

}  // namespace

Contact::Contact(const ContactScene& scene)
    : scene_(scene), rest_(scene), moved_(scene), relaxation_ratio_(scene.law->relaxation_ratio()) {
  for (std::size_t i = 0; i < scene.spheres.size(); ++i)
    sphere_[i] = {.index = i, .radius_m = scene.spheres[i].radius_m};
  reset();
}

void Contact::reset() RT_SAFE {
  end_contacts();
  rest_.reset();
  moved_.reset();
  closed_ = closing_ = is_lost_ = was_unsettled_ = false;
}

bool Contact::is_clear() const RT_SAFE {
  return std::all_of(  // bound: spheres
      sphere_.begin(), sphere_.begin() + static_cast<std::ptrdiff_t>(contacts().size()),
      [](const Sphere& sphere)
          RT_SAFE { return !sphere.is_in_contact() && sphere.reported_N == Vec3{}; });
}

// Also the clearances: they depend on the surface and on the spheres only.
void Contact::continue_from(const Contact& before) RT_SAFE {
  goal_m_ = before.goal_m_;
  sphere_ = before.sphere_;
  contact_ = before.contact_;
  closed_ = before.closed_;
  tool_before_ = before.tool_before_;
  blade_tool_before_ = before.blade_tool_before_;
}

// Positions of spheres and blade become unknown, so that the blade cuts nothing in between.
void Contact::end_contacts() RT_SAFE {
  for (Sphere& sphere : spheres()) {  // bound: spheres
    leave(scene_, organ(), sphere, ContactState::kFree);
    sphere = {.index = sphere.index, .radius_m = sphere.radius_m};
    contact_[sphere.index] = {};
  }
  tool_before_.reset();
  blade_tool_before_.reset();
}

void Contact::detect_contact(const Tool& tool, std::uint32_t periods, double reach_m) RT_SAFE {
  is_lost_ = was_unsettled_ = false;
  // A pose with NaN ends all contacts, so that no NaN enters the state.
  if (!is_finite(tool)) return end_contacts();
  place_spheres(tool);
  if (tool_before_ && !is_reached(tool, reach_m)) {
    is_lost_ = true;
    end_contacts();
  }
  const Tool from = tool_before_.value_or(tool);
  for (std::uint32_t k = 1; k < periods; ++k) {  // bound: skipped (periods)
    const Tool way = between(from, tool, static_cast<double>(k) / periods);
    place_spheres(way);
    detect(way);
    if (respond(way).is_unsettled) was_unsettled_ = true;
    place_spheres(tool);
  }
  detect(tool);
  tool_before_ = tool;
}

void Contact::place_spheres(const Tool& tool) RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)  // bound: spheres
    goal_m_[i] = tool.position_m + rotate(tool.orientation, scene_.spheres[i].offset_m);
}

// False if the motion since the last pose is too long to follow.
bool Contact::is_reached(const Tool& tool, double reach_m) const RT_SAFE {
  if (!(norm(tool.position_m - tool_before_->position_m) <= reach_m)) return false;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {  // bound: spheres
    const double way_m = norm(goal_m_[i] - sphere_[i].centre_m);
    if (!(way_m <= kMaxTickSteps * kWay_ratio * sphere_[i].radius_m)) return false;
  }
  return true;
}

void Contact::detect(const Tool& tool) RT_SAFE {
  for (Sphere& sphere : spheres()) {  // bound: spheres
    const Vec3& centre_m = goal_m_[sphere.index];
    sphere.moved_m = sphere.is_known ? centre_m - sphere.centre_m : Vec3{};
    sphere.velocity_mps =
        tool.velocity_mps + cross(tool.angular_velocity_radps, centre_m - tool.position_m);
    const double way_m = norm(sphere.moved_m);
    const int steps = std::clamp(
        static_cast<int>(std::ceil(way_m / (kWay_ratio * sphere.radius_m))), 1, kMaxTickSteps);
    for (int left = steps; left > 0; --left) {  // bound: steps (of the speed limit)
      const Vec3 to_go_m = sphere.is_known ? centre_m - sphere.centre_m : Vec3{};
      sphere.centre_m = left > 1 ? sphere.centre_m + to_go_m / left : centre_m;
      step(scene_, organ(), sphere, to_go_m / left);
    }
    if (sphere.is_in_contact()) organ().move(sphere);
  }
}

ContactResponse Contact::render_force(const Tool& tool, bool blade_may_cut) RT_SAFE {
  ContactResponse rendered = respond(tool);
  rendered.is_lost = is_lost_;
  if (was_unsettled_) rendered.is_unsettled = true;
  // After the forces: the cut changes the force from the next tick on.
  use_blade(tool, blade_may_cut && !rendered.is_inside);
  return rendered;
}

// Held spheres that tear are released before a closing grip bonds spheres.
ContactResponse Contact::respond(const Tool& tool) RT_SAFE {
  watch_grip(tool.grip_ratio);
  for (Sphere& sphere : spheres()) end_contact(sphere);  // bound: spheres
  organ().respond();
  // bound: spheres (each once)
  for (std::size_t i = 0; i < scene_.spheres.size() && release_first(); ++i) {
  }
  if (closing_)
    for (Sphere& sphere : spheres())  // bound: spheres
      if (sphere.state == ContactState::kInContact && organ().hold(sphere.index)) {
        sphere.state = ContactState::kHeld;
        sphere.is_ending = false;
      }
  organ().finish();
  ContactResponse rendered;
  // The longest displacement of all spheres, as coupled spheres change each other's force.
  double way_m = 0.0;
  // bound: spheres
  for (const Sphere& sphere : spheres()) way_m = std::max(way_m, norm(sphere.moved_m));
  for (Sphere& sphere : spheres())  // bound: spheres
    if (sphere.is_known) report(sphere, tool, way_m, rendered);
  organ().advance();
  scene_.law->advance();
  rendered.is_broken = scene_.law->is_broken();
  return rendered;
}

void Contact::report(Sphere& sphere, const Tool& tool, double way_m,
                     ContactResponse& rendered) RT_SAFE {
  SphereContact& sphere_contact = contact_[sphere.index];
  const Vec3 last_normal = sphere_contact.normal;
  sphere_contact = {};
  sphere_contact.state = sphere.state;
  if (sphere.state == ContactState::kInside) rendered.is_inside = true;
  if (!sphere.is_in_contact() && sphere.reported_N == Vec3{}) {
    sphere.largest_N = sphere.lag_N = 0.0;
    sphere.was_held = false;
    return;
  }
  const OrganForce answer = response_of(sphere);
  follow_force(sphere, answer.elastic_N, way_m);
  if (!sphere.is_in_contact() && sphere.reported_N != Vec3{}) sphere_contact.normal = last_normal;
  sphere_contact.force_N = sphere.reported_N + resistance_N(sphere, answer.resistance_N);
  rendered.wrench.force_N += sphere_contact.force_N;
  rendered.wrench.torque_Nm += cross(sphere.centre_m - tool.position_m, sphere_contact.force_N);
  if (sphere_contact.law_status == law::LawStatus::kSaturated || sphere.is_ending)
    rendered.is_saturated = true;
  if (sphere.unsolved_ratio > 0.0 || sphere.lag_N > 0.0) rendered.is_unsettled = true;
}

void Contact::watch_grip(double grip_ratio) RT_SAFE {
  // Hysteresis: with one threshold a trembling hand would grip and release many times a second.
  const bool was_closed = closed_;
  if (grip_ratio >= scene_.parameters.grip_close_ratio) closed_ = true;
  if (!(grip_ratio >= scene_.parameters.grip_open_ratio)) closed_ = false;  // NaN opens
  closing_ = closed_ && !was_closed;
}

// Shrinks the depth to 0. While the depth is beyond the law's range, the force is the law's limit.
void Contact::end_contact(Sphere& sphere) RT_SAFE {
  if (sphere.state != ContactState::kInContact) return;
  if (!sphere.is_ending) {
    sphere.is_ending = organ().must_end(sphere);
    if (!sphere.is_ending) return;
    sphere.shrinks_m = organ().cut_to_law_m(sphere.index);
  }
  organ().add_depth_offset(sphere.index, kSlide_ratio * norm(sphere.moved_m) +
                                             sphere.shrinks_m * scene_.period_s / kEnding_s);
}

// Releases only the first sphere that must be released, as that changes the force on the others.
bool Contact::release_first() RT_SAFE {
  for (Sphere& sphere : spheres()) {  // bound: spheres
    if (sphere.state != ContactState::kHeld) continue;
    // NaN tears, so that it cannot hold the tool.
    if (closed_ && organ().pull_N(sphere.index) <= scene_.parameters.tear_force_N) continue;
    if (organ().release(sphere.index))
      sphere.state = ContactState::kInContact;
    else
      leave(scene_, organ(), sphere, ContactState::kFree);
    return true;
  }
  return false;
}

// Without a solution the last force is kept and ramps down within 0.1 s or one radius of motion.
OrganForce Contact::response_of(Sphere& sphere) RT_SAFE {
  if (!sphere.is_in_contact()) return {};
  SphereContact& sphere_contact = contact_[sphere.index];
  if (organ().is_solved())
    sphere.unsolved_ratio = 0.0;
  else
    sphere.unsolved_ratio += scene_.period_s / kEnding_s + norm(sphere.moved_m) / sphere.radius_m;
  const OrganForce answer = organ().report(sphere, sphere_contact);
  // 0: not known.
  sphere.stiffest_N_per_m = scene_.law->stiffest_N_per_m(sphere_contact.surface_point,
                                                         sphere.state == ContactState::kHeld);
  const double share = std::max(1.0 - sphere.unsolved_ratio, 0.0);
  return {share * answer.elastic_N, share * answer.resistance_N};
}

// FR-2  R' = R min(1, -P . R / |R|^2)   where P . R < 0
// While the force lags, resistance must not pull a sphere into the organ unless it is held.
Vec3 Contact::resistance_N(const Sphere& sphere, const Vec3& answer_N) const RT_SAFE {
  const double size_N = norm(answer_N);
  if (!(sphere.lag_N > 0.0) || sphere.state == ContactState::kHeld || !(size_N > 0.0))
    return answer_N;
  const double along_N = dot(sphere.reported_N, answer_N) / size_N;
  return along_N > 0.0 ? answer_N : std::min(-along_N / size_N, 1.0) * answer_N;
}

// FR-1  |P' - P| <= n + 10 K w + (2 q + r) P_max + J T / T_r
// P: reported_N. n: kNoise_N. K: stiffest_N_per_m. w: way_m. q: relaxation_ratio_. r: ending_ratio.
// P_max: largest_N. J: lag_N. T: period_s. T_r: kEnding_s.
// The wanted force may jump when the organ snaps to another shape, a solution is found again, or
// the proxy reaches another side. The reported force P follows. While it lags behind a lost force,
// the hand gets at most a tenth of the energy that was lost.
void Contact::follow_force(Sphere& sphere, const Vec3& wanted_N, double way_m) RT_SAFE {
  constexpr double kSteepest_ratio = 10.0, kRelaxation_ratio = 2.0, kEnding_ratio = 2.0;
  constexpr double kNoise_N = 1e-3;  // numerical noise of a solution
  const Vec3 change_N = wanted_N - sphere.reported_N;
  const double length_N = norm(change_N);
  sphere.largest_N = sphere.is_in_contact() ? std::max(sphere.largest_N, norm(wanted_N)) : 0.0;
  // A contact that is ending loses its force in 0.1 s, or faster if its law is steep.
  const double ending_ratio = sphere.is_ending ? kEnding_ratio * scene_.period_s / kEnding_s : 0.0;
  const double smooth_N = kNoise_N + kSteepest_ratio * sphere.stiffest_N_per_m * way_m +
                          (kRelaxation_ratio * relaxation_ratio_ + ending_ratio) * sphere.largest_N;
  const bool is_held = sphere.state == ContactState::kHeld;
  // When held tissue is released or tears, the force drops in one tick.
  const bool is_released = sphere.was_held && !is_held && organ().is_solved() &&
                           norm(wanted_N) <= norm(sphere.reported_N);
  const bool is_lag = length_N > smooth_N && sphere.stiffest_N_per_m > 0.0 && !is_released;
  sphere.lag_N = is_lag ? std::max(sphere.lag_N, length_N) : 0.0;
  const double most_N = smooth_N + sphere.lag_N * scene_.period_s / kEnding_s;
  sphere.reported_N =
      is_lag && length_N > most_N ? sphere.reported_N + (most_N / length_N) * change_N : wanted_N;
  sphere.was_held = is_held;
}

void Contact::use_blade(const Tool& tool, bool may_cut) RT_SAFE {
  if (!scene_.blade) return;
  if (may_cut && blade_tool_before_)
    scene_.law->cut(sweep(*scene_.blade, *blade_tool_before_, tool));
  blade_tool_before_ = tool;
}

}  // namespace tact::model::contact
