// SPDX-License-Identifier: Apache-2.0
// compliance_family.h - the laws of a whole organ: a few curves from soft to stiff, and where each
// vertex is among them.
//
//     CF-1   q = 1 / (c_disc + r)                                  pull stiffness of a place, N/m
//     CF-2   kappa = (K - 1) ln(q / q_0) / ln(q_(K-1) / q_0)       0 .. K - 1
//     CF-3   r_pull = r - n1^2 / (c_side + s1) - n2^2 / (c_side + s2)
//
// A tip pressed without friction has the coordinate r. A gripped patch is led straight outward and
// cannot follow the organ sideways: it has r_pull, at most r. So a vertex has two coordinates;
// which one counts is a matter of the sign of the depth, and both give U = 0 at rest. Between
// curves the field blends energies linearly (elastic_field.h); 17 curves keep that within 0.5 % of
// the force of a curve made for the place, 1.5 % where the stiffer of two is at its end already
// (compliance_family_test.cc).
//
// Close to the held side the organ is stiffer than its own surface can show: r is limited so that a
// place is at most kMaxStiffness_ratio (contact_law.h) times as stiff as a half-space. Set-up code
// only.
#pragma once

#include <span>
#include <vector>

#include "model/indent/compliance_law.h"
#include "model/result.h"
#include "model/tissue/compliance_map.h"
#include "model/tissue/elastic_field.h"

namespace tact::model::tissue {

struct ComplianceFamily {
  std::vector<indent::ComplianceCurve> curve;  // K, soft to stiff
  std::vector<float> press_coordinate;         // kappa of r, n vertices
  std::vector<float> pull_coordinate;          // kappa of r_pull, n vertices
  std::vector<float> ring_times_E_per_m;       // of curve k, as its shape has it, at [k N + j - 1]
  std::size_t limited_vertices = 0;            // vertices held to kMaxStiffness_ratio

  /// What the loop may touch.
  std::size_t memory_bytes() const {
    std::size_t bytes = (press_coordinate.size() + pull_coordinate.size()) * sizeof(float);
    for (const indent::ComplianceCurve& of_family : curve) bytes += of_family.memory_bytes();
    return bytes;
  }
};

struct ComplianceFamilyParameters {
  double youngs_modulus_Pa = 0.0;
  double tip_radius_m = 0.0;
  double working_depth_m = 0.0;
  std::size_t curves = 17;       // K
  std::size_t table_knots = 65;  // of each curve in press
};

/// S E of each vertex, where nothing of the tip is wider than the radius:
///
///     CF-4   S = s1 a1 a1' + s2 a2 a2',   S_held = S - n n' / (c_disc + r),   n = n1 a1 + n2 a2
///
/// so limited that no direction is more than kMaxStiffness_ratio times as stiff as on a half-space.
/// The normals are those of the surface that the map was made of.
std::vector<TangentTensors> tangent_compliance(const ComplianceMap& map,
                                               std::span<const Vec3> vertex_normal,
                                               double tip_radius_m);

Result<ComplianceFamily> make_compliance_family(const ComplianceMap& map,
                                                const ComplianceFamilyParameters& parameters);

}  // namespace tact::model::tissue
