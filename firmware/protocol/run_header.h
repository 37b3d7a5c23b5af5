// SPDX-License-Identifier: Apache-2.0
// run_header.h - what runs: the JSON at the start of the telemetry and of every file. The page gets
// the same (GET /scene.json).
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "model/device_joints.h"
#include "model/limits.h"
#include "model/result.h"

namespace tact::firmware::protocol {

struct Sphere {
  double radius_m = 0.0;
  std::array<double, 3> offset_m{};  // tool frame
};

/// One of an exercise (model/scene/scene_tasks.h).
struct Task {
  std::string text;
  std::array<double, 3> place_m{};
  double radius_m = 0.0;
  bool by_grip = false;  // the range of the grip ends it, else that of the force
  double force_min_N = 0.0, force_max_N = 0.0;
  double grip_min_ratio = 0.0, grip_max_ratio = 0.0;
  double hold_s = 0.0;
};

inline constexpr std::size_t kMaxTasks = 16;

/// Vectors are in frame W. run_header.cc lists the names again, for JSON.
struct RunHeader {
  std::string scene_name, scene_hash;
  std::vector<std::string> overrides;  // --set KEY=VALUE of the run, its law included
  std::string law_name, device_name;
  std::string revision, host_name;                   // of tactd
  std::string began_utc;                             // 2026-01-31T12:00:00.123456789Z
  std::int64_t began_monotonic_ns{};                 // the same moment by CLOCK_MONOTONIC
  std::uint32_t utc_max_error_us{}, utc_error_us{};  // then (record_parts.h)
  double rate_Hz = 0.0;
  double frame_rate_Hz = 0.0;
  model::Limits limits{};        // of scene and device together
  double force_share = 1.0;      // factor on limits; below 1 without hard real time
  double force_limit_N = 0.0;    // effective: force_share * limits.force_N; so the next three
  double torque_limit_Nm = 0.0;  // 0: the device has no torque
  double continuous_force_N = 0.0;
  double energy_budget_J = 0.0;
  std::string limits_checksum;  // of the limits in use (model/io/limits_checksum.h)
  bool non_rt = false;          // no hard real time on this PC, the force is capped
  bool simulated = false;       // the device is simulated, the hand may be moved
  bool cannot_grip = false;     // the scene grips, but the device cannot close the jaws
  std::string hand_socket;      // where a simulated device takes hand targets; empty for hardware
  model::DeviceJoints joints;   // of the device, with its mounting
  std::uint32_t organ_vertices = 0, organ_triangles = 0;
  std::uint32_t tool_vertices = 0, tool_triangles = 0;
  std::vector<Sphere> spheres;       // probe spheres of the tool
  std::uint32_t profile_points = 0;  // profile points in use, u_0 .. u_N
  double profile_pitch_m = 0.0;  // profile point j is at radius j * pitch around the contact point
  std::string organ_material, tool_material;  // appearance: [look] of the scene
  std::vector<std::array<float, 3>>
      piece_color_ratio;    // connected pieces of the organ with a colour:
                            // red, green, blue, times the material's
  std::vector<Task> tasks;  // what the viewer asks a person to do, in order
};

nlohmann::json json_of(const RunHeader& header);
/// A missing key keeps its default; an error if one has another type.
model::Result<RunHeader> header_of(const nlohmann::json& json);

}  // namespace tact::firmware::protocol
