// SPDX-License-Identifier: Apache-2.0
#include "model/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tact::model::contact {
namespace {

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

Contact::Contact(const ContactScene& scene)
    : scene_(scene),
      moved_({.organ = scene.organ,
              .law = scene.law,
              .friction_ratio = scene.parameters.friction_ratio,
              .sliding_N_per_m = scene.parameters.sliding_stiffness_N_per_m,
              .spheres = scene.spheres}) {
  reset();
}

ContactResponse Contact::feel(const Tool& tool, bool blade_may_cut) RT_SAFE {
  ContactResponse felt = respond(tool);
  felt.is_lost = is_lost_;
  if (was_unsettled_) felt.is_unsettled = true;
  // The force of this tick is that of the tissue before the cut; the cut is felt from the next on.
  use_blade(tool, blade_may_cut);
  return felt;
}

ContactResponse Contact::respond(const Tool& tool) RT_SAFE {
  watch_grip(tool.grip_ratio);
  if (bends())
    respond_moved();
  else
    respond_at_rest();
  ContactResponse felt;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (!probe_[i].is_known) continue;
    felt.wrench.force_N += touch_[i].force_N;
    felt.wrench.torque_Nm += cross(probe_[i].centre_m - tool.position_m, touch_[i].force_N);
    if (touch_[i].law_status == law::LawStatus::kSaturated || probe_[i].lets_go)
      felt.is_saturated = true;
    if (probe_[i].unsolved_ratio > 0.0 || probe_[i].lag_N > 0.0) felt.is_unsettled = true;
    if (touch_[i].state == TouchState::kInside) felt.is_inside = true;
  }
  scene_.law->advance();
  felt.is_broken = scene_.law->is_broken();
  return felt;
}

// This order holds: depths before couplings, couplings before forces; what tears is let go before
// the grip takes hold; friction last, as its cap is the force of the press.
void Contact::respond_at_rest() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    if (probe_[i].is_known) find_depth(i);
  couple_new_spheres();
  keep_definite();
  press();
  for (std::size_t i = 0; i < scene_.spheres.size() && release_first(); ++i) {
  }
  if (closing_ && hold()) press();
  stiffen();
  resist_sliding();
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) sum_up(i);
}

void Contact::use_blade(const Tool& tool, bool may_cut) RT_SAFE {
  if (!scene_.blade) return;
  if (may_cut && blade_tool_before_)
    scene_.law->cut(sweep(*scene_.blade, *blade_tool_before_, tool));
  blade_tool_before_ = tool;
}

void Contact::leave(std::size_t i, TouchState state) RT_SAFE {
  touch_[i] = {};
  touch_[i].state = state;
  Probe& probe = probe_[i];
  probe.axes = {};
  probe.clear_m = -std::numeric_limits<double>::infinity();  // nothing is known
  probe.lets_go = false;
  probe.unsolved_ratio = 0.0;
  shift_m_[i] = shear_N_[i] = {};
  scene_.law->leave(i);
  moved_.leave(i);
}

// d and t of this tick; e follows d as a first guess.
void Contact::find_depth(std::size_t i) RT_SAFE {
  Probe& probe = probe_[i];
  SphereTouch& touch = touch_[i];
  // e moves by what d moves: the guess from which MC-1 is solved is then near.
  const double before_m = touch.depth_m;
  if (touch.state == TouchState::kHeld) {
    const Vec3 moved_m = probe.centre_m - probe.held_centre_m;
    touch.normal = probe.held_normal;
    touch.depth_m = probe.held_depth_m - dot(moved_m, touch.normal);
  } else if (touch.state == TouchState::kTouching) {
    move_to_proxy(i);
    // d = r - phi - slack
    touch.slack_m = std::clamp(touch.slack_m + probe.unpaid_m, 0.0, std::max(probe.depth_m, 0.0));
    let_go(i);
    touch.depth_m = probe.depth_m - touch.slack_m;
    if (probe.lets_go && !(touch.depth_m > 0.0)) return leave(i, TouchState::kFree);
  } else {
    return;
  }
  shift_m_[i] = shift_m_[i] + probe.axes.of(probe.moved_m);
  touch.dent_m += touch.depth_m - before_m;
}

// Where the proxy is. The axes turn with the normal, t and f with them: that takes no energy.
void Contact::move_to_proxy(std::size_t i) RT_SAFE {
  Probe& probe = probe_[i];
  SphereTouch& touch = touch_[i];
  const Site& site = probe.proxy.site();
  touch.place = site.place;
  touch.surface_point_m = site.point_m;
  // A press straight down turns nothing: axes that are not made anew do not drift.
  if (site.normal == touch.normal && probe.axes.unit[0] != Vec3{}) return;
  touch.normal = site.normal;
  probe.axes = axes_of(touch.normal, probe.axes);
}

Indentation Contact::indentation(std::size_t i) const RT_SAFE {
  const SphereTouch& touch = touch_[i];
  return {.sphere = i,
          .place = touch.place,
          .normal = touch.normal,
          .dent_m = touch.dent_m,
          .held = touch.state == TouchState::kHeld,
          .speed_mps = -dot(probe_[i].velocity_mps, touch.normal)};
}

// A sphere that has just come couples with those that are there, for as long as it stays. It meets
// tissue that they have dragged along: its own spring is at rest there.
void Contact::couple_new_spheres() RT_SAFE {
  const std::array<bool, kMaxSpheres> before = in_contact_;
  for (std::size_t i = 0; i < kMaxSpheres; ++i) in_contact_[i] = in_contact(i);
  // Couplings stay from touch to release: MC-3 is a potential only while C is constant. Own springs
  // come first, as couple() bounds each pair by both of them.
  if (in_contact_ == before) return;
  for (std::size_t i = 0; i < kMaxSpheres; ++i)
    if (!in_contact_[i])
      shear_.leave(i);
    else if (!before[i])
      start_tangent_spring(i);
  for (std::size_t i = 0; i < kMaxSpheres; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!in_contact_[i] || !in_contact_[j])
        coupling_[i][j] = coupling_[j][i] = 0.0;
      else if (!before[i] || !before[j])
        couple_pair(i, j);
  shear_.solve();
  // MC-4 for f_i = 0:  t_i <- t_i + sum over j != i of c_ij P_ij f_j, by the forces f of the tick
  // before; then exactly  t_i <- t_i - K_ii^-1 f_i,  f = K t,  K = (diag(G) + c P)^-1
  for (std::size_t i = 0; i < kMaxSpheres; ++i)
    if (in_contact_[i] && !before[i]) {
      shift_m_[i] = shift_m_[i] + shear_.unloaded_m(shear_N_, i);
      shift_m_[i] =
          shift_m_[i] - contact::solve(shear_.own_N_per_m(i), shear_.force_N(shift_m_, i));
    }
}

// On the other's bulge the one that has just come would meet energy that nobody gave: that much is
// slack. Of the two, only one presses yet.
void Contact::couple_pair(std::size_t i, std::size_t j) RT_SAFE {
  const SiteCoupling along = scene_.law->coupling(indentation(i), indentation(j),
                                                  norm(probe_[i].centre_m - probe_[j].centre_m));
  shear_.couple(i, j, along.skin_m_per_N + along.lobe_m_per_N, probe_[i].axes, probe_[j].axes);
  const double c = coupling_m_per_N(along, touch_[i].normal, touch_[j].normal);
  coupling_[i][j] = coupling_[j][i] = c;
  add_slack(i, std::max(0.0, -c * pressing_[j].response.law.force_N));
  add_slack(j, std::max(0.0, -c * pressing_[i].response.law.force_N));
}

// d becomes smaller, and so it stays.
void Contact::add_slack(std::size_t i, double depth_m) RT_SAFE {
  SphereTouch& touch = touch_[i];
  if (touch.state == TouchState::kHeld) {
    probe_[i].held_depth_m -= depth_m;
    touch.depth_m -= depth_m;
  } else if (touch.state == TouchState::kTouching) {
    touch.slack_m = std::clamp(touch.slack_m + depth_m, 0.0, probe_[i].depth_m);
    touch.depth_m = probe_[i].depth_m - touch.slack_m;
  }
}

double Contact::press() RT_SAFE {
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    pressing_[i] = {.presses = in_contact(i),
                    .depth_m = touch_[i].depth_m,
                    .in = indentation(i),
                    .response = {}};
  energy_J_ = press_together(*scene_.law, coupling_, pressing());
  // The guess for the next tick.
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) touch_[i].dent_m = pressing_[i].in.dent_m;
  return energy_J_;
}

// MC-6   C <- q C,   slack_i <- slack_i + (1 - q) sum over j of C_ij F_j
// Sites that are too stiff for their coupling could have two solutions at some depth. Then C
// becomes smaller, and what presses gets slack for it: its force stays, and the change gives no
// energy.
void Contact::keep_definite() RT_SAFE {
  if (std::count(in_contact_.begin(), in_contact_.end(), true) < 2) return;
  std::array<double, kMaxSpheres> stiffest_N_per_m{};
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i)
    if (in_contact_[i])
      stiffest_N_per_m[i] =
          scene_.law->stiffest_N_per_m(touch_[i].place, touch_[i].state == TouchState::kHeld);
  const double share = definite_share(coupling_, stiffest_N_per_m);
  if (share >= 1.0) return;
  std::array<double, kMaxSpheres> spared_m{};
  double spared_J = 0.0;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) {
    if (!pressing_[i].presses) continue;
    spared_m[i] = (1.0 - share) * sunk_m(coupling_, pressing(), i);
    spared_J += pressing_[i].response.law.force_N * spared_m[i];
  }
  // A pull beside a press: scaling C would give energy here.
  if (!(spared_J >= 0.0)) return;
  for (std::size_t i = 0; i < scene_.spheres.size(); ++i) add_slack(i, spared_m[i]);
  for (auto& row : coupling_)
    for (double& m_per_N : row) m_per_N *= share;
}

// F = (F(e) + b d') n - f - dU/ds
void Contact::sum_up(std::size_t i) RT_SAFE {
  SphereTouch& touch = touch_[i];
  if (!in_contact(i)) return tell_force(i, {});
  const SiteResponse& site = pressing_[i].response;
  touch.law_status = site.law.status;
  const double push_N =
      site.law.force_N + scene_.law->resistance_N(pressing_[i].in, site.law.force_N);
  const Axes& axes = probe_[i].axes;
  touch.shift_m = axes.vector(shift_m_[i]);
  Vec3 force_N = push_N * touch.normal - axes.vector(shear_N_[i]);
  // dU/ds belongs to a place that follows the tool; held tissue and a proxy that lags do not.
  if (touch.state == TouchState::kTouching && !probe_[i].proxy.lags())
    force_N -= movable(scene_.surface, touch.place, site.slope_N);
  tell_force(i, force_N);
  touch.energy_J = site.law.energy_J + 0.5 * site.law.force_N * sunk_m(coupling_, pressing(), i) +
                   0.5 * dot(shear_N_[i], shift_m_[i]);
}

}  // namespace tact::model::contact
