// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/sideways_plan.h"

#include <array>
#include <cmath>

#include "tools/ground_truth/reference_json.h"

namespace tact::tools::reference {
namespace {

using model::Vec3;

constexpr const char* kSchema = "tact-sideways-reference/1";
constexpr double kDragged_m = 1e-3;  // linear: any

struct DraggedPatch {
  double radius_ratio;  // of the tool's
  bool held;
};
constexpr std::array<DraggedPatch, 3> kPatches{{{1.0, true}, {0.5, false}, {1.0, false}}};

/// Two directions across the normal.
std::array<Vec3, 2> tangents(const Vec3& normal) {
  const Vec3 aside = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 first = normalized(cross(normal, aside));
  return {first, cross(normal, first)};
}

}  // namespace

std::vector<Indentation> sideways_cases(const ReferencePlan& plan) {
  std::vector<Indentation> out;
  // All of one level, then the coarser one: assemble_sideways finds the pair n apart.
  for (const int level : {plan.level, plan.level - 1})
    for (const std::uint32_t vertex : plan.sites)
      for (const DraggedPatch& patch : kPatches)
        for (const Vec3& along : tangents(plan.organ.surface.vertex_normal[vertex]))
          out.push_back({.vertex = vertex,
                         .tool_radius_m = plan.tool_radius_m,
                         .depth_m = kDragged_m,
                         .level = level,
                         .contact_radius_m = patch.radius_ratio * plan.tool_radius_m,
                         .along = along,
                         .held = patch.held});
  return out;
}

SidewaysReference assemble_sideways(
    const ReferencePlan& plan,
    const std::vector<std::optional<ground_truth::ReferenceCase>>& solved,
    const std::string& solver) {
  SidewaysReference out{.body = solved_body(plan.organ, plan.mesh_name, solver), .cases = {}};
  const std::vector<Indentation> asked = sideways_cases(plan);
  const std::size_t n = asked.size() / 2;
  for (std::size_t i = 0; i < n; ++i) {
    const double fine_N = solved[i]->force_N, coarse_N = solved[n + i]->force_N;
    out.cases.push_back({.vertex = asked[i].vertex,
                         .along = asked[i].along,
                         .held = asked[i].held,
                         .contact_radius_m = asked[i].contact_radius_m,
                         .stiffness_N_per_m = fine_N / kDragged_m,
                         .error_ratio = remaining_error(fine_N, coarse_N)});
  }
  return out;
}

std::string sideways_text(const SidewaysReference& data) {
  std::string cases;
  for (const SidewaysCase& c : data.cases)
    cases += fmt::format(
        "{}{{\"vertex\": {}, \"along\": {}, \"held\": {}, \"contact_radius_m\": {:.6g}, "
        "\"stiffness_N_per_m\": {:.6g}, \"error_ratio\": {}}}",
        cases.empty() ? "\n " : ",\n ", c.vertex, ground_truth::vector_text(c.along), c.held,
        c.contact_radius_m, c.stiffness_N_per_m, ground_truth::error_text(c.error_ratio));
  return fmt::format("{{\"schema\": \"{}\",\n{},\n\"cases\": [{}]}}\n", kSchema,
                     ground_truth::body_text(data.body), cases);
}

}  // namespace tact::tools::reference
