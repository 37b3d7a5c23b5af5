// SPDX-License-Identifier: Apache-2.0
// tact-condense: how much the scene's organ gives at every place of its surface, once and for all.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "model/io/program/within.h"
#include "model/scene/compliance_file.h"
#include "tools/condense/condense_organ.h"
#include "tools/program/interrupt.h"
#include "tools/program/program.h"

namespace {

using tact::model::Vec3;
using tact::model::tissue::ComplianceMap;
using tact::tools::condense::CondenseFacts;
using tact::tools::condense::CondenseInput;

struct Options {
  tact::tools::program::SceneArguments scene;
  std::string out;
  double mesh_size_m = 0.0, patch_radius_m = 0.0;
  double ring_pitch_m = 0.0;
  std::size_t rings = 0;
  bool json = false;
};

/// A length in an organ, m.
CLI::Validator a_length() { return tact::model::io::within(1e-6, 1.0); }

void add_options(CLI::App& app, Options& o) {
  o.scene.add_to(app, "[elastic]");
  app.add_option("--out", o.out, "compliance map to write")->required();
  app.add_option("--mesh-size-m", o.mesh_size_m,
                 "edge of an element inside the organ, m (default: 1.5 median edges of its "
                 "surface); half as long is about 20 times the work")
      ->check(a_length());
  app.add_option("--patch-radius-m", o.patch_radius_m,
                 "a0 of the loaded patch, m (default: 1.6 elements); of little effect")
      ->check(a_length());
  app.add_option("--ring-pitch-m", o.ring_pitch_m, "of the shape around a place, m (default 0.002)")
      ->check(a_length());
  app.add_option("--rings", o.rings, "of the shape, 1 to 31 (default 20)")
      ->check(tact::model::io::within(1, 31));
  app.add_flag("--json", o.json, "print one JSON object, SI units");
}

bool show_progress(std::size_t done, std::size_t vertices) {
  if (isatty(STDERR_FILENO) != 0) {
    if (done == 0)
      fmt::print(stderr, "\rtact-condense: filling and factoring the organ ...");
    else
      fmt::print(stderr, "\rtact-condense: {} of {} vertices              {}", done, vertices,
                 done == vertices ? "\n" : "");
    std::fflush(stderr);
  }
  return !tact::tools::program::is_interrupted();
}

struct Range {
  double low = 0.0, middle = 0.0, high = 0.0;
};

Range range_of(std::vector<float> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&values](std::size_t i) { return static_cast<double>(values[i]); };
  return {at(0), at(values.size() / 2), at(values.size() - 1)};
}

void report(const Options& o, const ComplianceMap& map, const CondenseFacts& facts,
            std::size_t bytes, double seconds) {
  const Range r = range_of(map.regular_times_E_per_m);
  if (o.json) {
    const nlohmann::json out{
        {"format", "tact-condense"},
        {"version", 1},
        {"file", o.out},
        {"bytes", bytes},
        {"vertices", map.vertices()},
        {"rings", map.rings},
        {"ring_pitch_m", map.ring_pitch_m},
        {"poisson_ratio", map.poisson_ratio},
        {"patch_radius_m", map.patch_radius_m},
        {"mesh_size_m", facts.mesh_size_m},
        {"mesh_hash", map.mesh_hash},
        {"nodes", facts.nodes},
        {"elements", facts.elements},
        {"regular_times_E_per_m", {{"least", r.low}, {"median", r.middle}, {"most", r.high}}},
        {"seconds_s", seconds}};
    fmt::print("{}\n", tact::model::io::text_of(out, 2));
    return;
  }
  fmt::print("{}: {} bytes, {} vertices, {} rings of {:.3g} mm, nu = {:.3g}\n", o.out, bytes,
             map.vertices(), map.rings, 1e3 * map.ring_pitch_m, map.poisson_ratio);
  fmt::print("body   {} nodes, {} elements of {:.3g} mm; patch radius {:.3g} mm\n", facts.nodes,
             facts.elements, 1e3 * facts.mesh_size_m, 1e3 * map.patch_radius_m);
  fmt::print("r E    {:.4g} least, {:.4g} median, {:.4g} most, 1/m\n", r.low, r.middle, r.high);
  fmt::print("took   {:.0f} s\n", seconds);
}

}  // namespace

int main(int argc, char** argv) {
  tact::tools::program::Program program(
      "tact-condense",
      "Condense the scene's organ: solve it by finite elements under a small load at every vertex\n"
      "of its surface, and keep how much more it gives there than an endless block would. The\n"
      "compliance law then costs a look-up a tick. Minutes of work, done once for a mesh.",
      "Needs gmsh: apt install gmsh. The map holds r E (1/m): Young's modulus may change without "
      "a new map,\nPoisson's ratio, the held box and the mesh may not.");
  Options o;
  add_options(program.options(), o);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (const auto error = tact::tools::program::check_output(o.out, "TACTCOMP", {o.scene.path}))
    return program.fail(*error);
  const auto scene = o.scene.load();
  if (!scene) return program.fail(scene.error());
  auto input = tact::tools::condense::condense_input(*scene);
  if (!input) return program.fail(input.error());
  input->settings.mesh_size_m = o.mesh_size_m;
  input->settings.patch_radius_m = o.patch_radius_m;
  if (o.ring_pitch_m > 0.0) input->settings.organ.ring_pitch_m = o.ring_pitch_m;
  if (o.rings > 0) input->settings.organ.rings = o.rings;
  input->settings.organ.progress = show_progress;
  const auto start = std::chrono::steady_clock::now();
  CondenseFacts facts;
  const auto map = tact::tools::condense::condense_organ(*input, facts);
  if (!map) return program.fail(map.error());
  const auto bytes = tact::model::scene::write_compliance_map(*map, o.out);
  if (!bytes) return program.fail(bytes.error());
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report(o, *map, facts, *bytes, took.count());
  return 0;
}
