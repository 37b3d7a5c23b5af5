// SPDX-License-Identifier: Apache-2.0
// indentation.h - a tool on one site of an organ: what is moved, what force that takes, what shape.
//
// press: a rigid frictionless sphere of radius R goes in by d along the inward vertex normal. Nodes
// of the faces whose centre is within the contact radius a of the axis follow it,
//
//     u_n = d - (R - sqrt(R^2 - rho^2)) - s
//
// rho distance from the axis, s how far the resting surface lies below the site's tangent plane (an
// organ is not flat). They slide freely sideways. The force is largest for the true a (J. R.
// Barber, J. Elast. 4 (1974) 31), so a small error in a is a much smaller one in F. On a half-space
// a is known (half_space.h); where the organ gives way as a whole or its surface falls away it is
// smaller, and solve_once (solve_cache.h) finds it (contact_radius.h). At large strain the surface
// slides along the sphere and no radius tells which nodes touch: the sphere comes as a rigid body
// and the contact is found while it goes in (ball_press.h). pull: the faces within R of the axis
// move outward as one piece, bonded.
#pragma once

#include "model/mesh/mesh.h"
#include "tools/ground_truth/reference_data.h"
#include "tools/reference/calculix/calculix.h"
#include "tools/reference/organ/organ_body.h"

namespace tact::tools::reference {

/// Everything about the organ that does not depend on the site.
struct Organ {
  model::mesh::SurfaceMesh surface;  // mesh's own frame
  std::string hash;                  // of the surface
  mesh::HeldBox held{};
  Elasticity material{};
  double size_ratio = 1.0;  // of the edges far inside: 1 suits a body as large as a hand
};

struct Indentation {
  std::uint32_t vertex = 0;
  double tool_radius_m = 0.0;
  double depth_m = 0.0;  // > 0 press, < 0 pull
  bool large_strain = false;
  int level = 2;                  // of the mesh, kRoughLevel to kFinestLevel
  double contact_radius_m = 0.0;  // of a press; 0: that of the half-space at this depth
  // A round patch dragged depth_m along the surface as one piece; it needs a contact radius.
  model::Vec3 along{};  // unit, tangential; 0: the tool moves along the normal
  bool held = false;    // it cannot rise or sink

  bool is_sideways() const { return norm(along) > 0.0; }
  bool is_bonded() const { return depth_m < 0.0 || is_sideways(); }
};

inline constexpr int kRoughLevel = 0;  // for the error of the coarsest level only
inline constexpr int kCoarsestLevel = 1;
inline constexpr int kFinestLevel = 4;
inline constexpr double kRingPitch_m = 1e-3;
inline constexpr int kRings = 31;  // 0 .. 30 mm

/// The mesh for a level; `at_m` is the site.
ground_truth::EdgeLengths edge_lengths(const Organ& organ, const Indentation& what);

/// Meshes and solves. The error ratio is left at 0: it takes two levels.
model::Result<ground_truth::ReferenceCase> solve(const Organ& organ, const Indentation& what);

/// Mean of u (by node) over the rings at k * kRingPitch_m from `at_m`, straight distance, along the
/// faces that look along `outward`; `middle_u` is ring 0.
std::vector<double> ring_means(const OrganBody& body, const model::Vec3& at_m,
                               const model::Vec3& outward, const std::vector<double>& u,
                               double middle_u);

}  // namespace tact::tools::reference
