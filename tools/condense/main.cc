// tact-condense: how much the scene's organ gives at every place of its surface, once and for all.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "model/compliance_file.h"
#include "model/scene.h"
#include "tools/common/interrupt.h"
#include "tools/condense/condense_organ.h"

namespace {

using tact::model::ComplianceMap;
using tact::model::Vec3;
using tact::tools::CondenseFacts;
using tact::tools::CondenseInput;

struct Options {
  std::string scene, out;
  std::vector<std::string> overrides;
  double mesh_size_m = 0.0, patch_radius_m = 0.0;
  double ring_pitch_m = 0.0;
  std::size_t rings = 0;
  bool json = false;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("SCENE", o.scene, "scene file (TOML) with [elastic]")->required();
  app.add_option("--out", o.out, "compliance map to write")->required();
  app.add_option("--set", o.overrides, "one key of the scene, as KEY=VALUE; repeatable");
  app.add_option("--mesh-size-m", o.mesh_size_m,
                 "edge of an element inside the organ, m (default: 1.5 median edges of its "
                 "surface); half as long is about 20 times the work")
      ->check(CLI::PositiveNumber);
  app.add_option("--patch-radius-m", o.patch_radius_m,
                 "a0 of the loaded patch, m (default: 1.6 elements); the result hardly depends on "
                 "it")
      ->check(CLI::PositiveNumber);
  app.add_option("--ring-pitch-m", o.ring_pitch_m, "of the shape around a place, m (default 0.002)")
      ->check(CLI::PositiveNumber);
  app.add_option("--rings", o.rings, "of the shape, 1 to 31 (default 20)")
      ->check(CLI::Range(1, 31));
  app.add_flag("--json", o.json, "print one JSON object, SI units");
  app.footer(
      "Needs gmsh: apt install gmsh. The map holds r E (1/m): Young's modulus may change without "
      "a new map,\nPoisson's ratio, the held box and the mesh may not.\n"
      "Exit status: 0 written, 1 Ctrl-C, 2 bad usage or input.");
  app.failure_message([](const CLI::App*, const CLI::Error& e) {
    return fmt::format("tact-condense: {}; see tact-condense --help\n", e.what());
  });
}

int fail(const std::string& sentence) {
  const bool interrupted = tact::tools::is_interrupted();
  fmt::print(stderr, "tact-condense: {}\n",
             interrupted ? "interrupted; nothing was written" : sentence);
  return interrupted ? 1 : 2;
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
  return !tact::tools::is_interrupted();
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
    fmt::print("{}\n", out.dump(2));
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

// The libraries throw when memory or standard output is gone; then the program may as well end.
int main(int argc, char** argv) {
  CLI::App app{
      "Condense the scene's organ: solve it by finite elements under a small load at every vertex\n"
      "of its surface, and keep how much more it gives there than an endless block would. The\n"
      "compliance law then costs a look-up a tick. Minutes of work, done once for a mesh."};
  Options o;
  add_options(app, o);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  const tact::tools::InterruptWatch watch;
  const auto scene = tact::model::load_scene(o.scene, o.overrides);
  if (!scene) return fail(scene.error().sentence);
  auto input = tact::tools::condense_input(*scene);
  if (!input) return fail(input.error().sentence);
  input->settings.mesh_size_m = o.mesh_size_m;
  input->settings.patch_radius_m = o.patch_radius_m;
  if (o.ring_pitch_m > 0.0) input->settings.organ.ring_pitch_m = o.ring_pitch_m;
  if (o.rings > 0) input->settings.organ.rings = o.rings;
  input->settings.organ.progress = show_progress;
  const auto start = std::chrono::steady_clock::now();
  CondenseFacts facts;
  const auto map = tact::tools::condense_organ(*input, facts);
  if (!map) return fail(map.error().sentence);
  const auto bytes = write_compliance_map(*map, o.out);
  if (!bytes) return fail(bytes.error().sentence);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  report(o, *map, facts, *bytes, took.count());
  return 0;
}
