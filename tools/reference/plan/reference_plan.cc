// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/reference_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

namespace tact::tools::reference {
namespace {

using model::Error;

// Chosen: steps in about the same ratio.
constexpr double kDefaultDepths_m[] = {1e-3, 2e-3, 3.5e-3, 5e-3, 7e-3, 10e-3};
// Linear: solved once and scaled to every depth.
constexpr double kUnitPull_m = -1e-3;
// Measured on the block of --self-check: 5 mm with edges of 0.43, 0.3, 0.2 and 0.12 of the radius
// is 10.3, 9.2, 7.2 and 4.6 % above the known answer.
constexpr double kShrinkOfLargePull = 0.8;
constexpr double kMaxDepth = 5.0;  // of the tool's radius

bool among(const std::vector<std::uint32_t>& list, std::uint32_t vertex) {
  return std::find(list.begin(), list.end(), vertex) != list.end();
}

/// One way to load a site, least depth first.
struct Series {
  std::vector<const ground_truth::ReferenceCase*> fine;
  std::vector<const ground_truth::ReferenceCase*> coarse;  // one level coarser, at the ends
};

struct SiteCases {
  Series press, pull, large_press, large_pull;
};

std::vector<double> large_strain_depths_m(const ReferencePlan& plan, bool pull) {
  if (!pull) return plan.depths_m;
  const double most_m = kLargePull * plan.tool_radius_m;
  return {plan.depths_m.begin(),
          std::upper_bound(plan.depths_m.begin(), plan.depths_m.end(), most_m)};
}

ground_truth::ReferenceCase scaled(const ground_truth::ReferenceCase& unit, double depth_m) {
  ground_truth::ReferenceCase out = unit;
  const double ratio = depth_m / unit.depth_m;
  out.depth_m = depth_m;
  out.force_N *= ratio;
  for (double& u_m : out.profile_m) u_m *= ratio;
  return out;
}

/// Each with the error of the nearest depth that is solved at both levels.
void add_with_errors(const Series& series, std::vector<ground_truth::ReferenceCase>& out) {
  for (const ground_truth::ReferenceCase* c : series.fine) {
    out.push_back(*c);
    out.back().force_error_ratio = std::numeric_limits<double>::quiet_NaN();
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const ground_truth::ReferenceCase* coarse : series.coarse) {
      const double away_m = std::abs(c->depth_m - coarse->depth_m);
      const auto fine = std::find_if(
          series.fine.begin(), series.fine.end(),
          [&](const ground_truth::ReferenceCase* f) { return f->depth_m == coarse->depth_m; });
      // The nearer end; at large strain one of them may have no solution.
      if (away_m >= nearest_m || fine == series.fine.end()) continue;
      nearest_m = away_m;
      // At the rim of a bond at large strain the error shrinks slower.
      const bool slow = coarse->large_strain && !coarse->is_press();
      out.back().force_error_ratio = remaining_error(
          (*fine)->force_N, coarse->force_N, slow ? kShrinkOfLargePull : kErrorShrink_ratio);
    }
  }
}

std::vector<ground_truth::ReferenceCase> cases_of_site(const SiteCases& s,
                                                       const ReferencePlan& plan) {
  std::vector<ground_truth::ReferenceCase> out;
  add_with_errors(s.press, out);
  std::vector<ground_truth::ReferenceCase> unit;
  add_with_errors(s.pull, unit);
  for (const double d_m : plan.depths_m) out.push_back(scaled(unit.front(), -d_m));
  add_with_errors(s.large_press, out);
  add_with_errors(s.large_pull, out);
  return out;
}

}  // namespace

model::Result<ReferencePlan> plan_of(const model::scene::Scene& scene) {
  if (!scene.elastic) {
    return Error{fmt::format(
        "{}: has no [elastic]; add it with youngs_modulus_Pa, poisson_ratio, fixed_min_m and "
        "fixed_max_m, or give them with --set",
        scene.path)};
  }
  ReferencePlan plan;
  plan.organ.surface = scene.organ_mesh;
  // Back to the mesh's own frame: solved cases are found again wherever a scene places the organ.
  model::mesh::shift(plan.organ.surface, -scene.organ.position_m);
  plan.organ.hash = mesh_hash(plan.organ.surface);
  plan.organ.held = {scene.elastic->fixed_min_m, scene.elastic->fixed_max_m};
  plan.organ.material = {scene.elastic->youngs_modulus_Pa, scene.elastic->poisson_ratio};
  plan.mesh_name = std::filesystem::path(scene.organ.mesh_path).filename().string();
  plan.tool_radius_m = scene.tool.spheres.front().radius_m;
  for (const auto& site : scene.reference_sites)
    plan.sites.push_back(static_cast<std::uint32_t>(site.vertex));
  plan.depths_m.assign(std::begin(kDefaultDepths_m), std::end(kDefaultDepths_m));
  return plan;
}

double remaining_error(double fine_N, double coarse_N, double shrink) {
  return shrink / (1.0 - shrink) * std::abs(fine_N - coarse_N) / std::abs(fine_N);
}

model::Result<std::string> solver_versions() {
  auto gmsh = ground_truth::gmsh_version();
  if (!gmsh) return gmsh;
  auto ccx = calculix_version();
  if (!ccx) return ccx;
  return fmt::format("CalculiX {}, gmsh {}", *ccx, *gmsh);
}

std::optional<Error> check(const ReferencePlan& plan) {
  if (plan.sites.empty())
    return Error{"no site to solve; add [[reference_site]] to the scene, or give --sites"};
  const auto summary = model::mesh::summarize(plan.organ.surface);
  if (summary.boundary_edges > 0) {
    return Error{fmt::format("{} has {} open edges, so it has no inside; close the surface",
                             plan.mesh_name, summary.boundary_edges)};
  }
  for (const std::uint32_t vertex : plan.sites) {
    if (std::count(plan.sites.begin(), plan.sites.end(), vertex) > 1)
      return Error{fmt::format("site {} is there twice; give it once", vertex)};
    if (vertex >= summary.vertices) {
      return Error{fmt::format("site {} is no vertex of {}; they are 0 to {}", vertex,
                               plan.mesh_name, summary.vertices - 1)};
    }
    if (plan.organ.held.holds(plan.organ.surface.vertex_m[vertex]))
      return Error{
          fmt::format("site {} lies in the held box, elastic.fixed_min_m to elastic.fixed_max_m; "
                      "choose another, "
                      "or move the box",
                      vertex)};
  }
  for (const std::uint32_t vertex : plan.large_strain_sites)
    if (!among(plan.sites, vertex))
      return Error{fmt::format("large strain at {}, which is no site; add it to --sites", vertex)};
  const double most_m = kMaxDepth * plan.tool_radius_m;
  bool good = !plan.depths_m.empty();
  double last_m = 0.0;
  for (const double d_m : plan.depths_m) {
    good &= d_m > last_m && d_m <= most_m;  // a NaN is neither
    last_m = d_m;
  }
  if (good) return std::nullopt;
  return Error{
      fmt::format("--depths must rise, all above 0 and at most {:.3g} m ({:g} tool radii); give "
                  "metres: 0.001,0.002",
                  most_m, kMaxDepth)};
}

std::vector<Indentation> cases_of(const ReferencePlan& plan) {
  std::vector<Indentation> out;
  for (const std::uint32_t vertex : plan.sites) {
    const auto add = [&](double depth_m, int level, bool large_strain) {
      out.push_back({.vertex = vertex,
                     .tool_radius_m = plan.tool_radius_m,
                     .depth_m = depth_m,
                     .large_strain = large_strain,
                     .level = level});
    };
    for (const double d_m : plan.depths_m) add(d_m, plan.level, false);
    add(kUnitPull_m, plan.level, false);
    // Both ends one level coarser: their change tells the error that is left.
    if (plan.level > kCoarsestLevel) {
      add(plan.depths_m.front(), plan.level - 1, false);
      if (plan.depths_m.size() > 1) add(plan.depths_m.back(), plan.level - 1, false);
      add(kUnitPull_m, plan.level - 1, false);
    }
    if (!among(plan.large_strain_sites, vertex)) continue;
    for (const double way : {1.0, -1.0}) {
      const std::vector<double> depths_m = large_strain_depths_m(plan, way < 0.0);
      for (const double d_m : depths_m) add(way * d_m, kCoarsestLevel, true);
      if (!depths_m.empty()) add(way * depths_m.front(), kRoughLevel, true);
      if (depths_m.size() > 1) add(way * depths_m.back(), kRoughLevel, true);
    }
  }
  return out;
}

ground_truth::SolvedBody solved_body(const Organ& organ, const std::string& mesh_name,
                                     const std::string& solver) {
  return {.mesh = mesh_name,
          .mesh_hash = organ.hash,
          .solver = solver,
          .youngs_modulus_Pa = organ.material.youngs_modulus_Pa,
          .poisson_ratio = organ.material.poisson_ratio,
          .fixed_min_m = organ.held.min_m,
          .fixed_max_m = organ.held.max_m};
}

ground_truth::ReferenceData assemble(
    const ReferencePlan& plan,
    const std::vector<std::optional<ground_truth::ReferenceCase>>& solved,
    const std::string& solver) {
  ground_truth::ReferenceData data{.body = solved_body(plan.organ, plan.mesh_name, solver),
                                   .tool_radius_m = plan.tool_radius_m,
                                   .ring_pitch_m = kRingPitch_m,
                                   .sites = {}};
  const std::vector<Indentation> cases = cases_of(plan);
  for (const std::uint32_t vertex : plan.sites) {
    SiteCases s;
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (cases[i].vertex != vertex || !solved[i]) continue;
      const bool press = solved[i]->is_press(), large = cases[i].large_strain;
      Series& series = large ? (press ? s.large_press : s.large_pull) : (press ? s.press : s.pull);
      const bool fine = cases[i].level == (large ? kCoarsestLevel : plan.level);
      (fine ? series.fine : series.coarse).push_back(&*solved[i]);
    }
    data.sites.push_back({.vertex = vertex,
                          .point_m = plan.organ.surface.vertex_m[vertex],
                          .direction = -plan.organ.surface.vertex_normal[vertex],
                          .cases = cases_of_site(s, plan)});
  }
  return data;
}

}  // namespace tact::tools::reference
