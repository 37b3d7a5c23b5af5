// SPDX-License-Identifier: Apache-2.0
// tact-lab sweep: the whole tool of a scene pressed into its organ at every vertex.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <filesystem>

#include "firmware/admission/stiffness_check.h"
#include "hal/registry/open_device.h"
#include "model/io/file_writer.h"
#include "model/io/program/within.h"
#include "model/scene/tissue.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"
#include "tools/sweep/all_cores.h"
#include "tools/sweep/reference_presses.h"
#include "tools/sweep/sweep_report.h"

namespace tact::tools::lab {
namespace {

using model::Error;
using model::Result;
using model::scene::PressPoint;
using model::scene::PressSettings;
using model::scene::PressStep;
using model::scene::PressSweep;
using model::scene::PressWay;
using model::scene::Scene;
using nlohmann::json;

constexpr std::size_t kWorst = 10;  // reported by name

struct Options {
  program::SceneArguments scene;
  std::string out, vertices = "300", reference;
  std::vector<std::uint32_t> vertex;
  double step_m = 2e-5, depth_m = 0.0, limit_N_per_m = 0.0;
  bool square = false, upright = false, no_plots = false, json = false;
};

/// 0: all.
std::optional<std::size_t> count_in(const std::string& word) {
  if (word == "all") return 0;
  std::size_t count = 0;
  const auto [end, wrong] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (wrong != std::errc{} || end != word.data() + word.size() || count == 0) return std::nullopt;
  return count;
}

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app);
  auto* out = app.add_option("--out", o.out, "folder for table and picture; made if need be");
  app.add_option("--reference", o.reference,
                 "hold the scene against the presses of this file instead, as "
                 "tests/data/reference/liver_finite_strain.json")
      ->excludes(out);
  app.add_option("--vertices", o.vertices,
                 "how many vertices of the organ each way, spread over all, or \"all\" (default "
                 "300)")
      ->check([](const std::string& word) {
        return count_in(word) ? "" : fmt::format("\"{}\" is no number above 0 and not all", word);
      });
  app.add_option("--vertex", o.vertex,
                 "this vertex alone, counted from 0; repeatable. Of one press press.csv has the "
                 "force along the way")
      ->check(model::io::within(0, 4294967294.0));
  app.add_option("--step-m", o.step_m, "of the tool along its way, m (default 2e-5)")
      ->check(model::io::within(1e-7, 1e-3));
  app.add_option("--depth-m", o.depth_m,
                 "of the tool's lowest point, m (default: the working range of the law)")
      ->check(model::io::within(1e-5, 1.0));
  app.add_option("--limit-N-per-m", o.limit_N_per_m,
                 "stiffness that is admitted, N/m (default: that of the scene's device, if it is "
                 "simulated)")
      ->check(model::io::above_zero());
  app.add_flag("--square", o.square, "along the inward normal of the vertex, the tool turned so");
  app.add_flag("--upright", o.upright,
               "along hand.inward, the tool as at rest, at vertices that face the hand (default: "
               "both ways)");
  app.add_flag("--no-pictures", o.no_plots, "tables alone; needs no gnuplot");
  app.add_flag("--json", o.json, "print one JSON document, SI units");
}

Result<double> limit_N_per_m(const Options& o, const Scene& scene) {
  if (o.limit_N_per_m > 0.0) return o.limit_N_per_m;
  if (!hal::registry::is_simulated(scene.device))
    return Error{
        fmt::format("{}: device.kind \"{}\" is hardware, which this program does not open; give "
                    "--limit-N-per-m, the limit that tactd {} --check prints",
                    scene.path, scene.device.kind, scene.path)};
  const auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return tissue.error();
  const auto device = hal::registry::open_device(scene);
  if (!device) return device.error();
  return firmware::admission::stiffness_limit_N_per_m(scene, (*tissue)->law(), (*device)->info());
}

Result<std::vector<PressPoint>> places_of(const Options& o, const Scene& scene) {
  const bool both = o.square == o.upright;
  if (o.vertex.empty())
    return press_points(scene, *count_in(o.vertices), o.square || both, o.upright || both);
  std::vector<PressPoint> out;
  for (const std::uint32_t vertex : o.vertex) {
    if (vertex >= scene.organ_mesh.vertex_m.size())
      return Error{fmt::format("--vertex {}: the organ has the vertices 0 to {}", vertex,
                               scene.organ_mesh.vertex_m.size() - 1)};
    if (o.square || both) out.push_back({vertex, PressWay::kSquare});
    if (o.upright || both) out.push_back({vertex, PressWay::kUpright});
  }
  return out;
}

/// The force along one way, step by step.
std::optional<Error> write_way(const Scene& scene, const PressSweep& sweep,
                               const std::string& path) {
  const auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return tissue.error();
  std::string csv = "depth_m,force_N,force_x_N,force_y_N,force_z_N,stored_J,work_J\n";
  press_once((*tissue)->contact_scene(), scene.hand_inward, sweep.results.front().place,
             sweep.settings, [&csv](const PressStep& step) {
               const model::Vec3& f = step.force_N;
               csv +=
                   fmt::format("{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", step.depth_m,
                               step.along_N, f.x, f.y, f.z, step.stored_J, step.work_J);
             });
  return model::io::write_file(path, csv);
}

bool has_picture(const Options& o, const PressSweep& sweep) {
  return !o.no_plots && sweep.results.size() != 1;
}

/// Writes the table, of a single press its force along the way, too; with the names of the picture.
Result<std::vector<std::string>> write_all(const Options& o, const Scene& scene,
                                           const PressSweep& sweep) {
  auto files = sweep::presses_table(scene, sweep).write(o.out);
  if (!files) return files.error();
  const auto in_folder = [&](const char* name) {
    return files->emplace_back((std::filesystem::path(o.out) / name).string());
  };
  if (sweep.results.size() == 1)
    if (auto error = write_way(scene, sweep, in_folder("press.csv"))) return *error;
  if (has_picture(o, sweep))
    for (const char* name : {"presses.svg", "presses.png"}) in_folder(name);
  return files;
}

/// Without what chooses the places: those of one press are added.
std::string command_for(const Options& o) {
  std::string out = fmt::format("tact-lab sweep {} --out {}", o.scene.path, o.out);
  for (const std::string& set : o.scene.overrides) out += fmt::format(" --set '{}'", set);
  if (o.step_m != Options{}.step_m) out += fmt::format(" --step-m {:g}", o.step_m);
  if (o.depth_m > 0.0) out += fmt::format(" --depth-m {:g}", o.depth_m);
  if (o.limit_N_per_m > 0.0) out += fmt::format(" --limit-N-per-m {:g}", o.limit_N_per_m);
  return out;
}

Result<int> run(const program::Program&, Options& o) {
  const auto scene = o.scene.load(hal::registry::visit_device);
  if (!scene) return scene.error();
  if (!o.reference.empty()) {
    const auto presses = sweep::press_reference(*scene, o.reference);
    if (!presses) return presses.error();
    fmt::print("{}\n", o.json ? sweep::json_of(*presses) : sweep::text_of(*presses));
    return 0;
  }
  if (o.out.empty()) return Error{"give --out FOLDER for the table, or --reference FILE"};
  const auto places = places_of(o, *scene);
  if (!places) return places.error();
  const auto limit = limit_N_per_m(o, *scene);
  if (!limit) return limit.error();
  if (auto error = program::prepare_folder(o.out)) return *error;
  const PressSettings settings{
      .step_m = o.step_m, .depth_m = o.depth_m, .limit_N_per_m = *limit, .checks_energy = true};
  const auto sweep = sweep::sweep_on_all_cores(*scene, *places, settings);
  if (!sweep) return sweep.error();
  const auto files = write_all(o, *scene, *sweep);
  if (!files) return files.error();
  const std::string command = command_for(o);
  return finish(has_picture(o, *sweep) ? sweep::presses_picture(*sweep, o.out) : json::object(),
                o.json ? sweep::json_of(*scene, *sweep, command, *files) + "\n"
                       : sweep::text_of(*sweep, command, kWorst),
                sweep->flawed().empty() ? 0 : 1);
}

}  // namespace

void add_sweep(program::Program& lab) {
  lab.add<Options>(
      "sweep", "the whole tool pressed in at many vertices: is its force sound everywhere?",
      R"(Presses the whole tool from free outside to the working range of the law, and checks the
force in every step: it never draws the tool in, never jumps, is no stiffer than the
device can show, and stores the work of the hand.
Checks: along the way the force is at least -1 mN; the force vector changes by at most
the admitted stiffness times the step; the slope dF/dd (median of three steps, N/m) is at
most the admitted stiffness (HL-1: damping of the device at this rate); without friction
and relaxation the stored energy is the work of the hand within 2 % and the largest force
times the step. The force may fall along the way: on a steep flank the true one does.
Depths are those of the tool's lowest point beyond the vertex, m.
Example: tact-lab sweep model/scenes/liver.toml --vertices all --out sweep)",
      add_options, run);
}

}  // namespace tact::tools::lab
