// SPDX-License-Identifier: Apache-2.0
// spring_patch.h - masses and springs near the contact, stepped every tick: a law with inertia.
//
//     nodes     vertices of the surface near the contact (patch_region.h), mass m each
//     springs   along the edges, and from every node to its rest position (patch_surface.h)
//     tool      W = q (d - w(s))^2 / 2 + springs,  F = dW/dd = q (d - w),  F_s = dW/ds = -F grad w
//               w(s) = sum of weight_i(s) (-n_i).(x_i - X_i)        indentation at the place s
//     tick      substeps of an integrator (integrators.h) with d and s held
//
//     d  depth of the tool, m    q  coupling, N/m    n_i  vertex normal    x, X  position, rest, m
//
// The virtual spring q is between tool and nodes: it is all the stiffness that the hand can
// meet in one tick, it never pulls unless the contact point is held, and its reaction falls on the
// corners with the same weights and directions with which w is read. So W is one potential for any
// place, also across an edge, and the tool can only get back what it stored; springs and drag take
// the rest. Tissue that relaxes shares its energy out (patch_memory.h); the virtual spring does
// not.
//
// Where the organ is known (`organ`), the tool gets the force of that law alone: the nodes follow
// the tool, can be cut, and give it nothing back. A net of springs cannot be an elastic body: its
// indentation fades within a length of its own, and its force grows with the depth, not with d^1.5.
//
// Without it, sideways the tool drags its place with that compliance, and the nodes do not move
// (MA-21): the virtual spring and the tissue in a row, for any radius, since a node is the smallest
// contact.
//
// Valid for |d| <= working_depth_m; beyond, the force is that of the limit and kSaturated. Cost a
// tick: the region's nodes, for any mesh. If a node becomes NaN or infinite, or an
// indentation exceeds ten times the working depth, all nodes are reset and the patch gives zero
// force and kSingular until every sphere has left; the step check of make_* prevents that.
// Source: MA-1 to MA-9; coupling and cut are ours.
#pragma once

#include <array>
#include <memory>

#include "model/contact/contact_law.h"
#include "model/parameters.h"
#include "model/result.h"
#include "model/springs/integrators.h"
#include "model/springs/patch_region.h"

namespace tact::model::springs {

struct SpringPatchParameters {
  PatchTissue tissue{};                     // k and a_mean > 0, 0 <= p <= 0.5
  double coupling_stiffness_N_per_m = 0.0;  // q, > 0
  double node_mass_kg = 0.0;     // m, > 0; the least that the step allows is closest to tissue
  double working_depth_m = 0.0;  // > 0
  double tick_s = 0.001;
  std::size_t spheres = 1;  // of the tool, 1 .. kMaxSpheres
  std::size_t nodes = 500;  // 16 .. kMaxPatchNodes
  Method method{};
  std::size_t iterations = 10;  // of implicit Euler
  std::size_t substeps = 1;
  law::Relaxation relaxation{};  // made for tick_s; of springs and anchors, not of the coupling
  contact::ContactLaw* organ = nullptr;  // the organ under the tool; outlives the patch
};
void visit(ParameterVisitor& v, SpringPatchParameters& p);

class SpringPatch final : public contact::ContactLaw {
 public:
  contact::ContactLawResponse respond(const contact::Indentation& in) RT_SAFE override;
  contact::TangentCompliance tangent_compliance(const contact::SurfacePoint& surface_point,
                                                bool held,
                                                const contact::Axes& axes) const RT_SAFE override;
  void leave(std::size_t sphere) RT_SAFE override;
  void cut(const contact::BladeSweep& sweep) RT_SAFE override { region_.cut(sweep); }
  void advance() RT_SAFE override;
  bool is_broken() const RT_SAFE override { return broke_; }
  std::size_t profile(const contact::Indentation&, std::span<double>) const RT_SAFE override {
    return 0;
  }
  double resistance_N(const contact::Indentation& in, double force_N) const RT_SAFE override;
  contact::ContactCoupling coupling(const contact::Indentation& a, const contact::Indentation& b,
                                    double distance_m) const RT_SAFE override;
  double stiffest_N_per_m(const contact::SurfacePoint& surface_point,
                          bool held) const RT_SAFE override;
  double relaxation_ratio() const RT_SAFE override;
  double ring_pitch_m() const RT_SAFE override { return ring_pitch_m_; }

  /// Displaced vertices, cut edges first, then the nearest to the contact; cost bounded.
  bool shape(contact::PatchShape& out) RT_SAFE override;

  /// Springs, anchors and virtual springs, above the intact surface at rest; a cut takes it below
  /// 0.
  double stored_energy_J() RT_SAFE;
  double kinetic_energy_J() RT_SAFE;
  const PatchRegion& region() const RT_SAFE { return region_; }
  std::size_t memory_bytes() const;

 private:
  friend Result<std::unique_ptr<SpringPatch>> make_spring_patch(const contact::SurfaceView&,
                                                                const SpringPatchParameters&);
  struct SphereState {
    bool active = false;
    bool held = false;
    double depth_m = 0.0;
    contact::SurfacePoint surface_point{};
  };

  SpringPatch(PatchSurface surface, const SpringPatchParameters& parameters);
  contact::ContactLaw* organ() const RT_SAFE { return parameters_.organ; }
  std::span<const ProbeSpring> probes() RT_SAFE;
  void follow_contacts() RT_SAFE;
  void give_up() RT_SAFE;

  SpringPatchParameters parameters_;
  PatchRegion region_;
  SpringStepper stepper_;
  std::array<SphereState, contact::kMaxSpheres> contact_{};
  std::array<ProbeSpring, contact::kMaxSpheres> probe_{};
  std::array<std::uint32_t, contact::kMaxSpheres> gathered_{};  // triangles of the last gathering
  double network_energy_J_ = 0.0;
  double ring_pitch_m_ = 0.0;   // mean edge
  std::uint32_t next_cut_ = 0;  // the first of the next window of cut triangles
  bool broke_ = false;
};

/// Checks parameters, mesh and step (spring_step_check.h). The surface outlives the patch.
Result<std::unique_ptr<SpringPatch>> make_spring_patch(const contact::SurfaceView& surface,
                                                       const SpringPatchParameters& parameters);

}  // namespace tact::model::springs
