// SPDX-License-Identifier: Apache-2.0
#include "tools/new_scene/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "tools/mesh/place.h"
#include "tools/new_scene/forceps.h"
#include "tools/new_scene/scene.in.h"

namespace tact::tools::new_scene {
namespace {

using model::Vec3;

constexpr double kMaxDepth_m = 0.012;  // as the liver's
constexpr double kDepth_ratio = 0.2;   // of the height: small strain beyond the tip
constexpr double kPress_ratio = 0.8;   // of the working depth
constexpr double kLiver_Pa = 6270.0;   // E / (1 - nu^2), of the numbers below

/// Quoted alike in JSON and TOML; what is no UTF-8 is shown as a replacement character.
std::string quoted(const std::string& text) { return model::io::text_of(nlohmann::json(text)); }

std::string four_digits(double x) { return fmt::format("{:.4g}", x); }

}  // namespace

ScenePlacement place_of(const model::mesh::SurfaceMesh& organ) {
  ScenePlacement place;
  const auto& p_m = organ.vertex_m;
  for (std::size_t v = 0; v < p_m.size(); ++v)
    if (p_m[v].z > p_m[place.top].z) place.top = v;
  const auto sum = summarize(organ);
  const double height_m = sum.high_m.z - sum.low_m.z;
  place.position_m = -p_m[place.top];
  place.held = mesh::far_tenth(organ, {0.0, 0.0, -1.0});
  place.working_depth_m = std::clamp(kDepth_ratio * height_m, 1e-3, kMaxDepth_m);
  return place;
}

std::string tool_mesh() { return kForceps; }

std::string scene_text(const SceneValues& values, const ScenePlacement& place) {
  const double nu = values.poisson_ratio;
  const double of_liver = values.youngs_modulus_Pa / (1.0 - nu * nu) / kLiver_Pa;
  const double depth_ratio = place.working_depth_m / kMaxDepth_m;  // a thin organ pulls no further
  const double press_m = mesh::rounded_m(kPress_ratio * place.working_depth_m);
  using fmt::arg;
  return fmt::format(
      fmt::runtime(kScene), arg("organ", quoted(values.source)), arg("name", quoted(values.name)),
      arg("law", quoted(values.law)), arg("map", quoted(values.map)),
      arg("tool", quoted(values.tool)), arg("mesh", quoted(values.mesh)),
      arg("mesh_unit_m", values.mesh_unit_m), arg("vertex_colors", values.has_colors),
      arg("position_m", mesh::toml_of(place.position_m)), arg("vertex", place.top),
      arg("fixed_min_m", mesh::toml_of(place.held.min_m)),
      arg("fixed_max_m", mesh::toml_of(place.held.max_m)),
      arg("youngs_modulus_Pa", values.youngs_modulus_Pa), arg("poisson_ratio", nu),
      arg("working_depth_m", mesh::rounded_m(place.working_depth_m)), arg("press_m", press_m),
      arg("grip_m", mesh::rounded_m(press_m / 2.0)),
      arg("rhombus_normal_N_per_m", four_digits(1.604 * of_liver)),
      arg("rhombus_tangential_N_per_m", four_digits(0.8257 * of_liver)),
      arg("pull_N_per_m", four_digits(50.3 * of_liver)),
      arg("tear_force_N", four_digits(std::clamp(0.4 * depth_ratio * of_liver, 0.01, 20.0))));
}

}  // namespace tact::tools::new_scene
