#include "tools/common/reference_data.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

namespace tact::tools {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using nlohmann::json;

constexpr const char* kSchema = "tact-reference/1";

Vec3 vector_of(const json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

double error_of(const json& j) {
  return j.is_null() ? std::numeric_limits<double>::quiet_NaN() : j.get<double>();
}

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
  ReferenceData data{.mesh = j.at("mesh").get<std::string>(),
                     .mesh_hash = j.at("mesh_hash").get<std::string>(),
                     .solver = j.at("solver").get<std::string>(),
                     .youngs_modulus_Pa = j.at("youngs_modulus_Pa").get<double>(),
                     .poisson_ratio = j.at("poisson_ratio").get<double>(),
                     .fixed_min_m = vector_of(j.at("fixed_min_m")),
                     .fixed_max_m = vector_of(j.at("fixed_max_m")),
                     .tool_radius_m = j.at("tool_radius_m").get<double>(),
                     .ring_pitch_m = j.at("ring_pitch_m").get<double>(),
                     .sites = {}};
  for (const json& s : j.at("sites")) data.sites.push_back(site_of(s));
  return data;
}

/// What a reader may rely on; empty if all is well.
std::string complaint(const ReferenceData& data) {
  if (data.sites.empty()) return "no site";
  if (!(data.tool_radius_m > 0.0) || !(data.ring_pitch_m > 0.0) || !(data.youngs_modulus_Pa > 0.0))
    return "tool_radius_m, ring_pitch_m and youngs_modulus_Pa must be above 0";
  for (const SolvedSite& site : data.sites) {
    if (std::abs(norm(site.direction) - 1.0) > 1e-4)
      return fmt::format("site {}: direction is no unit vector", site.vertex);
    for (const ReferenceCase& c : site.cases) {
      if (c.depth_m == 0.0 || c.force_N * c.depth_m < 0.0)
        return fmt::format("site {}: depth_m is 0 or force_N has the other sign", site.vertex);
      if (c.profile_m.empty()) return fmt::format("site {}: empty profile_m", site.vertex);
    }
  }
  return {};
}

std::string text_of(const Vec3& v) {
  return fmt::format("[{:.7g}, {:.7g}, {:.7g}]", v.x, v.y, v.z);
}

std::string text_of(const ReferenceCase& c) {
  std::string profile;
  for (const double u_m : c.profile_m)
    profile += fmt::format("{}{:.4g}", profile.empty() ? "" : ", ", u_m);
  return fmt::format(
      "{{\"depth_m\": {:.6g}, \"large_strain\": {}, \"force_N\": {:.6g}, "
      "\"contact_radius_m\": {:.6g}, \"force_error_ratio\": {},\n   \"profile_m\": [{}]}}",
      c.depth_m, c.large_strain, c.force_N, c.contact_radius_m,
      std::isfinite(c.force_error_ratio) ? fmt::format("{:.3g}", c.force_error_ratio) : "null",
      profile);
}

std::string text_of(const SolvedSite& site) {
  std::string cases;
  for (const ReferenceCase& c : site.cases)
    cases += (cases.empty() ? "\n  " : ",\n  ") + text_of(c);
  return fmt::format("{{\"vertex\": {}, \"point_m\": {}, \"direction\": {}, \"cases\": [{}]}}",
                     site.vertex, text_of(site.point_m), text_of(site.direction), cases);
}

}  // namespace

Result<ReferenceData> read_reference(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return Error{fmt::format(
        "{}: cannot be read; check the name, or make it: tact-reference SCENE --out FILE", path)};
  }
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  try {  // the library reports by exceptions; they end here
    const json j = json::parse(text);
    if (j.value("schema", "") != kSchema) {
      return Error{fmt::format(
          "{}: \"schema\" is not \"{}\"; make it again: tact-reference SCENE --out FILE", path,
          kSchema)};
    }
    ReferenceData data = data_of(j);
    if (const std::string bad = complaint(data); !bad.empty())
      return Error{
          fmt::format("{}: {}; make it again: tact-reference SCENE --out FILE", path, bad)};
    return data;
  } catch (const json::exception& e) {
    return Error{
        fmt::format("{}: {}; make it again: tact-reference SCENE --out FILE", path, e.what())};
  }
}

std::string reference_text(const ReferenceData& data) {
  std::string sites;
  for (const SolvedSite& s : data.sites) sites += (sites.empty() ? "\n " : ",\n ") + text_of(s);
  return fmt::format(
      "{{\"schema\": \"{}\",\n\"mesh\": {}, \"mesh_hash\": {}, \"solver\": {},\n"
      "\"youngs_modulus_Pa\": {:.7g}, \"poisson_ratio\": {:.7g},\n"
      "\"fixed_min_m\": {}, \"fixed_max_m\": {},\n"
      "\"tool_radius_m\": {:.7g}, \"ring_pitch_m\": {:.7g},\n\"sites\": [{}]}}\n",
      kSchema, json(data.mesh).dump(), json(data.mesh_hash).dump(), json(data.solver).dump(),
      data.youngs_modulus_Pa, data.poisson_ratio, text_of(data.fixed_min_m),
      text_of(data.fixed_max_m), data.tool_radius_m, data.ring_pitch_m, sites);
}

}  // namespace tact::tools
