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
#include <utility>
#include <vector>

#include "model/mesh/mesh.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::tools::mesh {

/// To a tenth of a micrometre, without -0.
double rounded_m(double x_m);
/// As an array of TOML, each number so rounded.
std::string toml_of(const model::Vec3& v);

/// What in a scene was made for the organ that it had before, and no longer fits. It was measured,
/// by hand or by minutes of finite elements, and is left to the user.
struct Misfit {
  std::string keys;  // of the scene
  std::string text;  // why they do not fit, and what to write or run
};

struct Placement {
  std::string mesh_path;  // absolute
  double unit_m = 0.001;
  model::Vec3 orientation_deg;  // axis times angle
  model::Vec3 position_m;
  model::Vec3 site_m;
  std::vector<Misfit> misfits;  // of the scene's other keys
};

struct PlaceOrder {
  std::string scene_path;
  std::string mesh_path;  // OBJ
  double unit_m = 0.001;
  std::optional<model::Vec3> point;  // in file units; the nearest vertex counts
};

/// The scene must load with this organ, and the point be near it. `organ`: what the file holds, m.
model::Result<Placement> place(const PlaceOrder& order, const model::mesh::SurfaceMesh& organ);

using KeyValue = std::pair<std::string, std::string>;

/// What a scene says of it in [organ] and [hand], as TOML writes values.
std::vector<KeyValue> organ_keys(const Placement& placement);
std::vector<KeyValue> hand_keys(const Placement& placement);
/// The same as lines of a scene.
std::string toml_of(const Placement& placement);

}  // namespace tact::tools::mesh
