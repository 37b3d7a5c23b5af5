// SPDX-License-Identifier: Apache-2.0
// telemetry_record.h - the messages of tactd. host/ includes only this and recording_format.h.
//
// A local SOCK_SEQPACKET socket, send-only, with little-endian plain structs. Each message begins
// with a MessageHeader. The first is one Hello with a file descriptor attached (SCM_RIGHTS): a
// sealed memory file with the meshes. Then Frames follow at frame_rate_Hz. A client that does not
// read loses frames and delays nothing.
//
// Memory file: organ vertices (3 float each, W, m), organ triangles (3 uint32 each), the same for
// the tool mesh (tool frame, m), then, if the scene has them, the colours of the organ's vertices
// (3 uint8 each, sRGB). Units are in the names; vectors are x, y, z in frame W.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "firmware/loop/state.h"

namespace tact::firmware::telemetry {

inline constexpr std::uint32_t kTelemetryMagic = 0x74636174;  // "tact"
inline constexpr std::uint16_t kTelemetryVersion = 5;
inline constexpr std::size_t kMaxSites = 4;            // probe spheres on the tool
inline constexpr std::size_t kMaxRings = 32;           // profile points of one site
inline constexpr std::size_t kMaxPatchVertices = 180;  // in one frame
inline constexpr std::size_t kMaxCutsReported = 32;    // in one frame
inline constexpr std::size_t kMaxPieces = 4;           // pieces of the organ's mesh with a colour

enum class MessageKind : std::uint16_t { kHello = 1, kFrame = 2 };
// kInside: the sphere is inside the organ and gives no force until it has once been outside.
enum class SiteState : std::uint8_t { kFree = 0, kTouching = 1, kHeld = 2, kInside = 3 };

struct MessageHeader {
  std::uint32_t magic = kTelemetryMagic;
  std::uint16_t version = kTelemetryVersion;
  MessageKind kind = MessageKind::kFrame;
};

struct Hello {
  MessageHeader header{.kind = MessageKind::kHello};
  std::uint32_t organ_vertices = 0, organ_triangles = 0;
  std::uint32_t tool_vertices = 0, tool_triangles = 0;
  std::uint32_t site_count = 0;  // probe spheres in use
  std::uint32_t ring_count = 0;  // profile points in use, u_0 .. u_N
  float ring_pitch_m = 0.0f;     // profile point j is at radius j * pitch around the site
  float rate_Hz = 0.0f;
  float frame_rate_Hz = 0.0f;
  float force_limit_N = 0.0f;
  float continuous_force_N = 0.0f;
  float energy_budget_J = 0.0f;
  float sphere_radius_m[kMaxSites] = {};
  float sphere_offset_m[kMaxSites][3] = {};  // tool frame
  std::uint8_t non_rt = 0;                   // 1: no hard real time on this PC, force is capped
  std::uint8_t simulated = 0;                // 1: the device is simulated, the hand may be moved
  char scene_name[50] = {};
  std::uint16_t torque_limit_mNm = 0;  // in use, rounded up; 0: the device has no torque
  std::uint8_t cannot_grip = 0;        // 1: the scene grips, but the device cannot close the jaws
  char limits_checksum[9] = {};        // of the limits in use (model/io/limits_checksum.h)
  char device_name[64] = {};
  char law_name[64] = {};
  char hand_socket[108] = {};    // where a simulated device takes hand targets; empty for hardware
  char organ_material[12] = {};  // appearance: [look] of the scene
  char tool_material[12] = {};
  std::uint32_t piece_count = 0;                // connected pieces of the organ that have a colour
  float piece_color_ratio[kMaxPieces][3] = {};  // red, green, blue, times the material's
};

struct FrameSite {
  float surface_point_m[3] = {};    // touched or held point of the undeformed surface
  float normal[3] = {};             // outward unit normal there
  float shift_m[3] = {};            // tangential displacement of the tissue at the site
  float depth_m = 0.0f;             // press positive, pull negative
  float profile_m[kMaxRings] = {};  // normal displacement of ring j, into the tissue positive
  float tilt[3] = {};               // added to the profile at x: tilt . (x - surface point), m/m
  SiteState state = SiteState::kFree;
  std::uint8_t pad[3] = {};
};

/// Replaces the profiles of a mass-spring law: vertices that are displaced, and cut triangles. Each
/// frame reports a window of the list of cuts; the window advances from frame to frame.
struct FramePatch {
  std::uint32_t vertex_count = 0;                     // in use
  std::uint32_t cut_total = 0, cut_first = 0;         // length of the list; index of the first here
  std::uint32_t cut_count = 0;                        // in this frame
  std::uint32_t vertex[kMaxPatchVertices] = {};       // of the organ mesh
  std::uint32_t cut_triangle[kMaxCutsReported] = {};  // of the organ mesh
  std::int16_t displacement_um[kMaxPatchVertices][3] = {};  // from rest, W
};

struct Frame {
  MessageHeader header{.kind = MessageKind::kFrame};
  std::uint64_t tick = 0;
  std::int64_t time_ns = 0;  // since the loop started
  std::uint64_t late_ticks = 0, skipped_ticks = 0, dropped_records = 0;
  float tool_position_m[3] = {};
  float tool_orientation[4] = {1, 0, 0, 0};  // w, x, y, z; tool frame to W
  float tool_velocity_mps[3] = {};
  float grip_ratio = 0.0f;
  float force_N[3] = {};  // written to the device
  float torque_Nm[3] = {};
  float wanted_force_N[3] = {};  // of the law, before the gate
  float worst_margin_us = 0.0f;  // least time left before the deadline since the last frame
  float median_tick_us = 0.0f;   // of the ticks since the last frame
  float peak_force_N = 0.0f;     // largest |force| since the last frame
  float rms_force_N = 0.0f;      // written, over limits.thermal_time_s
  float given_energy_J = 0.0f;   // net energy given since arming: largest since the last frame
  std::uint16_t fault = 0;       // number in the fault table
  std::uint16_t limit = 0;       // last limit that acted since the last frame, 0 none
  loop::State state = loop::State::kOff;
  std::uint8_t non_rt = 0;           // set in every record of a PC without hard real time
  std::int16_t grip_force_mN = 0;    // written to the fingers, opening positive
  std::uint32_t contact_losses = 0;  // so far; 0 in recordings made before this field existed
  FrameSite site[kMaxSites] = {};
  FramePatch patch;
};

static_assert(std::is_trivially_copyable_v<Hello> && std::is_trivially_copyable_v<Frame>);
// No hidden padding: the CRC covers all bytes, and the value of padding is undefined.
static_assert(sizeof(FrameSite) == (13 + kMaxRings) * sizeof(float) + 4);
static_assert(sizeof(FramePatch) == 16 + kMaxPatchVertices * 10 + kMaxCutsReported * 4);
static_assert(sizeof(Frame) ==
              48 + 25 * sizeof(float) + 8 + 4 + kMaxSites * sizeof(FrameSite) + sizeof(FramePatch));
static_assert(sizeof(Frame) <= 4096);
static_assert(sizeof(Hello) == 122 + 50 + 2 + 1 + 9 + 64 + 64 + 108 + 24 + 4 + 48);

}  // namespace tact::firmware::telemetry
