// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/solve_cache.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/reader/scene_text.h"
#include "tools/reference/press/contact_radius.h"

namespace tact::tools::reference {
namespace {

namespace fs = std::filesystem;
using model::Vec3;
using nlohmann::json;

// Raise them whenever the same key would give another answer.
constexpr int kMethod = 2;
constexpr int kBallMethod = 1;  // calculix_deck.cc, rigid_ball.cc, ball_press.cc
constexpr int kToolMethod = 1;  // tool_press.cc, active_set.cc

constexpr double kProbeContact = 0.75;  // of R at depth R: a little less than a half-space has
// Chosen: sixteen steps over a radius.
constexpr int kFallRings = 17;

std::string text_of(const Vec3& v) { return fmt::format("{:.9g} {:.9g} {:.9g}", v.x, v.y, v.z); }

std::string hash_of(const std::string& text) {
  model::reader::TextHash hash;
  hash.add(text);
  return hash.hex();
}

}  // namespace

std::string SolveCache::path_of(const std::string& key) const {
  return (fs::path(directory_) / (hash_of(key) + ".json")).string();
}

std::optional<json> SolveCache::read(const std::string& key) const {
  auto j = model::io::read_json(path_of(key));
  // The whole key, as two may share a hash.
  if (!j || !j->is_object() || j->value("key", json{}) != key) return std::nullopt;
  return std::move(*j);
}

std::optional<model::Error> SolveCache::write(const std::string& key, json solved) const {
  std::error_code ignored;  // write_file says it better
  fs::create_directories(directory_, ignored);
  solved["key"] = key;
  const auto error = model::io::write_file(path_of(key), model::io::text_of(solved, 1) + "\n");
  // Another program may have kept the same case at this moment: then it is there.
  if (!error || read(key)) return std::nullopt;
  return model::Error{error->message + ", or name another --cache"};
}

std::optional<ground_truth::ReferenceCase> SolveCache::find(const std::string& key) const {
  const auto j = read(key);
  if (!j) return std::nullopt;
  try {  // the library reports by exceptions; they end here
    return ground_truth::ReferenceCase{.depth_m = j->at("depth_m").get<double>(),
                                       .large_strain = j->at("large_strain").get<bool>(),
                                       .force_N = j->at("force_N").get<double>(),
                                       .contact_radius_m = j->at("contact_radius_m").get<double>(),
                                       .profile_m = j->at("profile_m").get<std::vector<double>>()};
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::optional<std::vector<ground_truth::ToolCase>> SolveCache::find_tool(
    const std::string& key) const {
  const auto j = read(key);
  if (!j) return std::nullopt;
  try {  // the library reports by exceptions; they end here
    std::vector<ground_truth::ToolCase> out;
    for (const json& c : j->at("cases"))
      out.push_back({.depth_m = c.at("depth_m").get<double>(),
                     .force_N = c.at("force_N").get<double>(),
                     .sphere_N = c.at("sphere_N").get<std::vector<double>>(),
                     .skin_m = c.value("skin_m", std::vector<double>{})});
    return out;
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::optional<model::Error> SolveCache::keep(const std::string& key,
                                             const ground_truth::ReferenceCase& solved) const {
  return write(key, {{"depth_m", solved.depth_m},
                     {"large_strain", solved.large_strain},
                     {"force_N", solved.force_N},
                     {"contact_radius_m", solved.contact_radius_m},
                     {"profile_m", solved.profile_m}});
}

std::optional<model::Error> SolveCache::keep_tool(
    const std::string& key, const std::vector<ground_truth::ToolCase>& solved) const {
  json cases = json::array();
  for (const ground_truth::ToolCase& c : solved)
    cases.push_back({{"depth_m", c.depth_m},
                     {"force_N", c.force_N},
                     {"sphere_N", c.sphere_N},
                     {"skin_m", c.skin_m}});
  return write(key, {{"cases", std::move(cases)}});
}

std::string default_cache_directory() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && *cache != '\0') return std::string(cache) + "/tact/reference";
  return std::string(home != nullptr ? home : "/tmp") + "/.cache/tact/reference";
}

std::string mesh_hash(const model::mesh::SurfaceMesh& mesh) {
  model::reader::TextHash hash;
  for (const Vec3& p : mesh.vertex_m) {
    hash.add(fmt::format("{} {} {}", std::llround(p.x * 1e9), std::llround(p.y * 1e9),
                         std::llround(p.z * 1e9)));
  }
  for (const auto& t : mesh.triangle) hash.add(fmt::format("{} {} {}", t[0], t[1], t[2]));
  return hash.hex();
}

namespace {

std::string organ_text(const Organ& organ, const std::string& solver) {
  return fmt::format("{}; mesh {}; E {:.9g} Pa, nu {:.9g}; held {} to {} m", solver, organ.hash,
                     organ.material.youngs_modulus_Pa, organ.material.poisson_ratio,
                     text_of(organ.held.min_m), text_of(organ.held.max_m));
}

std::string edges_text(const ground_truth::EdgeLengths& edges) {
  return fmt::format("edges {:.9g} m, growth {:.9g}, to {:.9g} m", edges.fine_m, edges.growth,
                     edges.largest_m);
}

}  // namespace

std::string cache_key(const Organ& organ, const Indentation& what, const std::string& solver) {
  std::string contact =
      what.contact_radius_m > 0.0 ? fmt::format("{:.4g} m", what.contact_radius_m) : "half-space";
  if (what.is_sideways())
    contact += fmt::format(", along {}{}", text_of(what.along), what.held ? ", held" : "");
  if (what.large_strain && what.depth_m > 0.0) contact += fmt::format(", ball {}", kBallMethod);
  return fmt::format(
      "method {}, {}; vertex {}, radius {:.9g} m, depth {:.9g} m, {}; contact {}; {}", kMethod,
      organ_text(organ, solver), what.vertex, what.tool_radius_m, what.depth_m,
      what.large_strain ? "large strain" : "linear", contact,
      edges_text(edge_lengths(organ, what)));
}

std::string cache_key(const Organ& organ, const ToolPress& what, const std::string& solver) {
  std::string spheres, depths, skin = what.skin.empty() ? "" : "; skin";
  for (const RigidSphere& s : what.sphere)
    spheres += fmt::format("; sphere {:.9g} m at {}", s.radius_m, text_of(s.centre_m));
  for (const double d_m : what.depths_m) depths += fmt::format(" {:.9g}", d_m);
  for (const std::uint32_t v : what.skin) skin += fmt::format(" {}", v);
  return fmt::format("tool {}, {}; along {}{}; depths{} m{}; {}", kToolMethod,
                     organ_text(organ, solver), text_of(what.direction), spheres, depths, skin,
                     edges_text(edge_lengths(organ, what)));
}

namespace {

/// As asked, from the cache or solved and kept.
model::Result<ground_truth::ReferenceCase> solve_or_find(const Organ& organ,
                                                         const Indentation& what,
                                                         const std::string& solver,
                                                         const SolveCache& cache) {
  const std::string key = cache_key(organ, what, solver);
  if (auto found = cache.find(key)) return std::move(*found);
  auto solved = solve(organ, what);
  if (!solved) return solved;
  if (auto error = cache.keep(key, *solved)) return std::move(*error);
  return solved;
}

}  // namespace

Indentation probe_of(std::uint32_t vertex, double tool_radius_m) {
  return {.vertex = vertex,
          .tool_radius_m = tool_radius_m,
          .depth_m = tool_radius_m,
          .level = kCoarsestLevel,
          .contact_radius_m = kProbeContact * tool_radius_m};
}

model::Result<ground_truth::ReferenceCase> solve_once(const Organ& organ, const Indentation& what,
                                                      const std::string& solver,
                                                      const SolveCache& cache) {
  // A bond's radius is the tool's; one that is given needs no probe.
  if (what.depth_m < 0.0 || what.contact_radius_m > 0.0)
    return solve_or_find(organ, what, solver, cache);
  const Indentation probe = probe_of(what.vertex, what.tool_radius_m);
  auto first = solve_or_find(organ, probe, solver, cache);
  if (!first) return first;
  const double pitch_m = what.tool_radius_m / (kFallRings - 1);
  auto fall_m = surface_fall_m(organ.surface, what.vertex, kFallRings, pitch_m);
  if (!fall_m) return fall_m.error();
  const TipContact tip(organ.material, what.tool_radius_m, std::move(*fall_m), pitch_m);
  Indentation pressed = what;
  pressed.contact_radius_m =
      tip.radius_m(what.depth_m, tip.compliance_m_per_N(probe.depth_m, first->force_N));
  return solve_or_find(organ, pressed, solver, cache);
}

model::Result<std::vector<ground_truth::ToolCase>> solve_once(const Organ& organ,
                                                              const ToolPress& what,
                                                              const std::string& solver,
                                                              const SolveCache& cache) {
  const std::string key = cache_key(organ, what, solver);
  if (auto found = cache.find_tool(key)) return std::move(*found);
  auto solved = solve(organ, what);
  if (!solved) return solved;
  if (auto error = cache.keep_tool(key, *solved)) return std::move(*error);
  return solved;
}

}  // namespace tact::tools::reference
