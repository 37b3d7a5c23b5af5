// SPDX-License-Identifier: Apache-2.0
// place.h - an organ from anywhere, under the tool of a scene.
//
//     p_W = R p + position,   R n = -inward,   position = site - R p
//
//     p, n     the chosen point of the mesh and its outward normal, the mesh's own frame, m
//     site     hand.site_m of the scene;  inward: hand.inward, unit
//
// Without a chosen point it is the top of the mesh as it lies, and R turns nothing.
#pragma once

#include <optional>
#include <string>

#include "model/mesh/mesh.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::tools::mesh {

/// To a tenth of a micrometre, without -0.
double rounded_m(double x_m);
/// As an array of TOML, each number so rounded.
std::string toml_of(const model::Vec3& v);

struct Placement {
  std::string mesh_path;  // absolute
  double unit_m = 0.001;
  model::Vec3 orientation_deg;  // axis times angle
  model::Vec3 position_m;
  model::Vec3 site_m;
};

struct PlaceOrder {
  std::string scene_path;
  std::string mesh_path;  // OBJ
  double unit_m = 0.001;
  std::optional<model::Vec3> point;  // in file units; the nearest vertex counts
};

/// The scene must load with this organ. `organ`: what the file holds, m.
model::Result<Placement> place(const PlaceOrder& order, const model::mesh::SurfaceMesh& organ);

/// The lines of a scene.
std::string toml_of(const Placement& placement);

/// The text of a scene with these values in [organ] and [hand]; all else stays.
model::Result<std::string> placed_in(const std::string& scene_text, const Placement& placement);

/// Writes them into the scene's file, which must load then; if not, the file is as it was.
std::optional<model::Error> write_placement(const std::string& scene_path,
                                            const Placement& placement);

}  // namespace tact::tools::mesh
