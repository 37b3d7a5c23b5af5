// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/reference_data.h"

#include "tools/ground_truth/reference_json.h"

namespace tact::tools::ground_truth {
namespace {

using model::Error;
using model::Result;
using nlohmann::json;

constexpr const char* kSchema = "tact-reference/1";

ReferenceCase case_of(const json& j) {
  return {.depth_m = j.at("depth_m").get<double>(),
          .large_strain = j.at("large_strain").get<bool>(),
          .force_N = j.at("force_N").get<double>(),
          .contact_radius_m = j.at("contact_radius_m").get<double>(),
          .force_error_ratio = error_of(j.at("force_error_ratio")),
          .profile_m = j.at("profile_m").get<std::vector<double>>()};
}

SolvedSite site_of(const json& j) {
  SolvedSite site{.vertex = j.at("vertex").get<std::uint32_t>(),
                  .point_m = vector_of(j.at("point_m")),
                  .direction = vector_of(j.at("direction")),
                  .cases = {}};
  for (const json& c : j.at("cases")) site.cases.push_back(case_of(c));
  return site;
}

ReferenceData data_of(const json& j) {
  ReferenceData data{.body = body_of(j),
                     .tool_radius_m = j.at("tool_radius_m").get<double>(),
                     .ring_pitch_m = j.at("ring_pitch_m").get<double>(),
                     .sites = {}};
  for (const json& s : j.at("sites")) data.sites.push_back(site_of(s));
  return data;
}

/// What a reader may rely on. Error: what is not so.
std::optional<Error> check(const ReferenceData& data) {
  if (data.sites.empty()) return Error{"no site"};
  if (!(data.tool_radius_m > 0.0) || !(data.ring_pitch_m > 0.0) ||
      !(data.body.youngs_modulus_Pa > 0.0))
    return Error{"tool_radius_m, ring_pitch_m and youngs_modulus_Pa must be above 0"};
  for (const SolvedSite& site : data.sites) {
    if (std::abs(norm(site.direction) - 1.0) > 1e-4)
      return Error{fmt::format("site {}: direction is no unit vector", site.vertex)};
    for (const ReferenceCase& c : site.cases) {
      if (c.depth_m == 0.0 || c.force_N * c.depth_m < 0.0)
        return Error{
            fmt::format("site {}: depth_m is 0 or force_N has the other sign", site.vertex)};
      if (c.profile_m.empty()) return Error{fmt::format("site {}: empty profile_m", site.vertex)};
    }
  }
  return std::nullopt;
}

}  // namespace

Result<ReferenceData> read_reference(const std::string& path) {
  return read_json(path, kSchema, "tact-lab reference SCENE --out FILE", data_of, check);
}

}  // namespace tact::tools::ground_truth
