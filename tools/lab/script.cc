// SPDX-License-Identifier: Apache-2.0
#include "tools/lab/script.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <cstdio>
#include <filesystem>

#include "model/io/json.h"
#include "tools/program/run_program.h"
#include "tools/program/script.h"

namespace tact::tools::lab {

using model::Error;
using model::Result;
using model::Vec3;
using nlohmann::json;

json list_of(const Vec3& v) { return {v.x, v.y, v.z}; }

Result<model::scene::Scene> elastic_scene(const program::SceneArguments& arguments) {
  auto scene = arguments.load();
  if (scene && !scene->elastic)
    return Error{fmt::format(
        "{}: has no [elastic]; add it with youngs_modulus_Pa, poisson_ratio, fixed_min_m and "
        "fixed_max_m, or give them with --set",
        scene->path)};
  return scene;
}

json organ_of(const model::scene::Scene& scene) {
  json vertex_m = json::array(), normal = json::array();
  for (const Vec3& v : scene.organ_mesh.vertex_m)
    vertex_m.push_back(list_of(v - scene.organ.position_m));
  for (const Vec3& v : scene.organ_mesh.vertex_normal) normal.push_back(list_of(v));
  return {{"mesh", std::filesystem::path(scene.organ.mesh_path).filename().string()},
          {"vertex_m", std::move(vertex_m)},
          {"vertex_normal", std::move(normal)},
          {"triangle", scene.organ_mesh.triangle},
          {"youngs_modulus_Pa", scene.elastic->youngs_modulus_Pa},
          {"poisson_ratio", scene.elastic->poisson_ratio},
          {"fixed_min_m", list_of(scene.elastic->fixed_min_m)},
          {"fixed_max_m", list_of(scene.elastic->fixed_max_m)}};
}

void add_finite_strain(CLI::App& app, std::string& path) {
  app.add_option("--finite-strain", path,
                 "the same places at finite strain; JSON of tact-lab reference SCENE --tool "
                 "--finite-strain FEniCSx --out FILE: where the linear force differs by more than "
                 "3 %, the place does not count, and is named")
      ->needs("--tool-reference");
}

Result<int> become(const char* script, const json& job, AfterCtrlC when) {
  // In memory, open in the program that takes our place: gone however that ends.
  const int fd = memfd_create("tact-job", 0);
  if (dprintf(fd, "%s", model::io::text_of(job).c_str()) < 0)
    return Error{"no file in memory; free some memory, or close programs"};
  if (when == AfterCtrlC::kNot && program::is_interrupted()) return program::interruption();
  return program::become_script(script, {fmt::format("/proc/self/fd/{}", fd)}, "tact-lab");
}

Result<int> finish(Result<json> picture, const std::string& text, int status) {
  if (!picture) return picture.error();
  if (picture->empty()) {
    fmt::print("{}", text);
    return status;
  }
  (*picture)["text"] = text;
  (*picture)["status"] = status;
  return become("lab/picture.py", *picture);
}

}  // namespace tact::tools::lab
