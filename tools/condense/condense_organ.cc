// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/condense_organ.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <string>

#include "tools/condense/gmsh.h"
#include "tools/mesh/held_box.h"
#include "tools/program/sweep.h"

namespace tact::tools::condense {
namespace {

using model::Error;
using model::Result;

constexpr double kRingPitch_m = 0.002;
constexpr std::size_t kRings = 20;
constexpr double kInside = 1.5;           // element edge over the surface's median edge
constexpr double kElementsInPatch = 1.6;  // patch radius over element edge: r within 2 % of C_half

std::string text_of(const model::Vec3& v) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}]", v.x, v.y, v.z);
}

/// Before gmsh and finite elements, which would find it minutes later and know no key.
std::optional<Error> check_held(const CondenseInput& input) {
  const auto& organ = input.settings.organ;
  const std::size_t held =
      mesh::held_triangles(input.surface, {organ.fixed_min_m, organ.fixed_max_m});
  const std::size_t all = input.surface.triangle.size();
  if (held > 0 && held < all) return std::nullopt;
  const auto sum = summarize(input.surface);
  return Error{fmt::format(
      "the held box, elastic.fixed_min_m = {} to elastic.fixed_max_m = {}, holds {} triangle of "
      "the "
      "organ, which lies in {} to {} there; make it hold a part (tact-mesh --align proposes one)",
      text_of(organ.fixed_min_m), text_of(organ.fixed_max_m), held == 0 ? "no" : "every",
      text_of(sum.low_m), text_of(sum.high_m))};
}

// Processes, as MUMPS has state of its own; the factor is shared by them.
std::optional<Error> run_jobs(std::size_t jobs, std::span<float> results,
                              const model::fem::Work& work) {
  return program::run_in_processes(jobs, results, {.label = "condensing"}, work);
}

}  // namespace

double median_edge_m(const model::contact::SurfaceView& surface) {
  std::vector<double> edge_m;
  for (const auto& t : surface.triangle)
    for (std::size_t i = 0; i < 3; ++i)
      edge_m.push_back(norm(surface.vertex_m[t[i]] - surface.vertex_m[t[(i + 1) % 3]]));
  if (edge_m.empty()) return 0.0;
  const auto middle = edge_m.begin() + static_cast<std::ptrdiff_t>(edge_m.size() / 2);
  std::nth_element(edge_m.begin(), middle, edge_m.end());
  return *middle;
}

Result<CondenseInput> condense_input(const model::scene::Scene& scene) {
  if (!scene.elastic)
    return Error{fmt::format(
        "{}: has no [elastic]; add it with youngs_modulus_Pa, poisson_ratio, fixed_min_m and "
        "fixed_max_m, or give them with --set",
        scene.path)};
  CondenseInput input{.surface = scene.organ_mesh};
  model::mesh::shift(input.surface, -scene.organ.position_m);
  input.settings.organ = {.poisson_ratio = scene.elastic->poisson_ratio,
                          .fixed_min_m = scene.elastic->fixed_min_m,
                          .fixed_max_m = scene.elastic->fixed_max_m,
                          .ring_pitch_m = kRingPitch_m,
                          .rings = kRings,
                          .run_jobs = run_jobs};
  return input;
}

Result<model::tissue::ComplianceMap> condense_organ(const CondenseInput& input,
                                                    CondenseFacts& facts) {
  const model::contact::SurfaceView surface = input.surface.view();
  const std::size_t open = summarize(input.surface).boundary_edges;
  if (open > 0)
    return Error{
        fmt::format("the organ's surface has {} open edges, so it has no inside; close it", open)};
  if (auto error = check_held(input)) return *error;
  const double edge_m = median_edge_m(surface);
  CondenseSettings settings = input.settings;
  if (settings.mesh_size_m <= 0.0) settings.mesh_size_m = kInside * edge_m;
  settings.organ.patch_radius_m = settings.patch_radius_m > 0.0
                                      ? settings.patch_radius_m
                                      : kElementsInPatch * std::max(settings.mesh_size_m, edge_m);
  const auto body = fill_with_gmsh(surface.vertex_m, surface.triangle, settings.mesh_size_m);
  if (!body) return body.error();
  facts = {.nodes = body->node_m.size(),
           .elements = body->element.size(),
           .mesh_size_m = settings.mesh_size_m};
  return model::fem::condense(*body, surface, settings.organ);
}

}  // namespace tact::tools::condense
