// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/tool_reference.h"

#include <fmt/format.h>

#include "tools/ground_truth/reference_json.h"

namespace tact::tools::ground_truth {
namespace {

using model::Error;
using model::Quat;
using model::Result;
using model::Vec3;
using nlohmann::json;

constexpr const char* kToolSchema = "tact-tool-reference/1";

ToolCase tool_case_of(const json& j) {
  return {.depth_m = j.at("depth_m").get<double>(),
          .force_N = j.at("force_N").get<double>(),
          .sphere_N = j.at("sphere_N").get<std::vector<double>>(),
          .force_error_ratio = error_of(j.at("force_error_ratio")),
          .skin_m = j.value("skin_m", std::vector<double>{})};
}

ToolPoint place_of(const json& j) {
  const json &v = j.at("vertex"), &q = j.at("orientation_wxyz");
  ToolPoint place{.vertex = {},
                  .slid_m = j.contains("slid_m") ? vector_of(j.at("slid_m")) : Vec3{},
                  .tilt_deg = j.value("tilt_deg", 0.0),
                  .point_m = vector_of(j.at("point_m")),
                  .direction = vector_of(j.at("direction")),
                  .orientation = {q.at(0).get<double>(), q.at(1).get<double>(),
                                  q.at(2).get<double>(), q.at(3).get<double>()},
                  .skin = j.value("skin", std::vector<std::uint32_t>{}),
                  .cases = {}};
  if (!v.is_null()) place.vertex = v.get<std::uint32_t>();
  for (const json& c : j.at("cases")) place.cases.push_back(tool_case_of(c));
  return place;
}

ToolReference tool_data_of(const json& j) {
  ToolReference data{.body = body_of(j), .sphere = {}, .places = {}};
  for (const json& s : j.at("spheres"))
    data.sphere.push_back(
        {.offset_m = vector_of(s.at("offset_m")), .radius_m = s.at("radius_m").get<double>()});
  for (const json& p : j.at("places")) data.places.push_back(place_of(p));
  return data;
}

/// What a reader may rely on. Error: what is not so.
std::optional<Error> check_tool(const ToolReference& data) {
  if (data.places.empty() || data.sphere.empty()) return Error{"no place, or no sphere"};
  if (data.sphere.size() > model::contact::kMaxSpheres)
    return Error{fmt::format("more than {} spheres", model::contact::kMaxSpheres)};
  const auto& depths = data.places.front().cases;
  if (depths.empty()) return Error{"no case"};
  for (const ToolPoint& place : data.places) {
    const Quat& q = place.orientation;
    const double turn = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    if (std::abs(norm(place.direction) - 1.0) > 1e-4 || std::abs(turn - 1.0) > 1e-4)
      return Error{"a direction or an orientation is no unit vector"};
    if (place.cases.size() != depths.size()) return Error{"places differ in their depths"};
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const ToolCase& c = place.cases[i];
      if (c.depth_m != depths[i].depth_m) return Error{"places differ in their depths"};
      if (!(c.depth_m > 0.0) || !(c.force_N > 0.0) || (i > 0 && c.depth_m <= depths[i - 1].depth_m))
        return Error{"depth_m and force_N must be above 0, depths rising"};
      if (c.sphere_N.size() != data.sphere.size()) return Error{"sphere_N: one for each sphere"};
      if (c.skin_m.size() != place.skin.size()) return Error{"skin_m: one for each of skin"};
    }
  }
  return std::nullopt;
}

}  // namespace

std::string name_of(const ToolPoint& place) {
  if (place.vertex) return std::to_string(*place.vertex);
  if (place.tilt_deg != 0.0) return fmt::format("tilted {:g}", place.tilt_deg);
  if (place.slid_m == Vec3{}) return "hand's";
  return fmt::format("slid {:.3g} mm", norm(place.slid_m) * 1e3);
}

Result<ToolReference> read_tool_reference(const std::string& path) {
  return read_json(path, kToolSchema, "tact-lab reference SCENE --tool --out FILE", tool_data_of,
                   check_tool);
}

}  // namespace tact::tools::ground_truth
