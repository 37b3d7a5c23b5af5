// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/press/tool_press.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "model/fem/linear_solver.h"
#include "tools/ground_truth/ring_means.h"
#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"
#include "tools/reference/press/active_set.h"
#include "tools/reference/press/half_space.h"

namespace tact::tools::reference {
namespace {

using ground_truth::ToolCase;
using model::Error;
using model::Result;
using model::Vec3;
using model::fem::NodeLoad;

// Edge of an element over its distance from the tip, and the longest inside the body.
struct ToolLevel {
  double slope;
  double largest_m;
};
constexpr std::array<ToolLevel, kFinestLevel - kRoughLevel + 1> kToolLevels{
    {{0.5, 16e-3}, {0.35, 14e-3}, {0.25, 12e-3}, {0.175, 10e-3}, {0.125, 8e-3}}};
constexpr double kWidestTouch = 0.99;  // of R: beyond, a sphere's side is too steep to touch
constexpr double kTallest = 4.0;       // of the largest R: what lies further above is no skin of it

/// A point of a triangle and its share of the area: exact to the fifth power.
struct GaussPoint {
  std::array<double, 3> corner;  // barycentric
  double weight;
};
// Radon's seven points of degree five (1948).
constexpr double kA = 0.470142064105115, kB = 0.101286507323456;
constexpr double kWa = 0.132394152788506, kWb = 0.125939180544827;
constexpr std::array<GaussPoint, 7> kGauss{{{{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}, 0.225},
                                            {{1.0 - 2.0 * kA, kA, kA}, kWa},
                                            {{kA, 1.0 - 2.0 * kA, kA}, kWa},
                                            {{kA, kA, 1.0 - 2.0 * kA}, kWa},
                                            {{1.0 - 2.0 * kB, kB, kB}, kWb},
                                            {{kB, 1.0 - 2.0 * kB, kB}, kWb},
                                            {{kB, kB, 1.0 - 2.0 * kB}, kWb}}};

/// Shape functions of a six-node face: corners, then the middles of edges 01, 12, 20.
std::array<double, 6> shape(const std::array<double, 3>& l) {
  return {l[0] * (2.0 * l[0] - 1.0), l[1] * (2.0 * l[1] - 1.0), l[2] * (2.0 * l[2] - 1.0),
          4.0 * l[0] * l[1],         4.0 * l[1] * l[2],         4.0 * l[2] * l[0]};
}

/// Corners that the tool may touch, and what unit pressure on the hat of each does.
struct Patch {
  std::vector<std::size_t> sphere;                     // that is over the corner
  std::vector<double> area_m2;                         // int h_v c dA
  std::vector<double> overlap_m3;                      // int h_v o c dA, at depth 0
  std::vector<std::map<std::uint32_t, Vec3>> push_m2;  // int h_v N_a m dA
};

double largest_radius_m(const ToolPress& what) {
  double out = 0.0;
  for (const RigidSphere& s : what.sphere) out = std::max(out, s.radius_m);
  return out;
}

/// Number in the patch of each corner that the tool reaches at its deepest.
std::unordered_map<std::uint32_t, std::size_t> touchable(const OrganBody& body,
                                                         const ToolPress& what, Patch& patch) {
  std::unordered_map<std::uint32_t, std::size_t> number;
  const double far_m = kTallest * largest_radius_m(what) + what.depths_m.back();
  for (std::size_t f = 0; f < body.face.size(); ++f) {
    if (dot(body.normal[f], what.direction) > -ground_truth::kFacing) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t node = body.face[f][k];
      const Reach reach = reach_beyond(what, body.mesh.node_m[node]);
      const double beyond_m = reach.beyond_m + what.depths_m.back();
      if (beyond_m <= 0.0 || beyond_m > far_m) continue;
      if (number.try_emplace(node, patch.sphere.size()).second)
        patch.sphere.push_back(reach.sphere);
    }
  }
  return number;
}

Patch make_patch(const OrganBody& body, const ToolPress& what) {
  Patch patch;
  const auto number = touchable(body, what, patch);
  const std::size_t n = patch.sphere.size();
  patch.area_m2.resize(n);
  patch.overlap_m3.resize(n);
  patch.push_m2.resize(n);
  for (std::size_t f = 0; f < body.face.size(); ++f) {
    const FaceNodes& node = body.face[f];
    if (dot(body.normal[f], what.direction) > -ground_truth::kFacing) continue;
    const Vec3 &a = body.mesh.node_m[node[0]], &b = body.mesh.node_m[node[1]],
               &c = body.mesh.node_m[node[2]];
    const double face_m2 = 0.5 * norm(cross(b - a, c - a));
    const Vec3 in = -body.normal[f];
    const double cosine = dot(in, what.direction);
    for (const GaussPoint& gauss : kGauss) {
      const auto& l = gauss.corner;
      const auto N = shape(l);  // NOLINT(readability-identifier-naming): the symbol of the equation
      const Vec3 at_m = l[0] * a + l[1] * b + l[2] * c;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = number.find(node[k]);
        if (v == number.end()) continue;
        // Beside a sphere its side goes on straight: no pressure stands there.
        double beyond_m = reach_beyond(what, at_m).beyond_m;
        if (!std::isfinite(beyond_m)) {
          const RigidSphere& s = what.sphere[patch.sphere[v->second]];
          beyond_m = dot(s.centre_m - at_m, what.direction);
        }
        const double hat_m2 = face_m2 * gauss.weight * l[k];
        patch.area_m2[v->second] += hat_m2 * cosine;
        patch.overlap_m3[v->second] += hat_m2 * cosine * beyond_m;
        for (std::size_t j = 0; j < N.size(); ++j)
          patch.push_m2[v->second][node[j]] += hat_m2 * N[j] * in;
      }
    }
  }
  return patch;
}

/// C, m^3/Pa. An error is that of Ctrl-C.
constexpr std::size_t kLoadsAtOnce = 64;

Result<Eigen::MatrixXd> compliance_of(const Patch& patch, model::fem::LinearSolver& solver) {
  std::vector<std::uint32_t> wanted;
  for (const auto& nodes : patch.push_m2)
    for (const auto& [node, push_m2] : nodes) wanted.push_back(node);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::unordered_map<std::uint32_t, std::size_t> place;
  for (std::size_t i = 0; i < wanted.size(); ++i) place[wanted[i]] = i;
  const std::size_t n = patch.sphere.size();
  Eigen::MatrixXd compliance(n, n);
  std::vector<std::vector<Vec3>> moved_m(kLoadsAtOnce);
  for (std::size_t first = 0; first < n; first += kLoadsAtOnce) {
    if (program::is_interrupted()) return program::interruption();
    std::vector<std::vector<NodeLoad>> loads(std::min(n - first, kLoadsAtOnce));
    for (std::size_t k = 0; k < loads.size(); ++k)
      for (const auto& [node, push_m2] : patch.push_m2[first + k])
        loads[k].push_back({node, push_m2});
    solver.solve(loads, wanted, moved_m);
    for (std::size_t k = 0; k < loads.size(); ++k)
      for (std::size_t v = 0; v < n; ++v) {
        double sum = 0.0;  // C_vw = int h_v u^w . m dA
        for (const auto& [node, push_m2] : patch.push_m2[v])
          sum += dot(moved_m[k][place[node]], push_m2);
        compliance(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(first + k)) = sum;
      }
  }
  // Symmetric by Betti; rounding is not, and active_set.cc factors it as symmetric.
  return Eigen::MatrixXd(0.5 * (compliance + compliance.transpose()));
}

/// The nodes that were these vertices of the surface: a finer skin keeps them.
Result<std::vector<std::uint32_t>> nodes_of(const std::vector<std::uint32_t>& vertices,
                                            const Organ& organ, const OrganBody& body) {
  constexpr double kSamePoint_m = 1e-7;
  std::vector<std::uint32_t> corners;
  for (const FaceNodes& f : body.face) corners.insert(corners.end(), f.begin(), f.begin() + 3);
  std::vector<std::uint32_t> out;
  for (const std::uint32_t v : vertices) {
    const auto is_there = [&](std::uint32_t node) {
      return norm(body.mesh.node_m[node] - organ.surface.vertex_m[v]) < kSamePoint_m;
    };
    const auto found = std::find_if(corners.begin(), corners.end(), is_there);
    if (found == corners.end())
      return Error{fmt::format("vertex {} of the organ is not among the nodes", v)};
    out.push_back(*found);
  }
  return out;
}

/// How far the nodes go along the way under the pressure of each corner, m.
std::vector<double> ways_m(const Patch& patch, const Eigen::VectorXd& pressure_Pa,
                           const Vec3& direction, const std::vector<std::uint32_t>& nodes,
                           model::fem::LinearSolver& solver) {
  std::vector<std::vector<NodeLoad>> load(1);
  for (std::size_t v = 0; v < patch.sphere.size(); ++v)
    for (const auto& [node, push_m2] : patch.push_m2[v])
      load[0].push_back({node, pressure_Pa[static_cast<Eigen::Index>(v)] * push_m2});
  std::vector<std::vector<Vec3>> moved_m(1);
  solver.solve(load, nodes, moved_m);
  std::vector<double> out;
  for (const Vec3& m : moved_m[0]) out.push_back(dot(m, direction));
  return out;
}

}  // namespace

Reach reach_beyond(const ToolPress& what, const Vec3& point_m) {
  Reach out{.beyond_m = -std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < what.sphere.size(); ++i) {
    const RigidSphere& s = what.sphere[i];
    const Vec3 from = point_m - s.centre_m;
    const double along_m = dot(from, what.direction);
    const double rho_m = norm(from - along_m * what.direction);
    if (rho_m > kWidestTouch * s.radius_m) continue;
    // o = c + sqrt(R^2 - rho^2) - s
    const double beyond_m = std::sqrt(s.radius_m * s.radius_m - rho_m * rho_m) - along_m;
    if (beyond_m > out.beyond_m) out = {.beyond_m = beyond_m, .sphere = i};
  }
  return out;
}

ground_truth::EdgeLengths edge_lengths(const Organ& organ, const ToolPress& what) {
  const ToolLevel& level =
      kToolLevels[static_cast<std::size_t>(std::clamp(what.level, kRoughLevel, kFinestLevel))];
  double least_m = std::numeric_limits<double>::infinity();  // of the contact radii
  std::vector<Vec3> tip_m;
  for (const RigidSphere& s : what.sphere) {
    least_m = std::min(least_m, sphere_contact_radius_m(s.radius_m, what.depths_m.front()));
    tip_m.push_back(s.centre_m + s.radius_m * what.direction);
  }
  return {.at_m = tip_m.front(),
          .axis = {},
          .radius_m = least_m,
          .fine_m = level.slope * least_m,
          .growth = level.slope,
          .largest_m = level.largest_m * organ.size_ratio,
          .more_at_m = {tip_m.begin() + 1, tip_m.end()}};
}

Result<std::vector<ToolCase>> solve(const Organ& organ, const ToolPress& what) {
  const auto body = make_organ_body(organ.surface, edge_lengths(organ, what), organ.held);
  if (!body) return body.error();
  const auto skin = nodes_of(what.skin, organ, *body);
  if (!skin) return skin.error();
  const Patch patch = make_patch(*body, what);
  if (patch.sphere.empty()) return Error{"the tool touches nothing at its deepest"};
  auto solver = model::fem::make_linear_solver(body->mesh, organ.material, body->held_node);
  if (!solver) return solver.error();
  const auto compliance = compliance_of(patch, *solver);
  if (!compliance) return compliance.error();
  const auto n = static_cast<Eigen::Index>(patch.sphere.size());
  const Eigen::Map<const Eigen::VectorXd> area(patch.area_m2.data(), n),
      overlap(patch.overlap_m3.data(), n);
  std::vector<ToolCase> cases;
  for (const double depth_m : what.depths_m) {
    const auto pressure = solve_contact(*compliance, overlap + depth_m * area);
    if (!pressure) return pressure.error();
    ToolCase one{.depth_m = depth_m, .force_N = pressure->dot(area), .sphere_N = {}};
    one.sphere_N.resize(what.sphere.size());
    for (Eigen::Index v = 0; v < n; ++v)
      one.sphere_N[patch.sphere[static_cast<std::size_t>(v)]] += (*pressure)[v] * area[v];
    if (!skin->empty()) one.skin_m = ways_m(patch, *pressure, what.direction, *skin, *solver);
    cases.push_back(std::move(one));
  }
  return cases;
}

}  // namespace tact::tools::reference
