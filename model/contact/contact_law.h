// SPDX-License-Identifier: Apache-2.0
// contact_law.h - interface to the tissue under each probe sphere; contact calls it every tick.
//
//     W(d, s)   potential, J, of the depth d at the surface point s of the undeformed surface
//     F = dW/dd           along the outward normal, from a Law
//     F_s = dW/ds         tangential, N: not zero if the tissue varies along the surface or is
//                         indented next to the tool; without it sliding would add energy
//
// A contact law may have state (relaxation, a mass-spring patch): respond() may be called more than
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

/// Upper bound of the stiffness at a surface point over that of the organ's half-space or the mean
/// of its springs. Near its fixed boundary an organ is stiffer than its surface can render.
inline constexpr double kMaxStiffness_ratio = 3.0;

struct ContactLawResponse {
  law::LawResponse law;
  Vec3 slope_N{};  // F_s, tangential to the triangle of the surface point
};

/// MC-2: displacement of one contact point under a unit force at another, m/N.
struct ContactCoupling {
  double near_field_m_per_N = 0.0;  // through the tissue between them; depends on both normals
  double structural_m_per_N = 0.0;  // by bending of the organ along one axis
};

/// MC-5: G = B / a I + S, m/N, a the radius of the contact, m.
struct TangentCompliance {
  double contact_m2_per_N = 0.0;  // B
  Tensor2 rest_m_per_N;           // S

  Tensor2 at(double contact_radius_m) const RT_SAFE {
    const double round_m_per_N = contact_m2_per_N / contact_radius_m;
    return {rest_m_per_N.xx + round_m_per_N, rest_m_per_N.xy, rest_m_per_N.yy + round_m_per_N};
  }
};

/// Only the loop's thread may call this class; other threads may call IndentationView.
class ContactLaw : public IndentationView {
 public:
  /// NaN gives zero force and kInvalid.
  virtual ContactLawResponse respond(const Indentation& in) RT_SAFE = 0;
  /// LW-3: force added by the speed, N; not part of the potential.
  virtual double resistance_N(const Indentation& in, double force_N) const RT_SAFE {
    (void)in, (void)force_N;
    return 0.0;
  }
  /// MC-2: coupling of two contact points, distance_m apart. 0: not known, or the law's state
  /// couples them.
  virtual ContactCoupling coupling(const Indentation& a, const Indentation& b,
                                   double distance_m) const RT_SAFE {
    (void)a, (void)b, (void)distance_m;
    return {};
  }
  /// Largest dF/dd of the contact point at any depth, N/m; it bounds the coupling. Required of a
  /// law with coupling(). 0: not known.
  virtual double stiffest_N_per_m(const SurfacePoint& surface_point, bool held) const RT_SAFE {
    (void)surface_point, (void)held;
    return 0.0;
  }
  /// Largest decrease of the instantaneous force by relaxation in a tick at constant depth, as a
  /// ratio.
  virtual double relaxation_ratio() const RT_SAFE { return 0.0; }
  /// MC-5: tangential compliance of the contact point in these axes. All 0: not known.
  virtual TangentCompliance tangent_compliance(const SurfacePoint& surface_point, bool held,
                                               const Axes& axes) const RT_SAFE {
    (void)surface_point, (void)held, (void)axes;
    return {};
  }
  /// The sphere is free: deletes its state.
  virtual void leave(std::size_t sphere) RT_SAFE = 0;
  /// A blade has swept through the tissue since the last tick; most laws cannot be cut.
  virtual void cut(const BladeSweep&) RT_SAFE {}
  /// Ends a tick; the period is fixed when the law is made.
  virtual void advance() RT_SAFE = 0;
  /// The law's state is not finite and its force is zero; true until every sphere has left.
  virtual bool is_broken() const RT_SAFE { return false; }
  /// Displaced shape of a law without a profile; false: the law has a profile.
  virtual bool shape(PatchShape& out) RT_SAFE {
    (void)out;
    return false;
  }
};

}  // namespace tact::model::contact
