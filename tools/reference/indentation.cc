#include "tools/reference/indentation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/reference/half_space.h"

namespace tact::tools {
namespace {

using model::Result;
using model::Vec3;

constexpr double kFineRadius = 1.1;    // of the tool's radius: up to here the mesh is finest
constexpr double kFacing = 0.1;        // cosine: a face looks the tool's way
constexpr double kSphereShare = 0.99;  // of R: beyond, a sphere's side is too steep to touch

struct Levels {
  double fine;       // edge under the tool, of its radius
  double bond;       // edge at the rim of a bonded disc, of its radius
  double growth;     // of the edge with distance
  double largest_m;  // edge inside the body
};
constexpr std::array<Levels, kFinestLevel> kLevels{{{0.25, 0.08, 0.5, 12e-3},
                                                    {0.175, 0.05, 0.42, 10e-3},
                                                    {0.125, 0.032, 0.35, 8e-3},
                                                    {0.088, 0.02, 0.3, 6e-3}}};

/// How far a point lies beyond the site along the tool's way.
double along_m(const Circle& tool, const Vec3& p_m) { return dot(p_m - tool.at_m, tool.axis); }

std::function<bool(std::size_t)> faces_within(const OrganBody& body, const Circle& tool,
                                              double radius_m) {
  return [&body, tool, radius_m](std::size_t f) {
    const Vec3 c = centre_m(body, f);
    return tool.away_m(c) <= radius_m && std::abs(along_m(tool, c)) < 2.0 * radius_m &&
           dot(body.normal[f], tool.axis) < -kFacing;
  };
}

std::vector<MovedNode> press(const OrganBody& body, const Circle& tool, const Indentation& what,
                             double contact_radius_m) {
  const double R = what.tool_radius_m;  // NOLINT
  std::vector<MovedNode> moved;
  for (const std::uint32_t n : nodes_of_faces(body, faces_within(body, tool, contact_radius_m))) {
    const Vec3& p = body.mesh.node_m[n];
    const double rho = tool.away_m(p);
    if (rho > kSphereShare * R) continue;
    // u_n = d - (R - sqrt(R^2 - rho^2)) - s
    const double u_m = what.depth_m - (R - std::sqrt(R * R - rho * rho)) - along_m(tool, p);
    if (u_m > 0.0) moved.push_back({n, u_m});
  }
  return moved;
}

std::vector<MovedNode> pull(const OrganBody& body, const Circle& tool, const Indentation& what) {
  std::vector<MovedNode> moved;
  for (const std::uint32_t n : nodes_of_faces(body, faces_within(body, tool, what.tool_radius_m)))
    moved.push_back({n, what.depth_m});
  return moved;
}

/// Adds the part of ring r that lies in one flat triangle: length and length times mean u.
void add_crossing(const std::array<double, 3>& rho, const std::array<Vec3, 3>& p,
                  const std::array<double, 3>& u, double r, double& length, double& sum) {
  Vec3 cut[2];
  double value[2] = {0.0, 0.0};
  int cuts = 0;
  for (std::size_t k = 0; k < 3 && cuts < 2; ++k) {
    const std::size_t m = (k + 1) % 3;
    if ((rho[k] < r) == (rho[m] < r)) continue;
    const double t = (r - rho[k]) / (rho[m] - rho[k]);
    cut[cuts] = p[k] + t * (p[m] - p[k]);
    value[cuts++] = u[k] + t * (u[m] - u[k]);
  }
  if (cuts < 2) return;
  const double part = norm(cut[1] - cut[0]);
  length += part;
  sum += part * 0.5 * (value[0] + value[1]);
}

}  // namespace

EdgeLengths edge_lengths(const Organ& organ, const Indentation& what) {
  const Levels& level =
      kLevels[static_cast<std::size_t>(std::clamp(what.level, kCoarsestLevel, kFinestLevel) - 1)];
  const bool bonded = what.depth_m < 0.0;  // stress is singular at the rim of a bond
  return {.at_m = organ.surface.vertex_m[what.vertex],
          .axis = bonded ? -organ.surface.vertex_normal[what.vertex] : Vec3{},
          .radius_m = (bonded ? 1.0 : kFineRadius) * what.tool_radius_m,
          .fine_m = (bonded ? level.bond : level.fine) * what.tool_radius_m,
          .growth = level.growth,
          .largest_m = level.largest_m};
}

std::vector<double> ring_means(const OrganBody& body, const Vec3& at_m, const Vec3& outward,
                               const std::vector<double>& u, int rings, double pitch_m) {
  // A six-node face as four flat ones.
  constexpr std::array<std::array<std::size_t, 3>, 4> kParts{
      {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
  std::vector<double> length(static_cast<std::size_t>(rings), 0.0), sum = length;
  double nearest_m = INFINITY;
  for (std::size_t f = 0; f < body.face.size(); ++f) {
    if (dot(body.normal[f], outward) < kFacing) continue;
    for (const auto& part : kParts) {
      std::array<double, 3> rho{}, value{};
      std::array<Vec3, 3> p{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t n = body.face[f][part[k]];
        p[k] = body.mesh.node_m[n];
        rho[k] = norm(p[k] - at_m);
        value[k] = u[n];
        if (rho[k] < nearest_m) {  // ring 0 is the site itself
          nearest_m = rho[k];
          length[0] = 1.0;
          sum[0] = value[k];
        }
      }
      const auto [low, high] = std::minmax_element(rho.begin(), rho.end());
      const auto first = std::max<std::size_t>(1, static_cast<std::size_t>(*low / pitch_m));
      for (std::size_t k = first; k < sum.size() && static_cast<double>(k) * pitch_m <= *high; ++k)
        add_crossing(rho, p, value, static_cast<double>(k) * pitch_m, length[k], sum[k]);
    }
  }
  std::vector<double> mean(sum.size(), 0.0);
  for (std::size_t k = 0; k < sum.size(); ++k)
    mean[k] = length[k] > 0.0 ? sum[k] / length[k] : (k > 0 ? mean[k - 1] : 0.0);
  return mean;
}

Result<ReferenceCase> solve(const Organ& organ, const Indentation& what) {
  const Circle tool{organ.surface.vertex_m[what.vertex], -organ.surface.vertex_normal[what.vertex],
                    what.tool_radius_m};
  std::optional<Circle> bond;  // its edge carries much of the force, so the mesh follows it
  if (what.depth_m < 0.0) bond = tool;
  const auto body = make_organ_body(organ.surface, edge_lengths(organ, what), organ.held, bond);
  if (!body) return body.error();
  ReferenceCase out{.depth_m = what.depth_m, .large_strain = what.large_strain, .profile_m = {}};
  ElasticProblem problem{.body = &body->mesh,
                         .material = organ.material,
                         .held = body->held_node,
                         .load = {.direction = tool.axis, .moved = {}},
                         .reported = nodes_of_faces(*body, [](std::size_t) { return true; })};
  problem.load.large_strain = what.large_strain;
  if (out.is_press()) {
    out.contact_radius_m = what.contact_radius_m > 0.0
                               ? what.contact_radius_m
                               : sphere_contact_radius_m(what.tool_radius_m, what.depth_m);
    problem.load.moved = press(*body, tool, what, out.contact_radius_m);
  } else {
    out.contact_radius_m = what.tool_radius_m;
    problem.load.moved = pull(*body, tool, what);
    problem.load.sideways_held = true;
  }
  const auto answer = solve_with_calculix(problem);
  if (!answer) return answer.error();
  out.force_N = dot(answer->force_N, tool.axis);
  std::vector<double> inward_m(body->mesh.node_m.size(), 0.0);
  for (std::size_t i = 0; i < problem.reported.size(); ++i)
    inward_m[problem.reported[i]] = dot(answer->displacement_m[i], tool.axis);
  out.profile_m = ring_means(*body, tool.at_m, -tool.axis, inward_m, kRings, kRingPitch_m);
  return out;
}

}  // namespace tact::tools
