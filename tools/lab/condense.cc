// SPDX-License-Identifier: Apache-2.0
// tact-lab condense: the compliance of the scene's organ at every vertex, once and for all.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/io/json.h"
#include "model/io/program/within.h"
#include "model/scene/compliance_file.h"
#include "tools/condense/condense_organ.h"
#include "tools/lab/commands.h"

namespace tact::tools::lab {
namespace {

using condense::CondenseFacts;
using model::Result;
using model::tissue::ComplianceMap;

struct Options {
  program::SceneArguments scene;
  std::string out;
  double mesh_size_m = 0.0, patch_radius_m = 0.0;
  double ring_pitch_m = 0.0;
  std::size_t rings = 0;
  bool json = false;
};

/// A length in an organ, m.
CLI::Validator a_length() { return model::io::within(1e-6, 1.0); }

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
      ->check(model::io::within(1, 31));
  app.add_flag("--json", o.json, "print one JSON object, SI units");
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
    fmt::print("{}\n", model::io::text_of(out, 2));
    return;
  }
  fmt::print("{}: {} bytes, {} vertices, {} rings of {:.3g} mm, nu = {:.3g}\n", o.out, bytes,
             map.vertices(), map.rings, 1e3 * map.ring_pitch_m, map.poisson_ratio);
  fmt::print("body   {} nodes, {} elements of {:.3g} mm; patch radius {:.3g} mm\n", facts.nodes,
             facts.elements, 1e3 * facts.mesh_size_m, 1e3 * map.patch_radius_m);
  fmt::print("r E    {:.4g} least, {:.4g} median, {:.4g} most, 1/m\n", r.low, r.middle, r.high);
  fmt::print("took   {:.0f} s\n", seconds);
}

Result<int> run(const program::Program&, Options& o) {
  if (auto error = program::check_output(o.out, "TACTCOMP", {o.scene.path})) return *error;
  const auto scene = o.scene.load();
  if (!scene) return scene.error();
  auto input = condense::condense_input(*scene);
  if (!input) return input.error();
  input->settings.mesh_size_m = o.mesh_size_m;
  input->settings.patch_radius_m = o.patch_radius_m;
  if (o.ring_pitch_m > 0.0) input->settings.organ.ring_pitch_m = o.ring_pitch_m;
  if (o.rings > 0) input->settings.organ.rings = o.rings;
  const auto start = std::chrono::steady_clock::now();
  CondenseFacts facts;
  const auto map = condense::condense_organ(*input, facts);
  if (!map) return map.error();
  const auto bytes = model::scene::write_compliance_map(*map, o.out);
  if (!bytes) return bytes.error();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report(o, *map, facts, *bytes, took.count());
  return 0;
}

}  // namespace

void add_condense(program::Program& lab) {
  lab.add<Options>(
      "condense", "the organ's compliance at every vertex of its surface, by finite elements",
      R"(Solves the scene's organ under a small load at every vertex of its surface, and keeps how
much more it gives there than an endless block would. The compliance law then costs a
look-up a tick. Minutes of work, done once for a mesh. Needs gmsh: apt install gmsh. The
map holds r E (1/m): Young's modulus may change without a new map, Poisson's ratio, the
held box and the mesh may not.
Example: tact-lab condense mine.toml --out mine.compliance)",
      add_options, run);
}

}  // namespace tact::tools::lab
