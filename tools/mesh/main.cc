// SPDX-License-Identifier: Apache-2.0
// tact-mesh: what is in this mesh file, is it sound, and if not, make it so.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "model/io/file_writer.h"
#include "model/io/json.h"
#include "model/io/program/within.h"
#include "tools/mesh/mesh_report.h"
#include "tools/mesh/place.h"
#include "tools/mesh/repair_file.h"
#include "tools/mesh/scene_edit.h"
#include "tools/mesh/solid.h"
#include "tools/mesh/unit.h"
#include "tools/program/program.h"

namespace {

namespace mesh = tact::tools::mesh;
using tact::model::Error;
using tact::model::Result;
using tact::tools::program::Program;

struct Step {
  const char* option;
  const char* what;
};

/// In the order of the work.
constexpr std::array<Step, 6> kSteps{{
    {"--weld", "join vertices nearer than 1e-5 of the surface's size, not equal ones alone"},
    {"--drop-degenerate", "drop faces without area, and doubled ones"},
    {"--largest", "keep the part with most faces, drop the others"},
    {"--hollow-refused", "refuse a part inside of that one, which would be filled"},
    {"--close-holes", "close every hole"},
    {"--smooth", "take away the steps of voxels, and keep the volume"},
}};

struct Options {
  std::string file, out;
  double unit_m = 0.0;  // 0: not given
  std::array<bool, kSteps.size()> wanted{};
  std::size_t decimate = 0;   // 0: not asked for
  std::string scene;          // empty: nothing is placed
  std::vector<double> point;  // in file units
  bool write = false, json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("FILE", o.file, "OBJ, STL, PLY, VTK, VTP, OFF, glTF or GLB, by its ending")
      ->required();
  app.add_option("--out", o.out,
                 "OBJ file to write, in the units and the frame of FILE, after these steps:");
  CLI::Option* named = app.add_option("--unit", o.unit_m,
                                      "of FILE: m, cm, mm, um or in (default: mm for 25 units or "
                                      "more, cm for 1 or more, else m; glTF: m)");
  named->transform(CLI::CheckedTransformer(mesh::units_m(), CLI::ignore_case).description(""));
  app.add_option("--unit-m", o.unit_m, "the same as a number: length of one file unit, m")
      ->check(tact::model::io::within(1e-9, 1e6))
      ->excludes(named);
  app.add_flag("--json", o.json, "print one JSON object, SI units (m, m2, m3)");
  for (std::size_t i = 0; i < kSteps.size(); ++i)
    app.add_flag(kSteps[i].option, o.wanted[i], kSteps[i].what);
  app.add_option("--decimate", o.decimate, "leave about so many faces")
      ->check(tact::model::io::within(4, 20'000'000));
  CLI::Option* align = app.add_option(
      "--align", o.scene,
      "scene (TOML): print unit, orientation and position that put the organ under its tool");
  app.add_option("--point", o.point,
                 "the point that the tool shall touch, X Y Z in file units; its normal is turned "
                 "towards the tool (default: the top as the mesh lies, not turned)")
      ->expected(3)
      ->check(tact::model::io::within(-1e12, 1e12))
      ->needs(align);
  app.add_flag("--write", o.write, "write them into the scene; its other lines stay")->needs(align);
}

/// The organ, under the tool of the scene.
Result<mesh::Placement> place_mesh(const Options& o, double unit_m,
                                   const tact::model::mesh::SurfaceMesh& organ) {
  if (o.out.empty() && !mesh::is_obj(o.file))
    return Error{fmt::format("{}: a scene reads OBJ; add --out OBJ", o.file)};
  mesh::PlaceOrder order{.scene_path = o.scene,
                         .mesh_path = o.out.empty() ? o.file : o.out,
                         .unit_m = unit_m,
                         .point = {}};
  if (!o.point.empty()) order.point = {o.point[0], o.point[1], o.point[2]};
  auto placement = mesh::place(order, organ);
  if (!placement || !o.write) return placement;
  if (const auto error = mesh::write_placement(o.scene, *placement)) return *error;
  return placement;
}

/// What of the command line repair.py does.
std::vector<std::string> repair_options(const Options& o) {
  std::vector<std::string> options;
  for (std::size_t i = 0; i < kSteps.size(); ++i)
    if (o.wanted[i]) options.emplace_back(kSteps[i].option);
  if (o.decimate > 0) options.push_back(fmt::format("--decimate={}", o.decimate));
  return options;
}

/// Read as it is, or repaired; in file units.
Result<mesh::Repaired> read_mesh(const Options& o, std::vector<std::string> steps) {
  if (steps.empty() && o.out.empty() && mesh::is_obj(o.file)) {
    auto obj = tact::model::mesh::load_obj(o.file, 1.0);
    if (!obj) return obj.error();
    if (const auto error = mesh::check_solid(o.file, obj->mesh)) return *error;
    return mesh::Repaired{.steps = {}, .obj_text = {}, .obj = std::move(*obj)};
  }
  if (const auto error =
          tact::tools::program::check_output(o.out, mesh::kRepairedBeginning, {o.file}))
    return *error;
  const auto on_step = [&o](const mesh::RepairStep& step) {
    if (!o.json) fmt::print("{}", mesh::to_text(step));
    std::fflush(stdout);
  };
  auto repaired = mesh::repair_file({.source = o.file, .options = std::move(steps)}, on_step,
                                    mesh::show_percent);
  if (!repaired) return repaired;
  if (const auto error = mesh::check_solid(o.file, repaired->obj.mesh)) return *error;
  if (o.out.empty()) return repaired;
  if (const auto error = tact::model::io::write_file(o.out, repaired->obj_text)) return *error;
  if (!o.json) fmt::print("{:<15}  {}\n", "wrote", o.out);
  return repaired;
}

}  // namespace

int main(int argc, char** argv) {
  Program program("tact-mesh",
                  "What is in this mesh file, and is it sound? Shows its size, and refuses what is "
                  "no surface:\n"
                  "an edge with more than two triangles, a face without area, a broken line. OBJ "
                  "files are read\n"
                  "as tact reads them. The steps below make a sound surface of what is none, in "
                  "this order, and\n"
                  "say what they did; VTK does them, from the package tact-lab.",
                  "With any step or --out: equal vertices are joined, faces turned as their "
                  "neighbours, sheets\n"
                  "that meet at one edge parted. Colours of vertices are kept, textures not.\n"
                  "A scan as one command: tact-mesh scan.stl --out organ.obj --weld "
                  "--drop-degenerate --largest\n"
                  "--close-holes --smooth --decimate 6000");
  Options options;
  add_options(program.options(), options);
  if (const auto status = program.parse(argc, argv)) return *status;
  auto read = read_mesh(options, repair_options(options));
  if (!read) return program.fail(read.error());
  const mesh::Unit unit = mesh::unit_of(options.file, options.unit_m, read->obj.mesh);
  scale(read->obj.mesh, unit.unit_m);
  std::optional<mesh::Placement> placement;
  if (!options.scene.empty()) {
    auto placed = place_mesh(options, unit.unit_m, read->obj.mesh);
    if (!placed) return program.fail(placed.error());
    placement = std::move(*placed);
  }
  // A path may hold bytes that are no UTF-8; JSON then shows them as replacement characters.
  if (options.json) {
    auto reported = mesh::to_json(options.file, unit, read->obj, read->steps, options.out);
    if (placement) reported["placement"] = mesh::to_json(*placement);
    fmt::print("{}\n", tact::model::io::text_of(reported, 2));
    return 0;
  }
  fmt::print("{}", mesh::to_text(read->obj, unit));
  if (placement) fmt::print("\n{}", mesh::toml_of(*placement));
  if (options.write) fmt::print("\n{:<15}  {}\n", "wrote", options.scene);
  if (placement && !placement->misfits.empty()) fmt::print("\n");
  if (placement)
    for (const auto& misfit : placement->misfits) fmt::print("{}", mesh::to_text(misfit));
  return 0;
}
