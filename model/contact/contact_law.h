// SPDX-License-Identifier: Apache-2.0
// contact_law.h - what contact asks of the tissue under each probe sphere, every tick.
//
//     W(d, s)   potential, J, of the depth d at the place s of the undeformed surface
//     F = dW/dd           along the outward normal, as a Law gives it
//     F_s = dW/ds         tangential, N: a tissue that differs from place to place, or is indented
//                         beside the tool, also pushes sideways; without it, sliding makes energy
//
// A contact law may remember (relaxation, a mass-spring patch): respond() may be called more than
// once a tick for one sphere, the last call counts, and advance() ends the tick. Implementations:
// elastic_field.h (closed-form laws, relaxation), spring_patch.h (stepped).
#pragma once

#include <cstddef>

#include "model/contact/blade.h"
#include "model/contact/contact_point.h"
#include "model/contact/indentation_view.h"
#include "model/contact/patch_shape.h"
#include "model/contact/tangent.h"
#include "model/law/law.h"
#include "model/types.h"

namespace tact::model::contact {

/// The most that a place may be stiffer than the organ's own stiffness, a half-space or the mean of
/// its springs: beside what holds it an organ is stiffer than its own surface can show.
inline constexpr double kMaxStiffness_ratio = 3.0;

struct ContactLawResponse {
  law::LawResponse law;
  Vec3 slope_N{};  // F_s, tangential to the touched triangle
};

/// MC-2: how far one contact point of a tissue moves with a unit force at another, m/N.
struct ContactCoupling {
  double near_field_m_per_N = 0.0;  // through the tissue between them: by their directions
  double structural_m_per_N = 0.0;  // as their lobe bends: along its one axis
};

/// MC-5: G = c / a I + S, m/N, a the radius of the contact, m.
struct TangentCompliance {
  double contact_m2_per_N = 0.0;  // c
  Tensor2 rest_m_per_N;           // S

  Tensor2 at(double contact_radius_m) const RT_SAFE {
    const double round_m_per_N = contact_m2_per_N / contact_radius_m;
    return {rest_m_per_N.xx + round_m_per_N, rest_m_per_N.xy, rest_m_per_N.yy + round_m_per_N};
  }
};

/// Everything here belongs to the loop's thread; what others may ask is DentView's.
class ContactLaw : public IndentationView {
 public:
  /// NaN gives zero force and kInvalid.
  virtual ContactLawResponse respond(const Indentation& in) RT_SAFE = 0;
  /// LW-3: what the speed adds to the force of the answer, N, outside of the potential.
  virtual double resistance_N(const Indentation& in, double force_N) const RT_SAFE {
    (void)in, (void)force_N;
    return 0.0;
  }
  /// MC-2: two contact points, distance_m apart, pushed in one direction. 0: the law's own memory
  /// couples them, or nothing is known.
  virtual ContactCoupling coupling(const Indentation& a, const Indentation& b,
                                   double distance_m) const RT_SAFE {
    (void)a, (void)b, (void)distance_m;
    return {};
  }
  /// Largest dF/dd that the contact point can answer at any depth, N/m: how strongly it may couple.
  /// A law whose contact points couple must tell it.
  virtual double stiffest_N_per_m(const SurfacePoint& surface_point, bool held) const RT_SAFE {
    (void)surface_point, (void)held;
    return 0.0;
  }
  /// The most of a force at once that its memory takes away in a tick at rest, as a share.
  virtual double fade_ratio() const RT_SAFE { return 0.0; }
  /// MC-5: how far the contact point gives way along the surface under a unit force, in these axes.
  /// All 0: not known.
  virtual TangentCompliance tangent_compliance(const SurfacePoint& surface_point, bool held,
                                               const Axes& axes) const RT_SAFE {
    (void)surface_point, (void)held, (void)axes;
    return {};
  }
  /// The sphere is free: forget what it did.
  virtual void leave(std::size_t sphere) RT_SAFE = 0;
  /// A blade went through the tissue since the last tick; most laws cannot be cut.
  virtual void cut(const BladeSweep&) RT_SAFE {}
  /// The end of a tick; its length is fixed when the law is made.
  virtual void advance() RT_SAFE = 0;
  /// The law left the finite numbers and gives zero force; true until every sphere has left.
  virtual bool is_broken() const RT_SAFE { return false; }
  /// What a law shows instead of a profile; false: the profile says all.
  virtual bool shape(PatchShape& out) RT_SAFE {
    (void)out;
    return false;
  }
};

}  // namespace tact::model::contact
