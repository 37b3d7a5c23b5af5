// SPDX-License-Identifier: Apache-2.0
// tact-lab reference: what an elastic organ does under the scene's tool, by finite elements. Its
// options and its scene; tools/reference/reference.py does the work.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>

#include "model/io/program/within.h"
#include "model/reader/scene_text.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"

namespace tact::tools::lab {
namespace {

using model::Error;
using model::Result;
using model::Vec3;
using nlohmann::json;

/// $XDG_CACHE_HOME/tact/reference, else ~/.cache/tact/reference.
std::string default_cache_directory() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && *cache != '\0') return std::string(cache) + "/tact/reference";
  return std::string(home != nullptr ? home : "/tmp") + "/.cache/tact/reference";
}

struct Options {
  program::SceneArguments scene;
  std::string out, cache = default_cache_directory(), self_check, finite_strain;
  std::vector<std::uint32_t> sites, large_strain_sites;
  std::vector<double> depths_m, tilts_deg;
  int level = 2;
  unsigned jobs = 1;
  bool tool = false, away_from_edges = false, skin = false, sideways = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene.path, "scene file (TOML) with [elastic] and [[reference_site]]");
  app.add_option("--out", o.out, "file to write; without it, a table of forces only");
  app.add_option("--set", o.scene.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_flag(
      "--tool", o.tool,
      "press all spheres of the tool together, at the hand's own site, along its slides and "
      "at six places that no law is fitted on");
  app.add_flag("--away-from-edges", o.away_from_edges,
               "with --tool: none of the six where a face within three radii is turned by 30 "
               "degrees or more")
      ->needs("--tool");
  app.add_option("--finite-strain", o.finite_strain,
                 "with --tool: neo-Hookean, at finite strain, solved by FEniCSx or by CalculiX")
      ->check(CLI::IsMember({"FEniCSx", "CalculiX"}))
      ->needs("--tool");
  app.add_option("--tilts", o.tilts_deg, "with --tool: at the hand's site also tilted by degrees")
      ->delimiter(',')
      ->needs("--tool");
  app.add_flag("--skin", o.skin, "with --tool: also how far the surface around it goes")
      ->needs("--tool");
  app.add_flag("--sideways", o.sideways, "drag a round patch along the surface of each site")
      ->excludes("--tool");
  app.add_option("--sites", o.sites,
                 "vertices of the organ's mesh, instead of the scene's or of the six")
      ->delimiter(',');
  app.add_option("--depths", o.depths_m, "m, above 0, rising, at most 5 tool radii; press and pull")
      ->check(model::io::above_zero())
      ->delimiter(',');
  app.add_option("--large-strain", o.large_strain_sites,
                 "sites also pressed, and pulled up to 1.3 tool radii, with large strain; "
                 "about 25 min each, always on the coarse mesh")
      ->delimiter(',')
      ->excludes("--tool");
  app.add_option("--level", o.level, "mesh, 1 coarse to 4 fine; each about twice the time")
      ->check(model::io::within(1, 4))
      ->capture_default_str();
  app.add_option("--cache", o.cache, "folder of solved cases")->capture_default_str();
  app.add_option("--jobs", o.jobs, "solves at a time; each takes a core and about 1 GB")
      ->check(model::io::within(1, 256))
      ->capture_default_str();
  app.add_flag("--json", o.json, "print the result as JSON");
  app.add_option("--self-check", o.self_check,
                 "instead of a scene: compare with the known answers in this folder "
                 "(tests/data/reference)");
}

/// Of vertices (to the nanometre) and triangles, 16 hex digits.
std::string hash_of(const model::mesh::SurfaceMesh& mesh, const Vec3& less) {
  model::reader::TextHash hash;
  const auto nm = [](double length_m) { return std::llround(length_m * 1e9); };
  for (const Vec3& v : mesh.vertex_m) {
    const Vec3 p = v - less;
    hash.add(fmt::format("{} {} {}", nm(p.x), nm(p.y), nm(p.z)));
  }
  for (const auto& t : mesh.triangle) hash.add(fmt::format("{} {} {}", t[0], t[1], t[2]));
  return hash.hex();
}

/// What reference.py needs of a scene, in the mesh's own frame: solved cases are found again
/// wherever a scene places the organ.
void add_scene(json& job, const model::scene::Scene& scene) {
  const Vec3& origin = scene.organ.position_m;
  job["organ"] = organ_of(scene);
  job["organ"]["mesh_hash"] = hash_of(scene.organ_mesh, origin);
  job["hand"] = {{"site_m", list_of(scene.hand_site_m - origin)},
                 {"inward", list_of(scene.hand_inward)},
                 {"path", json::array()}};
  for (const auto& point : scene.hand.path)
    job["hand"]["path"].push_back(
        {{"position_m", list_of(point.position_m - origin)}, {"grip_ratio", point.grip_ratio}});
  job["tool"] = job["reference_sites"] = json::array();
  for (const auto& sphere : scene.tool.spheres)
    job["tool"].push_back({{"offset_m", list_of(sphere.offset_m)}, {"radius_m", sphere.radius_m}});
  for (const auto& site : scene.reference_sites)
    job["reference_sites"].push_back({{"vertex", site.vertex}, {"held_out", site.held_out}});
}

Result<json> job_of(const Options& o) {
  json job = {{"sites", o.sites},
              {"depths_m", o.depths_m},
              {"large_strain", o.large_strain_sites},
              {"level", o.level},
              {"jobs", o.jobs},
              {"tool_together", o.tool},
              {"skin", o.skin},
              {"sideways", o.sideways},
              {"cache", o.cache},
              {"away_from_edges", o.away_from_edges},
              {"finite_strain", o.finite_strain},
              {"tilts_deg", o.tilts_deg},
              {"out", o.out},
              {"json", o.json},
              {"self_check", o.self_check}};
  if (!o.self_check.empty()) return job;
  // Before hours of work.
  if (auto error = program::check_output(o.out, "{", {o.scene.path})) return *error;
  if (o.scene.path.empty()) return Error{"no scene given; see tact-lab reference --help"};
  const auto scene = elastic_scene(o.scene);
  if (!scene) return scene.error();
  if (!scene->elastic->inclusions.empty())
    return Error{fmt::format(
        "{}: the reference knows no [[elastic.inclusion]]; leave them out of it", scene->path)};
  add_scene(job, *scene);
  return job;
}

Result<int> run(const program::Program&, Options& o) {
  const auto job = job_of(o);
  return job ? become("reference/reference.py", *job) : job.error();
}

}  // namespace

void add_reference(program::Program& lab) {
  lab.add<Options>("reference",
                   "the true force and shape of a pressed elastic organ, by finite elements",
                   R"(Solves press and pull of the scene's organ. Needs gmsh, Python's SciPy, and
CalculiX but for --tool, which tact solves itself: apt install gmsh python3-scipy
calculix-ccx. Solved cases are kept and reused.
Example: tact-lab reference model/scenes/liver.toml --out liver.json --jobs 2)",
                   add_options, run);
}

}  // namespace tact::tools::lab
