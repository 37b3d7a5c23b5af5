// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/indentation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/ground_truth/ring_means.h"
#include "tools/reference/press/ball_press.h"
#include "tools/reference/press/half_space.h"

namespace tact::tools::reference {
namespace {

using model::Result;
using model::Vec3;

constexpr double kFineRadius = 1.1;    // of the contact radius: up to here the mesh is finest
constexpr double kSphereShare = 0.99;  // of R: beyond, a sphere's side is too steep to touch

struct Levels {
  double fine;       // edge under the tool, of the contact radius
  double bond;       // edge at the rim of a bonded disc, of its radius
  double growth;     // of the edge with distance
  double largest_m;  // edge inside the body
};
// Edges shrink by about 0.7 from level to level (kErrorShrink_ratio).
constexpr std::array<Levels, kFinestLevel - kRoughLevel + 1> kLevels{{{0.5, 0.17, 0.72, 16e-3},
                                                                      {0.35, 0.12, 0.6, 14e-3},
                                                                      {0.25, 0.08, 0.5, 12e-3},
                                                                      {0.175, 0.05, 0.42, 10e-3},
                                                                      {0.125, 0.032, 0.35, 8e-3}}};
// A pull of more of their edges than this draws the elements at a bond's rim out so far that
// CalculiX stalls.
constexpr double kMaxDrawnOut = 8.0;

/// How far a point lies beyond the site along the tool's way.
double along_m(const Circle& tool, const Vec3& p_m) { return dot(p_m - tool.at_m, tool.axis); }

std::vector<MovedNode> press(const OrganBody& body, const Circle& tool, const Indentation& what) {
  const double R =
      what.tool_radius_m;  // NOLINT(readability-identifier-naming): the symbol of the equation
  std::vector<MovedNode> moved;
  for (const std::uint32_t n : nodes_of_faces(body, faces_within(body, tool))) {
    const Vec3& p = body.mesh.node_m[n];
    const double rho = tool.away_m(p);
    if (rho > kSphereShare * R) continue;
    // u_n = d - (R - sqrt(R^2 - rho^2)) - s
    const double u_m = what.depth_m - (R - std::sqrt(R * R - rho * rho)) - along_m(tool, p);
    // Only pushed: a node that the sphere does not reach is free.
    if (u_m > 0.0) moved.push_back({n, u_m});
  }
  return moved;
}

std::vector<MovedNode> pull(const OrganBody& body, const Circle& tool, const Indentation& what) {
  std::vector<MovedNode> moved;
  for (const std::uint32_t n : nodes_of_faces(body, faces_within(body, tool)))
    moved.push_back({n, what.depth_m});
  return moved;
}

ElasticLoad load_of(const OrganBody& body, const Circle& rim, const Indentation& what) {
  ElasticLoad load{.direction = rim.axis, .moved = {}, .large_strain = what.large_strain};
  if (what.is_sideways()) {
    load.direction = what.along;
    load.moved = pull(body, rim, what);
    load.sideways_held = what.held;
  } else if (what.depth_m < 0.0) {
    load.moved = pull(body, rim, what);
    load.sideways_held = true;
  } else if (what.large_strain) {
    load.ball = ball_on(body, {rim.at_m, rim.axis, what.tool_radius_m}, what.depth_m);
  } else {
    load.moved = press(body, rim, what);
  }
  return load;
}

double contact_radius_of(const Indentation& what) {
  if (what.depth_m < 0.0) return what.tool_radius_m;
  return what.contact_radius_m > 0.0 ? what.contact_radius_m
                                     : sphere_contact_radius_m(what.tool_radius_m, what.depth_m);
}

}  // namespace

ground_truth::EdgeLengths edge_lengths(const Organ& organ, const Indentation& what) {
  const Levels& level =
      kLevels[static_cast<std::size_t>(std::clamp(what.level, kRoughLevel, kFinestLevel))];
  const bool bonded = what.is_bonded();  // stress is singular at the rim of a bond
  const double a_m = contact_radius_of(what);
  double fine_m = (bonded ? level.bond : level.fine) * a_m;
  // Finer edges would be drawn out so far that CalculiX stalls; the ratio between levels stays.
  if (bonded && what.large_strain) {
    const double coarser = level.bond / kLevels[kCoarsestLevel].bond;
    fine_m = std::max(fine_m, -what.depth_m / kMaxDrawnOut * coarser);
  }
  return {.at_m = organ.surface.vertex_m[what.vertex],
          .axis = bonded ? -organ.surface.vertex_normal[what.vertex] : Vec3{},
          .radius_m = (bonded ? 1.0 : kFineRadius) * a_m,
          .fine_m = fine_m,
          .growth = level.growth,
          .largest_m = level.largest_m * organ.size_ratio};
}

std::vector<double> ring_means(const OrganBody& body, const Vec3& at_m, const Vec3& outward,
                               const std::vector<double>& u, double middle_u) {
  // A six-node face as four flat ones.
  constexpr std::array<std::array<std::size_t, 3>, 4> kParts{
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  ground_truth::RingMeans means(kRings, kRingPitch_m, middle_u);
  for (std::size_t f = 0; f < body.face.size(); ++f) {
    if (dot(body.normal[f], outward) < ground_truth::kFacing) continue;
    for (const auto& part : kParts) {
      std::array<double, 3> rho{}, value{};
      std::array<Vec3, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = body.face[f][part[k]];
        p[k] = body.mesh.node_m[n];
        rho[k] = norm(p[k] - at_m);
        value[k] = u[n];
      }
      means.add_triangle(p, rho, value);
    }
  }
  return means.means();
}

Result<ground_truth::ReferenceCase> solve(const Organ& organ, const Indentation& what) {
  // The mesh follows the rim of the contact: there the stress ends, or is singular.
  const Circle rim{organ.surface.vertex_m[what.vertex], -organ.surface.vertex_normal[what.vertex],
                   contact_radius_of(what)};
  const auto body = make_organ_body(organ.surface, edge_lengths(organ, what), organ.held, rim);
  if (!body) return body.error();
  ElasticProblem problem{.body = &body->mesh,
                         .material = organ.material,
                         .held = body->held_node,
                         .load = load_of(*body, rim, what),
                         .reported = nodes_of_faces(*body, [](std::size_t) { return true; })};
  const auto answer = solve_with_calculix(problem);
  if (!answer) return answer.error();
  std::vector<Vec3> displacement_m(body->mesh.node_m.size());
  std::vector<double> inward_m(body->mesh.node_m.size(), 0.0);
  for (std::size_t i = 0; i < problem.reported.size(); ++i) {
    displacement_m[problem.reported[i]] = answer->displacement_m[i];
    inward_m[problem.reported[i]] = dot(answer->displacement_m[i], rim.axis);
  }
  const auto& ball = problem.load.ball;
  return ground_truth::ReferenceCase{
      .depth_m = what.depth_m,
      .large_strain = what.large_strain,
      .force_N = dot(answer->force_N, problem.load.direction),
      .contact_radius_m =
          ball ? touched_radius_m(*body, *ball, rim.axis, displacement_m) : rim.radius_m,
      .profile_m = ring_means(*body, rim.at_m, -rim.axis, inward_m, inward_m[what.vertex])};
}

}  // namespace tact::tools::reference
