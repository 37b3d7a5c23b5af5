// SPDX-License-Identifier: Apache-2.0
// scene.h - one TOML file says everything: organ, law, contact, tool, device, hand, limits.
//
// Every key carries its unit in its name. An unknown or missing key, a wrong unit or a value out of
// range is an error with file and line that says what is allowed. Set-up code only.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/contact/blade.h"
#include "model/contact/contact_settings.h"
#include "model/device_settings.h"
#include "model/hand_path.h"
#include "model/law/linear_pull.h"
#include "model/law/relaxation.h"
#include "model/limits.h"
#include "model/mesh/mesh.h"
#include "model/mesh/rgb.h"
#include "model/parameters.h"
#include "model/reader/keys_fwd.h"
#include "model/result.h"
#include "model/scene/law_settings.h"
#include "model/scene/scene_tasks.h"

namespace tact::model::scene {

struct OrganSettings {
  std::string mesh_path;   // absolute
  Vec3 position_m;         // of the mesh origin
  bool is_turned = false;  // its normals point inwards in the file
};

struct ToolSettings {
  std::string mesh_path;                      // absolute
  std::vector<contact::ProbeSphere> spheres;  // 1 to kMaxSpheres
  std::optional<contact::Blade> blade;
};

inline constexpr Range kRate_Hz{100.0, 10000.0};
inline constexpr Range kYoungs_modulus_Pa{1.0, 1e9};
inline constexpr Range kPoisson_ratio{0.0, 0.495};
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
  std::string law = "rhombus";         // a name of laws.h, or kAutoLaw
  std::vector<std::string> described;  // laws that have a section
  SettingsByType laws;
  ComplianceSettings compliance;
  std::size_t table_knots = 65;
  bool varies_by_place = false;  // by [compliance]: closed-form laws in series, anchors
  bool exact_tip = false;        // the law is the organ below the tip of [elastic]
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
  Vec3 hand_site_m;  // the point at which the simulated hand presses, W
  Vec3 hand_inward;  // its way in, unit, W
  Limits limits;
  std::vector<Task> tasks;        // of an exercise, in order; no force depends on them
  std::vector<std::string> live;  // keys that may change on hardware while it runs (variant.h)
  double frame_rate_Hz = 0.0;
  std::string hash;              // of text, overrides, meshes and a map that is felt, 16 hex digits
  mesh::SurfaceMesh organ_mesh;  // in W, m
  mesh::SurfaceMesh tool_mesh;   // tool frame, m
  std::string note;              // for people: what of the scene is not felt, and why; or empty

  /// Does the scene hold the numbers of this law?
  bool describes(std::string_view law_name) const;
};

/// Visits the keys of [device], which hal/registry knows.
using DeviceKeys = void (*)(reader::Keys& section, DeviceSettings& out);

/// Read a scene and its meshes. `overrides` are "key.path=value" as TOML writes values. A caller
/// that opens no device passes no keys: [device] is not looked at, and Scene::device is empty.
Result<Scene> load_scene(const std::string& path, const std::vector<std::string>& overrides,
                         DeviceKeys device_keys = nullptr);

/// Every key with unit, range, default or "required", and meaning: a page for people.
std::string scene_reference(DeviceKeys device_keys);

}  // namespace tact::model::scene
