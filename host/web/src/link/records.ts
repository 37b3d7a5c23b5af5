// SPDX-License-Identifier: Apache-2.0
// records.ts - made from the tables of firmware/protocol by firmware_protocol_test: change those, then
// TACT_WRITE_GENERATED=1 build/tests/firmware_protocol_test --gtest_filter='Generated.*'

export type Vec = [number, number, number];

/** What runs: run_header.h says what each field is. */
export interface Scene {
  began_monotonic_ns: number;
  began_utc: string;
  cannot_grip: boolean;
  continuous_force_N: number;
  device_name: string;
  energy_budget_J: number;
  force_limit_N: number;
  force_share: number;
  frame_rate_Hz: number;
  law_name: string;
  limits: {
    continuous_force_N: number;
    energy_J: number;
    force_N: number;
    grip_force_N: number;
    power_W: number;
    ramp_s: number;
    recovery_W: number;
    slew_N_per_s: number;
    speed_mps: number;
    thermal_time_s: number;
    torque_Nm: number;
    turn_radps: number;
    workspace_half_length_m: number;
    workspace_radius_m: number;
  };
  limits_checksum: string;
  non_rt: boolean;
  organ_material: string;
  organ_triangles: number;
  organ_vertices: number;
  piece_color_ratio: Vec[];
  profile_pitch_m: number;
  profile_points: number;
  rate_Hz: number;
  revision: string;
  scene_hash: string;
  scene_name: string;
  simulated: boolean;
  spheres: {
    offset_m: Vec;
    radius_m: number;
  }[];
  tasks: {
    by_grip: boolean;
    force_max_N: number;
    force_min_N: number;
    grip_max_ratio: number;
    grip_min_ratio: number;
    hold_s: number;
    place_m: Vec;
    radius_m: number;
    text: string;
  }[];
  tool_material: string;
  tool_triangles: number;
  tool_vertices: number;
  torque_limit_Nm: number;
  utc_error_us: number;
  utc_max_error_us: number;
}

export interface FrameFields {
  tick: number; // number of the newest tick
  time_ns: number; // since the loop started
  due_ns: number; // the deadline that woke it, CLOCK_MONOTONIC
  utc_offset_ns: number; // UTC since 1970 is due_ns plus this
  utc_max_error_us: number; // at most; 16 s: no time service
  utc_error_us: number; // as the time service estimates
  late_ticks: number; // count since start
  skipped_ticks: number; // count since start
  dropped_records: number; // count since start
  tool_position_m: Vec;
  tool_orientation: [number, number, number, number]; // unit quaternion, tool frame to W
  tool_velocity_mps: Vec;
  grip_ratio: number; // 0 open, 1 closed
  force_N: Vec; // written to the device
  torque_Nm: Vec; // written to the device
  wanted_force_N: Vec; // of the law, before the gate
  worst_margin_us: number; // least time left before a deadline since the last frame
  median_tick_us: number; // duration of the ticks since the last frame
  peak_force_N: number; // largest magnitude since the last frame
  rms_force_N: number; // written, over limits.thermal_time_s
  given_energy_J: number; // net energy given since arming; largest since the last frame
  grip_force_N: number; // written to the fingers, opening positive
  fault: number; // latched; number of tactd --faults, 0 none
  limit: number; // last one that acted since the last frame; number of tactd --faults, 0 none
  state: number;
  non_rt: boolean; // the PC has no hard real time, the force is capped
  contact_losses: number; // count since start: contact was lost as the tool moved too far between samples
  temperature_C: number; // of the hottest drive; NaN: no drive reports one
}

export interface ContactFields {
  surface_point_m: Vec; // contact point on the undeformed surface
  normal: Vec; // outward unit normal there
  shift_m: Vec; // tangential displacement of the tissue
  depth_m: number; // press positive, pull negative
  profile_m: number[]; // displacement into the tissue at radius j profile_pitch_m; profile_points are in use
  tilt: Vec; // m/m; added to the profile at x: tilt . (x - surface_point_m)
  state: number; // inside: no force until it has once been outside
}
