// SPDX-License-Identifier: Apache-2.0
// rest_contact.h - contact of a tool's spheres with an organ whose surface stays at rest.
//
// One potential for each sphere (letters: README.md; phi and n of the surface at the proxy,
// proxy.h):
//
//   contact   W = U(e, s) + f . t / 2,   d = r - phi - offset,   |f| <= mu F  (Coulomb cap)
//   held      W = U(e, s) + f . t / 2,   d, s and t relative to the frame at the moment of
//             gripping, no cap, d may be negative (pull)
//
// U is the energy of the contact law (contact_law.h), s the surface point; as s follows the tool,
// the slope of U along the surface adds to the force. t: tangential displacement of the tissue, m,
// f = K t (shear.h), in axes that turn with n. The springs stiffen as the contact grows, until the
// sphere leaves; stiffening keeps the force and lowers the stored energy. On another triangle the
// springs take the stiffness there, if that stores no more energy at the same force.
//
// The input of the law is the indentation e: d minus the coupled displacement by the other spheres
// (coupling.h). The coupling of two spheres is constant from the first touch until one leaves.
// Damping (LW-3) is added last: D at the indentation times the speed of the sphere's depth, so that
// each sphere dissipates energy.
//
// rest_contact.cc: depth and normal force. rest_grip.cc: hold and release. rest_slide.cc:
// tangential forces.
#pragma once

#include "model/contact/contact_scene.h"
#include "model/contact/coupling.h"
#include "model/contact/organ_contact.h"
#include "model/contact/proxy.h"
#include "model/contact/shear.h"

namespace tact::model::contact {

/// A sphere in contact.
struct RestSphere {
  bool is_held = false, is_new = false;  // new: since this tick
  Vec3 centre_m, moved_m, velocity_mps;  // of this tick
  Proxy proxy;
  double unexplained_m = 0.0;  // depth since the last tick that no motion explains
  double reach_m = 0.0;        // r - phi
  double depth_offset_m = 0.0;
  double within_law_m = 0.0;  // e of the last tick within the range of the law
  // Frame of d and t
  SurfacePoint surface_point;
  Vec3 point_m, normal;
  Axes axes;
  Vec3 held_centre_m;
  double held_depth_m = 0.0;
  TangentCompliance tangent_compliance;  // of compliance_triangle
  std::uint32_t compliance_triangle = kNoTriangle;
};

class RestContact final : public OrganContact {
 public:
  explicit RestContact(const ContactScene& scene) : scene_(scene) {}

  void reset() RT_SAFE override;
  void begin(const Sphere& sphere, const ContactPoint& contact_point,
             double explained_m) RT_SAFE override;
  void leave(std::size_t i) RT_SAFE override;
  Step step(Sphere& sphere, const Vec3& moved_m) RT_SAFE override;
  void move(const Sphere& sphere) RT_SAFE override;
  bool must_end(Sphere& sphere) RT_SAFE override;
  double cut_to_law_m(std::size_t i) RT_SAFE override;
  void add_depth_offset(std::size_t i, double depth_m) RT_SAFE override;
  void respond() RT_SAFE override;
  double pull_N(std::size_t i) const RT_SAFE override;
  bool release(std::size_t i) RT_SAFE override;
  bool hold(std::size_t i) RT_SAFE override;
  void finish() RT_SAFE override;
  bool is_solved() const RT_SAFE override { return true; }
  OrganForce report(const Sphere& sphere, SphereContact& reported) const RT_SAFE override;
  void advance() RT_SAFE override {}

 private:
  std::size_t count() const RT_SAFE { return scene_.spheres.size(); }
  std::span<PressingSphere> pressing() RT_SAFE { return {pressing_.data(), count()}; }
  std::span<const PressingSphere> pressing() const RT_SAFE { return {pressing_.data(), count()}; }
  void move_to_proxy(std::size_t i) RT_SAFE;
  void couple_new_spheres() RT_SAFE;
  void couple_pair(std::size_t i, std::size_t j) RT_SAFE;
  void keep_definite() RT_SAFE;
  Indentation indentation(std::size_t i) const RT_SAFE;
  void press() RT_SAFE;
  // rest_slide.cc
  Tensor2 compliance_m_per_N(std::size_t i) const RT_SAFE;
  TangentCompliance ask_tangent_compliance(std::size_t i, bool held) const RT_SAFE;
  void start_tangent_spring(std::size_t i) RT_SAFE;
  void drop_shift(std::size_t i) RT_SAFE;
  void stiffen() RT_SAFE;
  void resist_sliding() RT_SAFE;

  ContactScene scene_;
  std::array<RestSphere, kMaxSpheres> sphere_{};
  std::array<PressingSphere, kMaxSpheres> pressing_{};  // d and e
  std::array<bool, kMaxSpheres> is_coupled_{};          // with spheres that touched before
  Coupling coupling_{};                                 // C in use
  Shear shear_;
  Shear::Shifts shift_m_{}, shear_N_{};  // t, f
  double energy_J_ = 0.0;                // of all presses
  bool is_newly_held_ = false;           // in this tick
};

}  // namespace tact::model::contact
