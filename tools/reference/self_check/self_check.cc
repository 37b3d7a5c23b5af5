// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/self_check/self_check.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "model/io/json.h"
#include "model/mesh/obj.h"
#include "tools/reference/press/half_space.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using nlohmann::json;

// As the independent answers have it; forces scale with E.
constexpr Elasticity kTissue{.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45};
constexpr double kRadius_m = 5e-3;
constexpr int kLevel = 2;

struct Known {
  std::string name;
  double depth_m = 0.0;
  double force_N = 0.0;
  double bar_ratio = 0.0;  // of the force
};

bool check(const Known& known, double force_N) {
  const double off = force_N / known.force_N - 1.0;
  const bool good = std::abs(off) <= known.bar_ratio;
  fmt::print("{:<5} {:<34} {:>9.3f} mN, known {:>9.3f} mN, {:+.2f} % (bar {:g} %)\n",
             good ? "good" : "BAD", known.name, force_N * 1e3, known.force_N * 1e3, off * 100.0,
             known.bar_ratio * 100.0);
  std::fflush(stdout);
  return good;
}

Result<bool> check_block(double size_m, const std::vector<Known>& cases,
                         bool large_strain = false) {
  const auto block = make_block(size_m, size_m, kTissue);
  if (!block) return block.error();
  bool good = true;
  for (const Known& known : cases) {
    const auto solved = solve(*block, {.vertex = 0,
                                       .tool_radius_m = kRadius_m,
                                       .depth_m = known.depth_m,
                                       .large_strain = large_strain,
                                       .level = large_strain ? kCoarsestLevel : kLevel});
    if (!solved && !found_no_solution(solved.error())) return solved.error();
    if (!solved) fmt::print("{}: {}\n", known.name, solved.error().message);
    good &= solved && check(known, solved->force_N);
  }
  return good;
}

/// Numbers of the triangles that touch `rings` rings of vertices around one.
std::set<std::uint32_t> triangles_around(const model::mesh::SurfaceMesh& s, std::uint32_t vertex,
                                         int rings) {
  std::set<std::uint32_t> vertices{vertex}, triangles;
  for (int i = 0; i < rings; ++i) {
    for (const std::uint32_t v : vertices)
      triangles.insert(s.fan.begin() + s.fan_start[v], s.fan.begin() + s.fan_start[v + 1]);
    for (const std::uint32_t t : triangles)
      vertices.insert(s.triangle[t].begin(), s.triangle[t].end());
  }
  return triangles;
}

bool is_in(const model::mesh::SurfaceMesh& s, std::uint32_t triangle, const Vec3& p) {
  const auto& t = s.triangle[triangle];
  const Vec3& n = s.face_normal[triangle];
  // A nanometre: a finer triangle lies in its parent's plane up to rounding.
  if (std::abs(dot(p - s.vertex_m[t[0]], n)) > 1e-9) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = s.vertex_m[t[k]], &b = s.vertex_m[t[(k + 1) % 3]];
    if (dot(cross(b - a, p - a), n) < 0.0) return false;
  }
  return true;
}

/// One patch of the mesh's own triangles, moved as one piece.
Result<bool> check_patch(const model::mesh::SurfaceMesh& surface, const mesh::HeldBox& held,
                         const json& c) {
  const auto vertex = c.at("vertex").get<std::uint32_t>();
  const int rings = c.at("rings").get<int>();
  const ground_truth::EdgeLengths edges{.at_m = surface.vertex_m.at(vertex),
                                        .axis = {},
                                        .radius_m = 4.5e-3 * rings,
                                        .fine_m = 0.6e-3 * rings,
                                        .growth = 0.4,
                                        .largest_m = 9e-3};
  const auto body = make_organ_body(surface, edges, held);
  if (!body) return body.error();
  const auto triangles = triangles_around(surface, vertex, rings);
  const auto in_patch = [&](std::size_t f) {
    const Vec3 p = centre_m(*body, f);
    for (const std::uint32_t t : triangles)
      if (is_in(surface, t, p)) return true;
    return false;
  };
  const Vec3 direction{c.at("direction").at(0), c.at("direction").at(1), c.at("direction").at(2)};
  const double depth_m = c.at("depth_m").get<double>();
  ElasticProblem problem{.body = &body->mesh,
                         .material = kTissue,
                         .held = body->held_node,
                         .load = {.direction = direction, .moved = {}, .sideways_held = true},
                         .reported = {}};
  for (const std::uint32_t n : nodes_of_faces(*body, in_patch))
    problem.load.moved.push_back({n, depth_m});
  problem.reported = {problem.load.moved.front().node};
  const auto answer = solve_with_calculix(problem);
  if (!answer) return answer.error();
  const Known known{.name = "organ patch " + c.at("name").get<std::string>(),
                    .depth_m = depth_m,
                    .force_N = c.at("force_N").get<double>(),
                    // The independent answer's own error bar.
                    .bar_ratio = 0.03};
  return check(known, dot(answer->force_N, direction));
}

Result<bool> check_organ(const std::string& folder) {
  const std::string path = folder + "/organ_patch.json";
  const auto parsed = model::io::read_json(path, "give the folder tests/data/reference");
  if (!parsed) return parsed.error();
  try {  // the library reports by exceptions; they end here
    const json& j = *parsed;
    const auto organ = model::mesh::load_obj(folder + "/" + j.at("mesh").get<std::string>(),
                                             j.at("mesh_unit_m").get<double>());
    if (!organ) return organ.error();
    const mesh::HeldBox held{{-1.0, -1.0, -1.0}, {1.0, j.at("fixed_max_y_m").get<double>(), 1.0}};
    bool good = true;
    for (const json& c : j.at("cases")) {
      auto one = check_patch(organ->mesh, held, c);
      if (!one) return one;
      good &= *one;
    }
    return good;
  } catch (const json::exception& e) {
    return Error{fmt::format("{}: {}; restore the file", path, e.what())};
  }
}

}  // namespace

Result<bool> self_check(const std::string& folder) {
  auto organ = check_organ(folder);
  if (!organ) return organ;
  // Block 50 x 50 mm, E = 1 kPa, nu = 0.45: FEniCS, contact by penalty; the bond: CalculiX.
  auto block = check_block(0.05, {{"block, sphere R 5 mm at 1 mm", 1e-3, 3.801e-3, 0.02},
                                  {"block, sphere R 5 mm at 2 mm", 2e-3, 10.68e-3, 0.02},
                                  {"block, sphere R 5 mm at 5 mm", 5e-3, 40.46e-3, 0.02},
                                  {"block, sphere R 5 mm at 10 mm", 10e-3, 103.5e-3, 0.02},
                                  {"block, bonded disc pulled 1 mm", -1e-3, -13.722e-3, 0.03}});
  if (!block) return block;
  // The same block, neo-Hookean, all by FEniCS. Bars: the coarsest mesh has 3 % under a sphere, and
  // at the rim of a bond 6 %.
  auto large = check_block(0.05,
                           {{"large strain, sphere at 1 mm", 1e-3, 3.776e-3, 0.03},
                            {"large strain, sphere at 2 mm", 2e-3, 10.57e-3, 0.03},
                            {"large strain, sphere at 5 mm", 5e-3, 39.16e-3, 0.03},
                            {"large strain, sphere at 10 mm", 10e-3, 89.1e-3, 0.03},
                            {"large strain, disc pulled 1 mm", -1e-3, -13.76e-3, 0.06},
                            {"large strain, disc pulled 5 mm", -5e-3, -63.4e-3, 0.06}},
                           true);
  if (!large) return large;
  const auto sphere_N = [](double depth_m) { return sphere_force_N(kTissue, kRadius_m, depth_m); };
  // A bond is 0.3 % stiffer than a frictionless punch at this nu.
  const double punch_N = -1.003 * flat_punch_force_N(kTissue, kRadius_m, 1e-3);
  auto space = check_block(1.0, {{"half-space, sphere at 1 mm", 1e-3, sphere_N(1e-3), 0.02},
                                 {"half-space, sphere at 5 mm", 5e-3, sphere_N(5e-3), 0.02},
                                 {"half-space, bonded disc", -1e-3, punch_N, 0.03}});
  if (!space) return space;
  return *organ && *block && *large && *space;
}

}  // namespace tact::tools::reference
