// SPDX-License-Identifier: Apache-2.0
// tact-lab condense: the compliance of the scene's organ at every vertex, once and for all. Its
// options and its scene; tools/condense/condense.py does the work.
#include <CLI/CLI.hpp>

#include "model/io/program/within.h"
#include "model/scene/compliance_file.h"
#include "tools/lab/commands.h"
#include "tools/lab/script.h"

namespace tact::tools::lab {
namespace {

using model::Result;

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

Result<int> run(const program::Program&, Options& o) {
  if (auto error = program::check_output(o.out, "TACTCOMP", {o.scene.path})) return *error;
  const auto scene = elastic_scene(o.scene);
  if (!scene) return scene.error();
  const model::scene::ElasticSettings& elastic = *scene->elastic;
  nlohmann::json lumps = nlohmann::json::array();
  for (const model::scene::Inclusion& lump : elastic.inclusions)
    lumps.push_back({{"center_m", list_of(lump.center_m)},
                     {"radius_m", lump.radius_m},
                     {"modulus_ratio", lump.youngs_modulus_Pa / elastic.youngs_modulus_Pa}});
  return become("condense/condense.py",
                {{"organ", organ_of(*scene)},
                 {"lumps", std::move(lumps)},
                 {"inclusions_hash", inclusions_hash(elastic)},
                 {"surface_hash", model::scene::surface_hash(scene->organ_mesh.view())},
                 {"out", o.out},
                 {"mesh_size_m", o.mesh_size_m},
                 {"patch_radius_m", o.patch_radius_m},
                 {"ring_pitch_m", o.ring_pitch_m},
                 {"rings", o.rings},
                 {"json", o.json}});
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
