// SPDX-License-Identifier: Apache-2.0
// rhombus_patch.h - parallel rhombus chains under a round tip, which covers more of them with
// growing depth.
//
// One chain represents the area A of the surface, f and u are its force and energy, and the tip is
// r^2 / (2 R) above the surface at the radius r:
//
//     RC-15  F(d) = (1/A) integral of f(d - gap) 2 pi r dr = (2 pi R / A) u(d)
//     RC-16  K(d) = (2 pi R / A) f(d),    U(d) = (2 pi R / A) integral of u from 0 to d
//     RC-17  w(r) = d - r^2 / (2 R) within sqrt(2 R d), 0 beyond
//
//     d  depth, m     F  force, N     K  stiffness, N/m     U  energy, J     R  tip radius, m
//
// The paraboloid approximates the sphere at small depth. At larger depth it is wider than the
// sphere, which represents tissue next to the tip that is displaced, too. With softening chains F
// grows between d and d^2; SOURCES.md compares that with a sphere on an elastic half-space, and the
// gap of the exact sphere, which fits less well. A chain at its limit keeps its force, while those
// at the contact edge still grow: valid to twice the range of the chain; beyond, the force is
// constant. Pull is set by [pull]. respond() solves the chain and reads U from a table, for set-up
// and tools; the loop reads a table of all.
#pragma once

#include "model/indent/rhombus_chain.h"
#include "model/law/hermite_table.h"

namespace tact::model::indent {

struct RhombusPatchParameters {
  double tip_radius_m = 0.0;  // R, > 0
  double area_m2 = 0.0;       // A, > 0
};

/// The section [rhombus] of a scene.
struct RhombusParameters {
  RhombusChainParameters chain;
  double area_m2 = 0.0;  // A; 0: one chain under the whole tip
};
void visit(ParameterVisitor& v, RhombusParameters& p);

class RhombusPatch final : public law::Law {
 public:
  law::LawResponse respond(double depth_m) const RT_SAFE override;
  law::LawRange range() const RT_SAFE override { return {0.0, press_.end()}; }
  std::size_t profile(double depth_m, std::span<double> ring_m) const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return ring_pitch_m_; }

 private:
  friend Result<RhombusPatch> make_rhombus_patch(const RhombusChain&,
                                                 const RhombusPatchParameters&);
  RhombusPatch(const RhombusChain& chain, const RhombusPatchParameters& p);
  law::CurvePoint under_tip(double depth_m) const RT_SAFE;  // F, K

  RhombusChain chain_;
  double tip_radius_m_;
  double chains_per_m_;  // 2 pi R / A
  double ring_pitch_m_ = 0.0;
  law::HermiteTable press_;  // of F; its integral is U
};

/// The error names the parameter and what is allowed.
Result<RhombusPatch> make_rhombus_patch(const RhombusChain& chain,
                                        const RhombusPatchParameters& parameters);

}  // namespace tact::model::indent
