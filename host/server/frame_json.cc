// SPDX-License-Identifier: Apache-2.0
#include "host/server/frame_json.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "model/io/json.h"

namespace tact::host::server {
namespace {

// Finer than the resolution of view and plots; the tool's position is exact to 1 um at 1 m.
constexpr int kDigits = 4;
constexpr int kPositionDigits = 6;

void put(std::string& out, float value, int digits) {
  if (std::isfinite(value))
    fmt::format_to(std::back_inserter(out), "{:.{}g}", value, digits);
  else
    out += "null";
}

void put(std::string& out, const char* key, float value) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":", key);
  put(out, value, kDigits);
}

void put(std::string& out, const char* key, std::span<const float> values, int digits = kDigits) {
  fmt::format_to(std::back_inserter(out), ",\"{}\":[", key);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) out += ',';
    put(out, values[i], digits);
  }
  out += ']';
}

void put_site(std::string& out, std::size_t index, const firmware::telemetry::FrameSite& site,
              std::size_t rings) {
  fmt::format_to(std::back_inserter(out), "{{\"site\":{},\"state\":{}", index,
                 static_cast<int>(site.state));
  put(out, "point_m", site.surface_point_m);
  put(out, "normal", site.normal);
  put(out, "shift_m", site.shift_m);
  put(out, "depth_m", site.depth_m);
  put(out, "u_m", std::span(site.profile_m).first(rings));
  put(out, "tilt", site.tilt);
  out += '}';
}

/// RFC 4648, with padding.
void put_base64(std::string& out, std::span<const std::uint8_t> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP_EncodeBlock appends a zero
  text.resize(
      static_cast<std::size_t>(EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                               bytes.data(), static_cast<int>(bytes.size()))));
  out += text;
}

void put_patch(std::string& out, const firmware::telemetry::FramePatch& patch) {
  const std::size_t n =
      std::min<std::size_t>(patch.vertex_count, firmware::telemetry::kMaxPatchVertices);
  const std::size_t cuts =
      std::min<std::size_t>(patch.cut_count, firmware::telemetry::kMaxCutsReported);
  std::vector<std::uint8_t> bytes(n * (sizeof patch.vertex[0] + sizeof patch.displacement_um[0]));
  const std::size_t vertex_bytes = n * sizeof patch.vertex[0];
  if (n > 0) {  // memcpy must not get the null address of an empty vector
    std::memcpy(bytes.data(), patch.vertex, vertex_bytes);
    std::memcpy(bytes.data() + vertex_bytes, patch.displacement_um, bytes.size() - vertex_bytes);
  }
  fmt::format_to(std::back_inserter(out), ",\"patch\":{{\"count\":{},\"moved\":\"", n);
  put_base64(out, bytes);
  fmt::format_to(std::back_inserter(out), "\",\"cut_total\":{},\"cut\":[{}]}}", patch.cut_total,
                 fmt::join(patch.cut_triangle, patch.cut_triangle + cuts, ","));
}

}  // namespace

std::string frame_json(const record::Frame& frame, const record::Hello& hello) {
  std::string out;
  out.reserve(kMaxFrameJsonBytes);
  fmt::format_to(std::back_inserter(out),
                 "{{\"kind\":\"frame\",\"tick\":{},\"time_s\":{:.4f},\"state\":{},\"fault\":{},"
                 "\"limit\":{},\"late\":{},\"skipped\":{},\"dropped\":{},\"contact_losses\":{}",
                 frame.tick, static_cast<double>(frame.time_ns) * 1e-9,
                 static_cast<int>(frame.state), frame.fault, frame.limit, frame.late_ticks,
                 frame.skipped_ticks, frame.dropped_records, frame.contact_losses);
  put(out, "tool_m", frame.tool_position_m, kPositionDigits);
  put(out, "turn", frame.tool_orientation, kPositionDigits);
  put(out, "velocity_mps", frame.tool_velocity_mps);
  put(out, "grip_ratio", frame.grip_ratio);
  put(out, "force_N", frame.force_N);
  put(out, "torque_Nm", frame.torque_Nm);
  put(out, "wanted_N", frame.wanted_force_N);
  put(out, "margin_us", frame.worst_margin_us);
  put(out, "tick_us", frame.median_tick_us);
  put(out, "peak_N", frame.peak_force_N);
  put(out, "rms_N", frame.rms_force_N);
  put(out, "given_J", frame.given_energy_J);
  put(out, "grip_N", 1e-3f * static_cast<float>(frame.grip_force_mN));
  out += ",\"sites\":[";
  const std::size_t sites = std::min<std::size_t>(hello.site_count, firmware::telemetry::kMaxSites);
  const std::size_t rings = std::min<std::size_t>(hello.ring_count, firmware::telemetry::kMaxRings);
  bool first = true;
  for (std::size_t i = 0; i < sites; ++i) {
    // Free sites are omitted to keep the frame short (kMaxFrameJsonBytes).
    if (frame.site[i].state == firmware::telemetry::SiteState::kFree) continue;
    if (!first) out += ',';
    first = false;
    put_site(out, i, frame.site[i], rings);
  }
  out += ']';
  // A law has profiles or a patch, never both.
  if (rings == 0) put_patch(out, frame.patch);
  out += '}';
  return out;
}

std::string scene_json(const record::Hello& hello) {
  nlohmann::json spheres = nlohmann::json::array();
  const std::size_t sites = std::min<std::size_t>(hello.site_count, firmware::telemetry::kMaxSites);
  for (std::size_t i = 0; i < sites; ++i) {
    spheres.push_back(
        {{"radius_m", hello.sphere_radius_m[i]}, {"offset_m", hello.sphere_offset_m[i]}});
  }
  nlohmann::json pieces = nlohmann::json::array();
  for (std::size_t i = 0;
       i < std::min<std::size_t>(hello.piece_count, firmware::telemetry::kMaxPieces); ++i)
    pieces.push_back(hello.piece_color_ratio[i]);
  const nlohmann::json scene{
      {"scene", record::text_of(hello.scene_name)},
      {"device", record::text_of(hello.device_name)},
      {"law", record::text_of(hello.law_name)},
      {"organ", {{"vertices", hello.organ_vertices}, {"triangles", hello.organ_triangles}}},
      {"tool", {{"vertices", hello.tool_vertices}, {"triangles", hello.tool_triangles}}},
      {"ring_count", hello.ring_count},
      {"ring_pitch_m", hello.ring_pitch_m},
      {"rate_Hz", hello.rate_Hz},
      {"frame_rate_Hz", hello.frame_rate_Hz},
      {"force_limit_N", hello.force_limit_N},
      {"torque_limit_Nm", 1e-3 * hello.torque_limit_mNm},
      {"continuous_force_N", hello.continuous_force_N},
      {"energy_budget_J", hello.energy_budget_J},
      {"limits_checksum", record::text_of(hello.limits_checksum)},
      {"non_rt", hello.non_rt != 0},
      {"simulated", hello.simulated != 0},
      {"cannot_grip", hello.cannot_grip != 0},
      {"spheres", spheres},
      {"look",
       {{"organ", record::text_of(hello.organ_material)},
        {"tool", record::text_of(hello.tool_material)},
        {"pieces", pieces}}},
  };
  // Repairs a name with broken UTF-8 instead of throwing.
  return model::io::text_of(scene);
}

}  // namespace tact::host::server
