// SPDX-License-Identifier: Apache-2.0
#include "model/contact/rest_contact.h"

#include <algorithm>

#include "model/contact/detect.h"

namespace tact::model::contact {
namespace {

// The part of a tangential vector along which the nearest point can move: all of it on a face, the
// component along an edge, nothing in a vertex.
Vec3 movable(const SurfaceView& s, const SurfacePoint& surface_point, const Vec3& v) RT_SAFE {
  const TriangleCorners& corner = s.triangle[surface_point.triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    if (surface_point.weight[i] != 0.0) continue;
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    if (surface_point.weight[j] == 0.0 || surface_point.weight[k] == 0.0) return {};
    const Vec3 along = normalized(s.vertex_m[corner[k]] - s.vertex_m[corner[j]]);
    return dot(v, along) * along;
  }
  return v;
}

}  // namespace

void RestContact::reset() RT_SAFE {
  sphere_ = {};
  pressing_ = {};
  is_coupled_ = {};
  coupling_ = {};
  shear_ = Shear(count());
  shift_m_ = shear_N_ = {};
  energy_J_ = 0.0;
}

void RestContact::begin(const Sphere& sphere, const ContactPoint& contact_point,
                        double explained_m) RT_SAFE {
  constexpr double kMinUnexplained_m = 1e-12;
  RestSphere& s = sphere_[sphere.index];
  s.centre_m = sphere.centre_m;
  s.proxy.restart(contact_point, sphere.radius_m);
  const double unexplained_m = sphere.radius_m - contact_point.distance_m - explained_m;
  s.unexplained_m = unexplained_m > kMinUnexplained_m ? unexplained_m : 0.0;
  s.is_new = pressing_[sphere.index].presses = true;
}

void RestContact::leave(std::size_t i) RT_SAFE {
  sphere_[i] = {};
  pressing_[i] = {};
  shift_m_[i] = shear_N_[i] = {};
}

Step RestContact::step(Sphere& sphere, const Vec3& moved_m) RT_SAFE {
  RestSphere& s = sphere_[sphere.index];
  s.proxy.follow(scene_.surface, sphere.centre_m, moved_m, sphere.radius_m);
  s.unexplained_m += s.proxy.lengthened_m();
  if (s.is_held) return Step::kStays;
  const PressingSphere& pressing = pressing_[sphere.index];
  if (sphere.is_ending && !(pressing.in.indentation_m > 0.0)) return Step::kLeaves;
  // The offset cancels all of the depth: the sphere may be at another part of the organ.
  const bool is_all_offset = s.depth_offset_m > 0.0 && !(pressing.depth_m > 0.0);
  return s.proxy.contact_point().distance_m < sphere.radius_m && !is_all_offset ? Step::kStays
                                                                                : Step::kLeaves;
}

// Sets d and t of this tick, and a first guess of e.
void RestContact::move(const Sphere& sphere) RT_SAFE {
  const std::size_t i = sphere.index;
  RestSphere& s = sphere_[i];
  PressingSphere& pressing = pressing_[i];
  s.centre_m = sphere.centre_m;
  s.moved_m = sphere.moved_m;
  s.velocity_mps = sphere.velocity_mps;
  s.reach_m = sphere.radius_m - s.proxy.contact_point().distance_m;
  // e changes by the change of d: a good guess for MC-1.
  const double before_m = pressing.depth_m;
  if (s.is_held) {
    pressing.depth_m = s.held_depth_m - dot(sphere.centre_m - s.held_centre_m, s.normal);
  } else {
    move_to_proxy(i);
    // d = r - phi - offset
    s.depth_offset_m =
        std::clamp(s.depth_offset_m + s.unexplained_m, 0.0, std::max(s.reach_m, 0.0));
    pressing.depth_m = s.reach_m - s.depth_offset_m;
    if (pressing.response.law.status != law::LawStatus::kSaturated)
      s.within_law_m = pressing.in.indentation_m;
  }
  s.unexplained_m = 0.0;
  shift_m_[i] = shift_m_[i] + s.axes.of(sphere.moved_m);
  pressing.in.indentation_m += pressing.depth_m - before_m;
}

// Moves the surface point to the proxy. Axes, t and f turn with the normal, which needs no energy.
void RestContact::move_to_proxy(std::size_t i) RT_SAFE {
  RestSphere& s = sphere_[i];
  const ContactPoint& contact_point = s.proxy.contact_point();
  s.surface_point = contact_point.surface_point;
  s.point_m = contact_point.point_m;
  // If the normal has not changed, the axes are kept, so that they do not drift.
  if (contact_point.normal == s.normal && s.axes.unit[0] != Vec3{}) return;
  s.normal = contact_point.normal;
  s.axes = axes_of(s.normal, s.axes);
}

// False while a thin part of the organ is between the sphere and its surface point.
bool RestContact::must_end(Sphere& sphere) RT_SAFE {
  const RestSphere& s = sphere_[sphere.index];
  const bool is_beyond = pressing_[sphere.index].response.law.status == law::LawStatus::kSaturated;
  const ContactPoint& contact_point = s.proxy.contact_point();
  // At the nearest point of the side from which it came, with its centre outside.
  if (!is_beyond && !s.proxy.lags() && contact_point.distance_m > 0.0) return false;
  return is_outside(scene_, sphere) &&
         (is_beyond || is_open_way(scene_, contact_point.point_m, sphere.centre_m));
}

double RestContact::cut_to_law_m(std::size_t i) RT_SAFE {
  const double indentation_m = pressing_[i].in.indentation_m;
  const double within_m = std::clamp(sphere_[i].within_law_m, 0.0, std::max(indentation_m, 0.0));
  add_depth_offset(i, indentation_m > 0.0 ? indentation_m - within_m : pressing_[i].depth_m);
  return std::max(pressing_[i].depth_m, 0.0);
}

// Reduces d permanently.
void RestContact::add_depth_offset(std::size_t i, double depth_m) RT_SAFE {
  RestSphere& s = sphere_[i];
  PressingSphere& pressing = pressing_[i];
  if (!pressing.presses) return;
  if (s.is_held) {
    s.held_depth_m -= depth_m;
    pressing.depth_m -= depth_m;
  } else {
    s.depth_offset_m = std::clamp(s.depth_offset_m + depth_m, 0.0, std::max(s.reach_m, 0.0));
    pressing.depth_m = s.reach_m - s.depth_offset_m;
  }
}

// Couplings must be updated before forces.
void RestContact::respond() RT_SAFE {
  couple_new_spheres();
  keep_definite();
  press();
  for (RestSphere& s : sphere_) s.is_new = false;  // bound: kMaxSpheres
}

// Couples a new sphere with the others until it leaves. They may have displaced its tissue
// sideways: its tangential spring starts unloaded there.
void RestContact::couple_new_spheres() RT_SAFE {
  const std::array<bool, kMaxSpheres> before = is_coupled_;
  // bound: spheres
  for (std::size_t i = 0; i < count(); ++i) is_coupled_[i] = pressing_[i].presses;
  // Couplings are constant from touch to release, as MC-3 is a potential only for constant C. The
  // spheres' springs are set first, as couple() bounds each pair by both springs.
  if (is_coupled_ == before) return;
  for (std::size_t i = 0; i < count(); ++i)  // bound: spheres
    if (!is_coupled_[i])
      shear_.leave(i);
    else if (!before[i])
      start_tangent_spring(i);
  for (std::size_t i = 0; i < count(); ++i)  // bound: spheres
    for (std::size_t j = 0; j < i; ++j)      // bound: spheres - 1; pairs in all
      if (!is_coupled_[i] || !is_coupled_[j])
        coupling_[i][j] = coupling_[j][i] = 0.0;
      else if (!before[i] || !before[j])
        couple_pair(i, j);
  shear_.solve();
  // MC-4 for f_i = 0:  t_i <- t_i + sum over j != i of (h + b) A_ij f_j, by the forces f of the
  // tick before; then exactly  t_i <- t_i - K_ii^-1 f_i,  f = K t,  K = (diag(G) + (h + b) A)^-1
  for (std::size_t i = 0; i < count(); ++i)  // bound: spheres
    if (is_coupled_[i] && !before[i]) {
      shift_m_[i] = shift_m_[i] + shear_.unloaded_m(shear_N_, i);
      shift_m_[i] =
          shift_m_[i] - contact::solve(shear_.own_N_per_m(i), shear_.force_N(shift_m_, i));
    }
}

// A new contact on tissue that its neighbour raises would gain energy: that depth is offset. Only
// one of the two spheres presses so far.
void RestContact::couple_pair(std::size_t i, std::size_t j) RT_SAFE {
  const ContactCoupling along = scene_.law->coupling(
      indentation(i), indentation(j), norm(sphere_[i].centre_m - sphere_[j].centre_m));
  shear_.couple(i, j, along.near_field_m_per_N + along.structural_m_per_N, sphere_[i].axes,
                sphere_[j].axes);
  const double c = coupling_m_per_N(along, sphere_[i].normal, sphere_[j].normal);
  coupling_[i][j] = coupling_[j][i] = c;
  add_depth_offset(i, std::max(0.0, -c * pressing_[j].response.law.force_N));
  add_depth_offset(j, std::max(0.0, -c * pressing_[i].response.law.force_N));
}

Indentation RestContact::indentation(std::size_t i) const RT_SAFE {
  const RestSphere& s = sphere_[i];
  return {.sphere = i,
          .surface_point = s.surface_point,
          .normal = s.normal,
          .indentation_m = pressing_[i].in.indentation_m,
          .held = s.is_held,
          .speed_mps = -dot(s.velocity_mps, s.normal)};
}

void RestContact::press() RT_SAFE {
  for (std::size_t i = 0; i < count(); ++i) pressing_[i].in = indentation(i);  // bound: spheres
  energy_J_ = press_together(*scene_.law, coupling_, pressing());
}

// MC-6   C <- q C,   offset_i <- offset_i + (1 - q) sum over j of C_ij F_j
// With contact points too stiff for their coupling there could be two solutions at some depth. Then
// C is reduced, and pressing spheres get an offset, so that forces stay and no energy is added.
void RestContact::keep_definite() RT_SAFE {
  if (std::count(is_coupled_.begin(), is_coupled_.end(), true) < 2) return;  // bound: kMaxSpheres
  std::array<double, kMaxSpheres> stiffest_N_per_m{};
  for (std::size_t i = 0; i < count(); ++i)  // bound: spheres
    if (is_coupled_[i])
      stiffest_N_per_m[i] =
          scene_.law->stiffest_N_per_m(sphere_[i].surface_point, sphere_[i].is_held);
  const double share = definite_share(coupling_, stiffest_N_per_m);
  if (share >= 1.0) return;
  std::array<double, kMaxSpheres> spared_m{};
  double spared_J = 0.0;
  for (std::size_t i = 0; i < count(); ++i) {  // bound: spheres
    if (!pressing_[i].presses || sphere_[i].is_new) continue;
    spared_m[i] = (1.0 - share) * coupled_m(coupling_, pressing(), i);
    spared_J += pressing_[i].response.law.force_N * spared_m[i];
  }
  // One sphere pulls, another presses: reducing C would add energy.
  if (!(spared_J >= 0.0)) return;
  for (std::size_t i = 0; i < count(); ++i) add_depth_offset(i, spared_m[i]);  // bound: spheres
  for (auto& row : coupling_)                                                  // bound: kMaxSpheres
    for (double& m_per_N : row) m_per_N *= share;                              // bound: kMaxSpheres
}

// Friction is last, as its cap depends on the normal force.
void RestContact::finish() RT_SAFE {
  if (is_newly_held_) press();
  is_newly_held_ = false;
  stiffen();
  resist_sliding();
}

// P = (F(e) + D d') n - f - dU/ds
OrganForce RestContact::report(const Sphere& sphere, SphereContact& reported) const RT_SAFE {
  const std::size_t i = sphere.index;
  const RestSphere& s = sphere_[i];
  const ContactLawResponse& contact_point = pressing_[i].response;
  const Vec2 &f_N = shear_N_[i], &t_m = shift_m_[i];
  reported.law_status = contact_point.law.status;
  reported.surface_point = s.surface_point;
  reported.surface_point_m = s.point_m;
  reported.normal = s.normal;
  reported.shift_m = s.axes.vector(t_m);
  reported.depth_m = pressing_[i].depth_m;
  reported.indentation_m = pressing_[i].in.indentation_m;
  reported.depth_offset_m = s.depth_offset_m;
  reported.energy_J = contact_point.law.energy_J +
                      0.5 * contact_point.law.force_N * coupled_m(coupling_, pressing(), i) +
                      0.5 * dot(f_N, t_m);
  Vec3 force_N = contact_point.law.force_N * s.normal - s.axes.vector(f_N);
  // dU/ds acts only if the surface point follows the tool: not if held or with a lagging proxy.
  if (!s.is_held && !s.proxy.lags())
    force_N -= movable(scene_.surface, s.surface_point, contact_point.slope_N);
  return {force_N, scene_.law->resistance_N(pressing_[i].in, contact_point.law.force_N) * s.normal};
}

}  // namespace tact::model::contact
