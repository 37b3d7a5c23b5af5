// SPDX-License-Identifier: Apache-2.0
#include "tools/fit/fit_data.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/ground_truth/reference_fits.h"

namespace tact::tools::fit {

using model::Error;
using model::Result;

double FitData::peak_N() const {
  double peak = 0.0;
  for (const FitSite& site : sites)
    for (const FitSample& s : site.samples) peak = std::max(peak, std::abs(s.force_N));
  return peak;
}

double FitData::deepest_m() const {
  double deepest = 0.0;
  for (const FitSite& site : sites)
    for (const FitSample& s : site.samples) deepest = std::max(deepest, s.depth_m);
  return deepest;
}

double FitData::farthest_pull_m() const {
  double farthest = 0.0;
  for (const FitSite& site : sites)
    // A pull is a depth below zero.
    for (const FitSample& s : site.samples) farthest = std::max(farthest, -s.depth_m);
  return farthest;
}

bool FitData::has_shapes() const {
  return std::any_of(sites.begin(), sites.end(), [](const FitSite& site) {
    return std::any_of(site.samples.begin(), site.samples.end(),
                       [](const FitSample& s) { return !s.ring_m.empty(); });
  });
}

bool FitData::has_places() const {
  return std::all_of(sites.begin(), sites.end(),
                     [](const FitSite& site) { return site.at.has_value(); });
}

std::optional<FitPoint> surface_point_at_vertex(const model::mesh::SurfaceMesh& surface,
                                                std::size_t vertex) {
  if (vertex >= surface.vertex_m.size()) return std::nullopt;
  // A vertex of no triangle is no place of a surface.
  if (surface.fan_start[vertex] == surface.fan_start[vertex + 1]) return std::nullopt;
  FitPoint out{.normal = surface.vertex_normal[vertex]};
  out.surface_point.triangle = surface.fan[surface.fan_start[vertex]];
  const model::contact::TriangleCorners& corner = surface.triangle[out.surface_point.triangle];
  for (std::size_t i = 0; i < 3; ++i) out.surface_point.weight[i] = corner[i] == vertex ? 1.0 : 0.0;
  return out;
}

std::optional<Error> hold_out(FitData& data, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto at = std::find_if(data.sites.begin(), data.sites.end(),
                                 [&name](const FitSite& site) { return site.name == name; });
    if (at == data.sites.end())
      return Error{
          fmt::format("{}: no site \"{}\" to hold out; check its name", data.source, name)};
    at->held_out = true;
  }
  if (std::all_of(data.sites.begin(), data.sites.end(),
                  [](const FitSite& site) { return site.held_out; }))
    return Error{fmt::format("{}: every site is held out; leave one to fit", data.source)};
  return std::nullopt;
}

Result<FitData> fit_data_of(const ground_truth::ReferenceData& reference,
                            const model::scene::Scene& scene,
                            const std::vector<std::string>& held_out, bool large_strain) {
  if (auto differs = check_reference_fits(reference, scene, ground_truth::ModulusOf::kAny))
    return std::move(*differs);
  FitData data{.source = fmt::format("{}, E = {:g} Pa, nu = {:g}, tool radius {:g} m",
                                     reference.body.mesh, reference.body.youngs_modulus_Pa,
                                     reference.body.poisson_ratio, reference.tool_radius_m),
               .large_strain = large_strain};
  std::size_t rings = 0;
  for (const ground_truth::SolvedSite& solved : reference.sites) {
    FitSite site{.name = std::to_string(solved.vertex),
                 .at = surface_point_at_vertex(scene.organ_mesh, solved.vertex)};
    // The reference pressed along its own direction: the law is asked along the same one.
    site.at->normal = -solved.direction;
    for (const model::scene::ReferenceSite& known : scene.reference_sites)
      if (known.vertex == solved.vertex) site.held_out = known.held_out;
    for (const ground_truth::ReferenceCase& c : solved.cases) {
      // One kind or the other: a law cannot follow both with one set of numbers.
      if (c.large_strain != large_strain) continue;
      site.samples.push_back({.depth_m = c.depth_m, .force_N = c.force_N, .ring_m = c.profile_m});
      rings = std::max(rings, c.profile_m.size());
    }
    if (!site.samples.empty()) data.sites.push_back(std::move(site));
  }
  if (data.sites.empty())
    return Error{fmt::format(
        "the reference has no case {} large strain; solve it again: tact-lab reference {}"
        "{} --out FILE",
        large_strain ? "with" : "without", scene.path,
        large_strain ? " --large-strain SITES" : "")};
  if (auto error = hold_out(data, held_out)) return std::move(*error);
  for (FitSite& site : data.sites)
    // Cases may know fewer rings: the others are unknown, not zero.
    for (FitSample& s : site.samples) s.ring_m.resize(rings, std::nan(""));
  for (std::size_t k = 0; k < rings; ++k)
    data.ring_radius_m.push_back(static_cast<double>(k) * reference.ring_pitch_m);
  return data;
}

}  // namespace tact::tools::fit
