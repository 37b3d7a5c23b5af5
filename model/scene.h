// scene.h - one TOML file says everything: organ, law, contact, tool, device, hand, limits.
//
// Every key carries its unit in its name. An unknown or missing key, a wrong unit or a value out of
// range is an error with file and line that says what is allowed. Set-up code only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/contact.h"
#include "model/device_settings.h"
#include "model/hand_path.h"
#include "model/law_settings.h"
#include "model/mesh.h"
#include "model/result.h"

namespace tact::model {

struct Limits {
  double force_N = 0.0;                  // vector magnitude
  double torque_Nm = 0.0;                // vector magnitude
  double slew_N_per_s = 0.0;             // largest change of the force vector
  double ramp_s = 0.0;                   // fade-in after arming
  double workspace_radius_m = 0.0;       // cylinder about the W x axis
  double workspace_half_length_m = 0.0;  // along the W x axis
  double speed_mps = 1.5;                // of the tool
  double turn_radps = 10.0;              // of the tool
  double energy_J = 0.1;                 // given to the hand beyond what was taken from it
  double recovery_W = 1e-4;              // of that budget
  double continuous_force_N = 20.0;      // largest RMS of the force; torque in proportion
  double thermal_time_s = 10.0;          // of that RMS
  double power_W = 20.0;                 // given to the hand
};

struct OrganSettings {
  std::string mesh_path;  // absolute
  Vec3 position_m;        // of the mesh origin
};

struct ToolSettings {
  std::string mesh_path;             // absolute
  std::vector<ProbeSphere> spheres;  // 1 to kMaxSpheres
  std::optional<Blade> blade;
};

struct Scene {
  std::string path;  // of the TOML file
  std::string name;
  double rate_Hz = 0.0;
  LawKind law = LawKind::kRhombus;
  std::vector<LawKind> described;  // laws that have a section
  RhombusChainParameters rhombus;
  DiscStackParameters disc_stack;
  HexSheetParameters hex_sheet;  // rings 0: as few as the tolerance allows
  SpringPatchParameters spring_patch;
  ComplianceSettings compliance;
  std::size_t table_knots = 65;
  bool varies_by_place = false;  // closed-form laws are scaled as [compliance] says
  std::optional<LinearPullParameters> pull;
  std::vector<PronyTerm> relaxation;
  std::optional<ElasticSettings> elastic;
  std::vector<ReferenceSite> reference_sites;
  std::optional<ToleranceSettings> tolerance;
  ContactParameters contact;
  OrganSettings organ;
  ToolSettings tool;
  DeviceSettings device;
  HandSettings hand;
  Limits limits;
  double frame_rate_Hz = 0.0;
  std::string hash;        // of text, overrides, meshes and a map that is felt, 16 hex digits
  SurfaceMesh organ_mesh;  // in W, m
  SurfaceMesh tool_mesh;   // tool frame, m

  /// Does the scene hold the numbers of this law?
  bool describes(LawKind kind) const;
};

/// Read a scene and its meshes. `overrides` are "key.path=value" as TOML writes values.
Result<Scene> load_scene(const std::string& path, const std::vector<std::string>& overrides);

/// Why this scene must not drive a device, if so: for programs that hold one.
std::optional<Error> check_drivable(const Scene& scene);

/// Every key with unit, range, default or "required", and meaning: a page for people.
std::string scene_reference();

}  // namespace tact::model
