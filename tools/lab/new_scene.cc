// SPDX-License-Identifier: Apache-2.0
// tact-lab new-scene: a mesh in, a scene out. Its options, and what is refused before the work;
// tools/new_scene/new_scene.py does that.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <string_view>

#include "model/io/input_file.h"
#include "model/io/program/installed.h"
#include "model/io/program/within.h"
#include "model/scene/scene.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"
#include "tools/mesh/repair_file.h"
#include "tools/mesh/unit.h"

namespace tact::tools::lab {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;

struct Options {
  std::string source, out;
  double unit_m = 0.0;  // 0: the likely one
  std::size_t faces = 6000;
  double youngs_modulus_Pa = 5000.0, poisson_ratio = 0.45;
  bool smooth = false, plan = false, without_map = false, force = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("ORGAN", o.source,
                 "mesh: OBJ, STL, PLY, VTK, VTP, OFF, glTF or GLB, by its ending")
      ->required();
  app.add_option("--out", o.out, "scene to write, NAME.toml; its files come beside it, NAME.*")
      ->required();
  app.add_option("--unit", o.unit_m,
                 "of ORGAN: m, cm, mm, um or in (default: mm for 25 units or more, cm for 1 or "
                 "more, else m)")
      ->transform(CLI::CheckedTransformer(mesh::units_m(), CLI::ignore_case).description(""));
  app.add_option("--youngs-modulus-Pa", o.youngs_modulus_Pa, "E of the tissue")
      ->check(model::io::within(model::scene::kYoungs_modulus_Pa.low,
                                model::scene::kYoungs_modulus_Pa.high))
      ->capture_default_str();
  app.add_option("--poisson-ratio", o.poisson_ratio, "nu of the tissue")
      ->check(
          model::io::within(model::scene::kPoisson_ratio.low, model::scene::kPoisson_ratio.high))
      ->capture_default_str();
  app.add_option("--faces", o.faces, "leave at most about so many")
      ->check(model::io::within(100, 40'000))
      ->capture_default_str();
  app.add_flag("--smooth", o.smooth, "take the steps of voxels away");
  app.add_flag(
      "--plan", o.plan,
      "also solve references and let tact-lab plan choose the law for this PC: minutes to an "
      "hour; needs CalculiX, which Debian 13 has not");
  app.add_flag("--without-map", o.without_map,
               "leave the minutes of finite elements out: the scene has the tip's own law "
               "until tact-lab condense has made its map")
      ->excludes("--plan");
  app.add_flag("--force", o.force, "replace the files of an earlier run");
}

/// A file to make, and how those of its kind begin.
struct Output {
  std::string_view name;
  const char* ending;
  std::string_view beginning;
};

constexpr Output kOutputs[]{{"scene", ".toml", "# made by tact-lab new-scene"},
                            {"map", ".compliance", "TACTCOMP"},
                            {"organ", ".obj", mesh::kRepairedBeginning},
                            {"tool", "_tool.obj", "# forceps, made by tact-make-meshes"},
                            {"reference", ".reference.json", "{\"schema\": \"tact-"},
                            {"tool_reference", "_tool.reference.json", "{\"schema\": \"tact-"}};

/// Closed, of one part and not too many faces: taken as it is.
bool is_sound(const Options& o) {
  if (o.smooth || !mesh::is_obj(o.source)) return false;
  const auto obj = model::mesh::load_obj(o.source, 1.0);
  if (!obj || obj->mesh.triangle.size() > o.faces) return false;
  return summarize(obj->mesh).boundary_edges == 0 && model::mesh::count_parts(obj->mesh) == 1;
}

/// The names of all files, beside the scene; an error for one that may not be written.
Result<nlohmann::json> names_of(const Options& o) {
  const fs::path out(o.out);
  if (out.extension() != ".toml" || out.stem().empty())
    return Error{fmt::format("{}: a scene's name ends in .toml; write --out mine.toml", o.out)};
  const std::string stem = out.stem().string();
  // A scene's text would not take it.
  if (std::any_of(stem.begin(), stem.end(), [](unsigned char c) { return c < ' ' || c == 0x7F; }))
    return Error{"the scene's name has a control character; choose another --out"};
  nlohmann::json names{{"name", stem}};
  for (const Output& file : kOutputs) {
    const std::string path = (out.parent_path() / (stem + file.ending)).string();
    names[std::string(file.name)] = path;
    if (file.name == "organ" && is_sound(o)) continue;
    if (file.name.ends_with("reference") && !o.plan) continue;
    std::error_code failed;
    if (!o.force && fs::exists(fs::symlink_status(path, failed)))
      return Error{fmt::format("{}: exists already; choose another --out, or add --force", path)};
    if (auto error = program::check_output(path, file.beginning, {o.source})) return *error;
  }
  return names;
}

Result<int> run(const program::Program&, Options& o) {
  const auto names = names_of(o);
  if (!names) return names.error();
  const auto input = model::io::InputFile::open(o.source, "name a mesh file");
  if (!input) return input.error();
  return become("new_scene/new_scene.py", {{"source", o.source},
                                           {"names", *names},
                                           {"is_sound", is_sound(o)},
                                           {"programs", model::io::program_folder().string()},
                                           {"unit_m", o.unit_m},
                                           {"faces", o.faces},
                                           {"youngs_modulus_Pa", o.youngs_modulus_Pa},
                                           {"poisson_ratio", o.poisson_ratio},
                                           {"smooth", o.smooth},
                                           {"plan", o.plan},
                                           {"without_map", o.without_map},
                                           {"force", o.force}});
}

}  // namespace

void add_new_scene(program::Program& lab) {
  lab.add<Options>(
      "new-scene", "a mesh in, a scene out: repaired, placed, condensed, and taken by tactd",
      R"(Repairs the organ's mesh where needed, puts its top under the forceps, holds its lowest
tenth, condenses it, and asks tactd whether it takes the scene. Minutes of work. The law
is compliance, from the map; with --plan the one that tact-lab plan chooses. Beside
NAME.toml come NAME.compliance, NAME_tool.obj and, if ORGAN was repaired or is no OBJ
file, NAME.obj; with --plan two references. No file appears before all are whole. Needs
gmsh: apt install gmsh; to repair a mesh Python's VTK: apt install python3-vtk9. E and nu
are those of the shipped liver. Nothing is turned: what is on top in the file is touched.
Example: tact-lab new-scene organ.stl --out mine.toml)",
      add_options, run);
}

}  // namespace tact::tools::lab
