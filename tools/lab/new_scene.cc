// SPDX-License-Identifier: Apache-2.0
// tact-lab new-scene: a mesh in, a scene out.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "model/io/file_writer.h"
#include "model/io/input_file.h"
#include "model/io/program/within.h"
#include "model/scene/compliance_file.h"
#include "tools/condense/condense_organ.h"
#include "tools/condense/gmsh.h"
#include "tools/lab/commands.h"
#include "tools/mesh/mesh_report.h"
#include "tools/mesh/unit.h"
#include "tools/new_scene/choose_law.h"
#include "tools/new_scene/organ.h"
#include "tools/new_scene/outputs.h"
#include "tools/new_scene/scene_text.h"
#include "tools/program/run_program.h"

namespace tact::tools::lab {
namespace {

namespace fs = std::filesystem;
using model::Error;
using model::Result;
using new_scene::Organ;
using new_scene::OutputNames;

/// A scene whose map is still to come, as tools/run starts it.
constexpr std::array kTipAlone{"--set", "law=rhombus", "--set", "varies_by_place=false"};

struct Options {
  new_scene::OrganOrder organ{.source = {}, .faces = 6000};
  std::string out;
  double youngs_modulus_Pa = 5000.0, poisson_ratio = 0.45;
  bool plan = false, without_map = false, force = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("ORGAN", o.organ.source,
                 "mesh: OBJ, STL, PLY, VTK, VTP, OFF, glTF or GLB, by its ending")
      ->required();
  app.add_option("--out", o.out, "scene to write, NAME.toml; its files come beside it, NAME.*")
      ->required();
  app.add_option("--unit", o.organ.unit_m,
                 "of ORGAN: m, cm, mm, um or in (default: mm for 25 units or more, cm for 1 or "
                 "more, else m)")
      ->transform(CLI::CheckedTransformer(mesh::units_m(), CLI::ignore_case).description(""));
  app.add_option("--youngs-modulus-Pa", o.youngs_modulus_Pa, "E of the tissue")
      ->check(model::io::within(100.0, 1e6))
      ->capture_default_str();
  app.add_option("--poisson-ratio", o.poisson_ratio, "nu of the tissue")
      ->check(model::io::within(0.0, 0.495))
      ->capture_default_str();
  app.add_option("--faces", o.organ.faces, "leave at most about so many")
      ->check(model::io::within(100, 40'000))
      ->capture_default_str();
  app.add_flag("--smooth", o.organ.smooth, "take the steps of voxels away");
  app.add_flag(
      "--plan", o.plan,
      "also solve references and let tact-lab plan choose the law for this PC: minutes to an "
      "hour; needs CalculiX, which Debian 13 has not");
  app.add_flag("--without-map", o.without_map,
               "leave the minutes of finite elements out: the scene is felt by the tip's own law "
               "until tact-lab condense has made its map")
      ->excludes("--plan");
  app.add_flag("--force", o.force, "replace the files of an earlier run");
}

void report(const char* step, const std::string& text) {
  fmt::print("{:<15}  {}\n", step, text);
  std::fflush(stdout);
}

/// What can be refused is refused before the minutes of work.
std::optional<Error> check_before(const Options& o, const OutputNames& names) {
  const std::string& source = o.organ.source;
  if (auto error =
          new_scene::check_new(names.scene, "# made by tact-lab new-scene", source, o.force))
    return error;
  if (auto error = new_scene::check_new(names.map, "TACTCOMP", source, o.force)) return error;
  if (auto error = new_scene::check_new(names.tool, new_scene::tool_mesh(), source, o.force))
    return error;
  if (o.plan)
    for (const std::string& path : {names.reference, names.tool_reference})
      if (auto error = new_scene::check_new(path, "{\"schema\": \"tact-", source, o.force))
        return error;
  const auto input = model::io::InputFile::open(source, "name a mesh file");
  if (!input) return input.error();
  if (!new_scene::is_sound(o.organ))
    if (auto error = new_scene::check_new(names.organ, std::string(mesh::kRepairedBeginning),
                                          source, o.force))
      return error;
  if (o.without_map) return std::nullopt;
  const auto gmsh = condense::gmsh_version();
  return gmsh ? std::nullopt : std::optional(gmsh.error());
}

Result<Organ> read(const Options& o, const std::string& folder) {
  auto organ = new_scene::read_organ(
      o.organ, folder,
      [](const mesh::RepairStep& step) {
        fmt::print("{}", mesh::to_text(step));
        std::fflush(stdout);
      },
      mesh::show_percent);
  if (!organ) return organ;
  report("unit", to_text(organ->unit, organ->mesh));
  const auto sum = summarize(organ->mesh);
  const auto size_m = sum.high_m - sum.low_m;
  report("organ", fmt::format("{} vertices, {} faces, closed, {:.3g} x {:.3g} x {:.3g} mm{}",
                              sum.vertices, sum.triangles, 1e3 * size_m.x, 1e3 * size_m.y,
                              1e3 * size_m.z, organ->obj_text.empty() ? ", taken as it is" : ""));
  return organ;
}

std::string text_of(const Options& o, const OutputNames& names, const Organ& organ,
                    const new_scene::ScenePlacement& place, const char* law) {
  const auto beside = [](const std::string& path) { return fs::path(path).filename().string(); };
  std::error_code failed;
  const std::string source = fs::absolute(o.organ.source, failed).lexically_normal().string();
  return new_scene::scene_text({.source = o.organ.source,
                                .name = names.name,
                                .map = beside(names.map),
                                .tool = beside(names.tool),
                                .mesh = organ.obj_text.empty() ? source : beside(names.organ),
                                .law = law,
                                .has_colors = organ.has_colors,
                                .mesh_unit_m = organ.unit.unit_m,
                                .youngs_modulus_Pa = o.youngs_modulus_Pa,
                                .poisson_ratio = o.poisson_ratio},
                               place);
}

/// The map of the scene's organ, into its file.
std::optional<Error> condense(const std::string& scene_path, const std::string& map_path) {
  const auto scene = model::scene::load_scene(scene_path, {});
  if (!scene) return scene.error();
  auto input = condense::condense_input(*scene);
  if (!input) return input.error();
  report("condense", fmt::format("{} vertices, by finite elements: minutes for thousands",
                                 input->surface.vertex_m.size()));
  condense::CondenseFacts facts;
  const auto map = condense::condense_organ(*input, facts);
  if (!map) return map.error();
  const auto bytes = model::scene::write_compliance_map(*map, map_path);
  return bytes ? std::nullopt : std::optional(bytes.error());
}

/// `message` with the folder where the files will come; none is there yet.
std::string about(std::string message, const std::string& scratch, const OutputNames& names) {
  std::error_code failed;
  const std::string folder = fs::absolute(names.scene, failed).parent_path().string();
  for (std::size_t at = 0; (at = message.find(scratch, at)) != std::string::npos;
       at += folder.size())
    message.replace(at, scratch.size(), folder);
  return message;
}

/// What lies in the scratch folder, under the names it will have; the scene is the last to appear.
Result<std::vector<new_scene::OutputFile>> collect(const OutputNames& made,
                                                   const OutputNames& names) {
  std::vector<new_scene::OutputFile> files;
  for (const auto name :
       {&OutputNames::organ, &OutputNames::tool, &OutputNames::map, &OutputNames::reference,
        &OutputNames::tool_reference, &OutputNames::scene}) {
    std::error_code failed;
    if (!fs::exists(made.*name, failed)) continue;
    auto content = model::io::read_file(made.*name, "try again");
    if (!content) return content.error();
    files.push_back({names.*name, std::move(*content)});
  }
  return files;
}

/// Every file of the scene in `folder`, whole and judged; then all of them to their places. True if
/// tact-lab plan has chosen its law.
Result<bool> make_scene(const Options& o, const OutputNames& names, const std::string& folder) {
  const auto made = new_scene::names_of(folder + "/" + fs::path(names.scene).filename().string());
  if (!made) return made.error();
  const auto organ = read(o, folder);
  if (!organ) return organ.error();
  const auto place = new_scene::place_of(organ->mesh);
  report("place",
         fmt::format("the top comes to the tool; held below z = {:.4g} mm, the lowest tenth",
                     1e3 * place.held.max_m.z));
  const auto write_scene = [&](const char* law) {
    return model::io::write_file(made->scene, text_of(o, names, *organ, place, law));
  };
  const std::string log = folder + "/log";
  if (!organ->obj_text.empty())
    if (auto error = model::io::write_file(made->organ, organ->obj_text)) return *error;
  if (auto error = model::io::write_file(made->tool, new_scene::tool_mesh())) return *error;
  if (auto error = write_scene("compliance")) return *error;
  std::vector<std::string> check{made->scene, "--check"};
  if (o.without_map)
    check.insert(check.end(), kTipAlone.begin(), kTipAlone.end());
  else if (auto error = condense(made->scene, made->map))
    return *error;
  // Its own message if it does not.
  if (const auto taken = new_scene::ask("tactd", check, log); !taken) return taken.error();
  bool is_planned = o.plan;
  if (o.plan) {
    if (auto error = write_scene("auto")) return *error;
    const auto report_here = [&](const char* step, const std::string& text) {
      report(step, about(text, folder, names));
    };
    if (const auto none = new_scene::choose_law(*made, log, report_here)) {
      if (program::was_interrupted(*none)) return *none;
      is_planned = false;
      report_here("plan", "none: " + none->message);
      if (auto error = write_scene("compliance")) return *error;
    }
  }
  report("check", "tactd takes the scene");
  const auto files = collect(*made, names);
  if (!files) return files.error();
  if (program::is_interrupted()) return program::interruption();
  if (auto error = new_scene::write_all(*files, o.force)) return *error;
  for (const auto& file : *files) report("wrote", file.path);
  return is_planned;
}

/// As a shell reads it as one word.
std::string as_word(const std::string& path) {
  if (path.find_first_of(" \t\"'\\$&;|<>()*?[]#~`!") == path.npos) return path;
  std::string word = path;
  for (std::size_t at = 0; (at = word.find('\'', at)) != word.npos; at += 4)
    word.replace(at, 1, "'\\''");
  return "'" + word + "'";
}

void report_what_next(const OutputNames& names, const Options& o, bool is_planned) {
  const std::string scene = as_word(names.scene);
  if (o.without_map) {
    fmt::print(
        "\nFeel its tip alone:\n  tactd {} {} --free-run --seconds 5\nIts map, minutes:\n"
        "  tact-lab condense {} --out {}\n",
        scene, fmt::join(kTipAlone, " "), scene, as_word(names.map));
    return;
  }
  report("law",
         is_planned ? "as tact-lab plan has chosen for this PC" : "compliance, from the map");
  fmt::print("\nFeel it:\n  tactd {} --free-run --seconds 5\n", scene);
  if (is_planned)
    fmt::print(
        "On another PC its times differ; there, once:\n  tact-lab plan {} --reference {} "
        "--tool-reference {}\n",
        scene, as_word(names.reference), as_word(names.tool_reference));
  else if (!o.plan)
    fmt::print(
        "Is a faster law good enough? The same with --plan --force compares them, by CalculiX.\n");
}

Result<int> run(const program::Program&, Options& o) {
  const auto names = new_scene::names_of(o.out);
  if (!names) return names.error();
  if (auto error = check_before(o, *names)) return *error;
  const auto folder = program::ScratchFolder::make("tact-new-scene");
  if (!folder) return folder.error();
  const auto is_planned = make_scene(o, *names, folder->path());
  if (!is_planned)
    return Error{about(is_planned.error().message, folder->path(), *names),
                 is_planned.error().code};
  report_what_next(*names, o, *is_planned);
  return 0;
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
