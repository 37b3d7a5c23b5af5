// SPDX-License-Identifier: Apache-2.0
// scene.h - one TOML file says everything: organ, law, contact, tool, device, hand, limits.
//
// Every key carries its unit in its name. An unknown or missing key, a wrong unit or a value out of
// range is an error with file and line that says what is allowed. Set-up code only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/contact/blade.h"
#include "model/contact/contact_settings.h"
#include "model/device_settings.h"
#include "model/hand_path.h"
#include "model/limits.h"
#include "model/mesh/mesh.h"
#include "model/mesh/rgb.h"
#include "model/reader/scene_number.h"
#include "model/result.h"
#include "model/scene/law_settings.h"

namespace tact::model::scene {

struct OrganSettings {
  std::string mesh_path;  // absolute
  Vec3 position_m;        // of the mesh origin
};

struct ToolSettings {
  std::string mesh_path;                      // absolute
  std::vector<contact::ProbeSphere> spheres;  // 1 to kMaxSpheres
  std::optional<contact::Blade> blade;
};

inline constexpr std::size_t kMaxPieces = 4;  // of the organ, with a colour each

/// What the viewer paints. No force depends on it.
struct LookSettings {
  std::string organ = "tissue", tool = "steel";  // materials, as scene_keys.cc lists them
  std::vector<Vec3> piece_color_ratio;           // red, green, blue, times the material's
  bool has_vertex_colors = false;                // the organ has those of its mesh
  std::vector<mesh::Rgb> vertex_color;           // of each of its vertices, then
};

struct Scene {
  std::string path;  // of the TOML file
  std::string name;
  double rate_Hz = 0.0;
  LawKind law = LawKind::kRhombus;
  std::vector<LawKind> described;  // laws that have a section
  indent::RhombusChainParameters rhombus;
  double rhombus_area_m2 = 0.0;  // of the surface under one chain; 0: one chain under the whole tip
  indent::DiscStackParameters disc_stack;
  indent::HexSheetParameters hex_sheet;  // rings 0: as few as the tolerance allows
  indent::HuntCrossleyParameters hunt_crossley;
  springs::SpringPatchParameters spring_patch;
  ComplianceSettings compliance;
  std::size_t table_knots = 65;
  bool varies_by_place = false;  // by [compliance]: closed-form laws in series, anchors
  std::optional<law::LinearPullParameters> pull;
  std::vector<law::PronyTerm> relaxation;
  std::optional<ElasticSettings> elastic;
  std::vector<ReferenceSite> reference_sites;
  std::optional<ToleranceSettings> tolerance;
  contact::ContactParameters contact;
  bool grip_toggles = false;  // one press closes the jaws, the next opens them
  OrganSettings organ;
  ToolSettings tool;
  LookSettings look;
  DeviceSettings device;
  HandSettings hand;
  Vec3 hand_site_m;  // the point that the simulated hand touches, W
  Vec3 hand_inward;  // its way in, unit, W
  Limits limits;
  double frame_rate_Hz = 0.0;
  std::string hash;              // of text, overrides, meshes and a map that is felt, 16 hex digits
  mesh::SurfaceMesh organ_mesh;  // in W, m
  mesh::SurfaceMesh tool_mesh;   // tool frame, m
  std::string note;              // for people: what of the scene is not felt, and why; or empty

  /// Does the scene hold the numbers of this law?
  bool describes(LawKind kind) const;
};

/// Visits the keys of [device], which hal/registry knows.
using DeviceKeys = void (*)(reader::Keys& section, DeviceSettings& out);

/// Read a scene and its meshes. `overrides` are "key.path=value" as TOML writes values. A caller
/// that opens no device passes no keys: [device] is not looked at, and Scene::device is empty.
Result<Scene> load_scene(const std::string& path, const std::vector<std::string>& overrides,
                         DeviceKeys device_keys = nullptr);

/// The numbers of the law in use, with the keys, units and ranges of the scene's reader: what
/// a person may change, to feel it. What a law or a device can bear is asked where a run is opened.
/// `scene` was loaded with the same overrides.
Result<std::vector<reader::SceneNumber>> law_numbers(const Scene& scene,
                                                     const std::vector<std::string>& overrides);

/// Every key with unit, range, default or "required", and meaning: a page for people.
std::string scene_reference(DeviceKeys device_keys);

}  // namespace tact::model::scene
