// SPDX-License-Identifier: Apache-2.0
#include "tools/condense/condense_organ.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <thread>

#include "model/scene/compliance_file.h"
#include "tools/condense/gmsh.h"
#include "tools/mesh/held_box.h"
#include "tools/program/phase.h"
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

/// A lump at the surface would change what the tip itself feels, which no map says; one outside
/// would be found by nobody.
std::optional<Error> check_lumps(const CondenseInput& input) {
  const model::contact::SurfaceView surface = input.surface.view();
  std::size_t number = 0;
  for (const model::fem::Lump& lump : input.settings.organ.lumps) {
    ++number;
    std::size_t near = 0;
    for (std::size_t v = 0; v < surface.vertex_m.size(); ++v)
      if (norm(surface.vertex_m[v] - lump.center_m) < norm(surface.vertex_m[near] - lump.center_m))
        near = v;
    const model::Vec3 out_m = surface.vertex_m[near] - lump.center_m;
    const double depth_m = dot(out_m, surface.vertex_normal[near]);
    if (depth_m > lump.radius_m) continue;
    return Error{fmt::format(
        "elastic.inclusion {} of {} has its centre {:.3g} mm {} the surface at vertex {} and a "
        "radius of {:.3g} mm; move elastic.inclusion.center_m at least its radius below the "
        "surface",
        number, input.settings.organ.lumps.size(), 1e3 * norm(out_m),
        depth_m > 0.0 ? "below" : "outside", near, 1e3 * lump.radius_m)};
  }
  return std::nullopt;
}

/// OpenBLAS starts a thread a core in each process: as many processes would wait for each other.
/// Of another BLAS there is nothing to set.
void use_one_thread() {
  void* const set = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
  if (set != nullptr) reinterpret_cast<void (*)(int)>(set)(1);
}

// Processes, as MUMPS has state of its own; the factor is shared by them.
std::optional<Error> run_jobs(std::size_t jobs, std::span<float> results,
                              const model::fem::Work& work) {
  return program::run_in_processes(jobs, results, {.label = "solving"},
                                   [&work](std::size_t job, std::span<float> result) {
                                     use_one_thread();
                                     work(job, result);
                                   });
}

// Measured: 3000 vertices are 30 000 nodes; the growth is that of nested dissection.
double fill_s(double vertices) { return 3.0 * vertices / 3e3; }
double factor_s(double nodes) { return 8.0 * std::pow(nodes / 3e4, 1.7); }
double solve_s(double vertices, double nodes) {
  const double cores = std::max(1U, std::thread::hardware_concurrency());
  return 120.0 / cores * vertices / 3e3 * std::pow(nodes / 3e4, 1.3);
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
  input.inclusions = inclusions_hash(*scene.elastic);
  for (const auto& lump : scene.elastic->inclusions)
    input.settings.organ.lumps.push_back(
        {lump.center_m, lump.radius_m, lump.youngs_modulus_Pa / scene.elastic->youngs_modulus_Pa});
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
  if (auto error = check_lumps(input)) return *error;
  const double edge_m = median_edge_m(surface);
  CondenseSettings settings = input.settings;
  if (settings.mesh_size_m <= 0.0) {
    settings.mesh_size_m = kInside * edge_m;
    for (const model::fem::Lump& lump : settings.organ.lumps)
      settings.mesh_size_m = std::min(settings.mesh_size_m, lump.radius_m);
  }
  settings.organ.patch_radius_m = settings.patch_radius_m > 0.0
                                      ? settings.patch_radius_m
                                      : kElementsInPatch * std::max(settings.mesh_size_m, edge_m);
  const auto vertices = static_cast<double>(surface.vertex_m.size());
  std::optional<program::Phase> phase(std::in_place, "filling with elements", fill_s(vertices));
  const auto body = fill_with_gmsh(surface.vertex_m, surface.triangle, settings.mesh_size_m);
  if (!body) return body.error();
  facts = {.nodes = body->node_m.size(),
           .elements = body->element.size(),
           .mesh_size_m = settings.mesh_size_m};
  const auto nodes = static_cast<double>(facts.nodes);
  phase.reset();
  phase.emplace("factoring", factor_s(nodes));
  settings.organ.run_jobs = [&, run = input.settings.organ.run_jobs](std::size_t jobs,
                                                                     std::span<float> results,
                                                                     const model::fem::Work& work) {
    phase.reset();
    if (isatty(STDERR_FILENO) == 0) phase.emplace("solving", solve_s(vertices, nodes));
    return run(jobs, results, work);
  };
  auto map = model::fem::condense(*body, surface, settings.organ);
  if (map) map->inclusions = input.inclusions;
  return map;
}

}  // namespace tact::tools::condense
