// SPDX-License-Identifier: Apache-2.0
#include "firmware/protocol/run_header.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "model/io/one_line.h"

namespace tact {
namespace model {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Limits, force_N, torque_Nm, slew_N_per_s, ramp_s,
                                                workspace_radius_m, workspace_half_length_m,
                                                speed_mps, turn_radps, energy_J, recovery_W,
                                                continuous_force_N, thermal_time_s, power_W,
                                                grip_force_N)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(DeviceJoints, linkage, base_radius_m,
                                                platform_radius_m, upper_arm_m, forearm_m,
                                                azimuth_rad, row, origin_m)
}  // namespace model
namespace firmware::protocol {
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Sphere, radius_m, offset_m)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(Task, text, place_m, radius_m, by_grip, force_min_N,
                                                force_max_N, grip_min_ratio, grip_max_ratio, hold_s)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(
    RunHeader, scene_name, scene_hash, overrides, law_name, device_name, revision, host_name,
    began_utc, began_monotonic_ns, utc_max_error_us, utc_error_us, rate_Hz, frame_rate_Hz, limits,
    force_share, force_limit_N, torque_limit_Nm, continuous_force_N, energy_budget_J,
    limits_checksum, non_rt, simulated, cannot_grip, hand_socket, joints, organ_vertices,
    organ_triangles, tool_vertices, tool_triangles, spheres, profile_points, profile_pitch_m,
    organ_material, tool_material, piece_color_ratio, tasks)

nlohmann::json json_of(const RunHeader& header) { return header; }

model::Result<RunHeader> header_of(const nlohmann::json& json) {
  try {  // the library reports by exceptions; they end here
    return json.get<RunHeader>();
  } catch (const nlohmann::json::exception& wrong) {
    return model::Error{
        fmt::format("its head is invalid: {}", model::io::on_one_line(wrong.what()))};
  }
}

}  // namespace firmware::protocol
}  // namespace tact
