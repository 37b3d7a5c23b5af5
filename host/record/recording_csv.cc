// SPDX-License-Identifier: Apache-2.0
#include "host/record/recording_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <span>

#include "host/tracking/tracking_setup.h"
#include "model/io/one_line.h"

namespace tact::host::record {
namespace {

constexpr std::array kSiteNames{"free", "touching", "held", "inside"};
constexpr std::array kBodyNames{"absent", "tracked", "held", "lost"};

/// Of a state from a file or socket, which may be none.
template <typename State>
const char* name_of(State state, const std::array<const char*, 4>& names) {
  const auto at = static_cast<std::size_t>(state);
  return at < names.size() ? names[at] : "unknown";
}

/// Bounds the count again, so that the array access does not rely on an earlier check.
std::size_t sites_of(const Hello& hello) {
  return std::min<std::size_t>(hello.site_count, firmware::telemetry::kMaxSites);
}
std::size_t rings_of(const Hello& hello) {
  return std::min<std::size_t>(hello.ring_count, firmware::telemetry::kMaxRings);
}

void put(std::string& out, std::span<const float> values) {
  // The shortest decimals that read back to the same float.
  for (const float value : values) fmt::format_to(std::back_inserter(out), ",{}", value);
}
void put(std::string& out, float value) { put(out, std::span(&value, 1)); }

/// Number of cuts so far, of displaced vertices, and their largest displacement.
void put_patch(std::string& out, const firmware::telemetry::FramePatch& patch) {
  const auto n = std::min<std::size_t>(patch.vertex_count, firmware::telemetry::kMaxPatchVertices);
  double most_um = 0.0;
  for (const auto& [x, y, z] : std::span(patch.displacement_um).first(n))
    most_um = std::max(most_um, std::hypot(x, y, z));
  fmt::format_to(std::back_inserter(out), ",{},{},{:.6f}", patch.cut_total, n, 1e-6 * most_um);
}

void put_body(std::string& out, const tracking::TrackedBody& body) {
  const Eigen::Quaterniond& q = body.raw.rotation;
  const Eigen::Vector3d& p = body.raw.position_m;
  fmt::format_to(std::back_inserter(out), ",{},{},{},{},{},{},{},{},{},{}",
                 name_of(body.state, kBodyNames), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(),
                 body.rms_px, body.age_s);
}

/// Collects which bodies appear.
class Present {
 public:
  void add(const tracking::TrackedOperator& person) {
    for (std::size_t i = 0; i < tracking::kBodyRoles; ++i)
      if (person.bodies[i].state != tracking::BodyState::kAbsent) is_present_[i] = true;
  }
  std::vector<tracking::BodyRole> roles() const {
    std::vector<tracking::BodyRole> out;
    for (std::size_t i = 0; i < tracking::kBodyRoles; ++i)
      if (is_present_[i]) out.push_back(static_cast<tracking::BodyRole>(i));
    return out;
  }

 private:
  std::array<bool, tracking::kBodyRoles> is_present_{};
};

}  // namespace

std::string csv_facts(const Hello& hello) {
  const auto text_of = [](const auto& field) {
    return model::io::on_one_line({field, strnlen(field, sizeof field)});
  };
  return fmt::format(
      "# tact frames\n# scene: {}\n# law: {}\n# device: {}\n# rate_Hz: {:.10g}\n"
      "# frame_rate_Hz: {:.10g}\n"
      "# row: the newest tick of each frame; margin, tick_us and peak are over all ticks since the "
      "row before. Every tick: tactd --record LOG, then tactd --replay LOG --csv FILE\n",
      text_of(hello.scene_name), text_of(hello.law_name), text_of(hello.device_name), hello.rate_Hz,
      hello.frame_rate_Hz);
}

std::string csv_header(const Hello& hello, const std::vector<tracking::BodyRole>& bodies) {
  std::string out =
      "tick,time_s,non_rt,state,fault,limit,late_ticks,skipped_ticks,dropped_records,"
      "tool_x_m,tool_y_m,tool_z_m,tool_qw,tool_qx,tool_qy,tool_qz,"
      "tool_vx_mps,tool_vy_mps,tool_vz_mps,grip_ratio,force_x_N,force_y_N,force_z_N,"
      "torque_x_Nm,torque_y_Nm,torque_z_Nm,wanted_x_N,wanted_y_N,wanted_z_N,"
      "worst_margin_us,median_tick_us,peak_force_N,rms_force_N,given_energy_J,grip_force_N,"
      "contact_losses,cut_triangles,patch_vertices,patch_most_m";
  // Sites count from 1; rings from 0, which is the contact point itself.
  for (std::size_t i = 1; i <= sites_of(hello); ++i) {
    fmt::format_to(std::back_inserter(out),
                   ",site{0}_state,site{0}_x_m,site{0}_y_m,site{0}_z_m,site{0}_normal_x,"
                   "site{0}_normal_y,site{0}_normal_z,site{0}_shift_x_m,site{0}_shift_y_m,"
                   "site{0}_shift_z_m,site{0}_depth_m",
                   i);
    for (std::size_t j = 0; j < rings_of(hello); ++j)
      fmt::format_to(std::back_inserter(out), ",site{}_u{}_m", i, j);
    fmt::format_to(std::back_inserter(out), ",site{0}_tilt_x,site{0}_tilt_y,site{0}_tilt_z", i);
  }
  for (const tracking::BodyRole role : bodies) {
    fmt::format_to(std::back_inserter(out),
                   ",{0}_state,{0}_x_m,{0}_y_m,{0}_z_m,{0}_qw,{0}_qx,{0}_qy,{0}_qz,{0}_rms_px,"
                   "{0}_age_s",
                   name_of(role));
  }
  out += '\n';
  return out;
}

std::vector<tracking::BodyRole> bodies_in(const Recording& recording) {
  Present present;
  for (const tracking::TrackedOperator& person : recording.operators) present.add(person);
  return present.roles();
}

std::vector<tracking::BodyRole> bodies_in(const Snapshot& snapshot) {
  Present present;
  for (const auto& kept : snapshot.frames)
    if (kept->person) present.add(kept->person->tracked);
  return present.roles();
}

void append_csv_row(std::string& out, const Frame& frame, const Hello& hello,
                    const tracking::TrackedOperator* tracked,
                    const std::vector<tracking::BodyRole>& bodies) {
  fmt::format_to(std::back_inserter(out), "{},{:.9f},{},{},{},{},{},{},{}", frame.tick,
                 static_cast<double>(frame.time_ns) * 1e-9, frame.non_rt, name_of(frame.state),
                 frame.fault, frame.limit, frame.late_ticks, frame.skipped_ticks,
                 frame.dropped_records);
  put(out, frame.tool_position_m);
  put(out, frame.tool_orientation);
  put(out, frame.tool_velocity_mps);
  put(out, frame.grip_ratio);
  put(out, frame.force_N);
  put(out, frame.torque_Nm);
  put(out, frame.wanted_force_N);
  put(out, frame.worst_margin_us);
  put(out, frame.median_tick_us);
  put(out, frame.peak_force_N);
  put(out, frame.rms_force_N);
  put(out, frame.given_energy_J);
  put(out, 1e-3f * static_cast<float>(frame.grip_force_mN));
  fmt::format_to(std::back_inserter(out), ",{}", frame.contact_losses);
  put_patch(out, frame.patch);
  for (std::size_t i = 0; i < sites_of(hello); ++i) {
    const firmware::telemetry::FrameSite& site = frame.site[i];
    out += ',';
    out += name_of(site.state, kSiteNames);
    put(out, site.surface_point_m);
    put(out, site.normal);
    put(out, site.shift_m);
    put(out, site.depth_m);
    put(out, std::span(site.profile_m).first(rings_of(hello)));
    put(out, site.tilt);
  }
  // Without an operator the columns are still written: all rows have the same length.
  const tracking::TrackedOperator none;
  for (const tracking::BodyRole role : bodies)
    put_body(out, (tracked != nullptr ? *tracked : none)[role]);
  out += '\n';
}

}  // namespace tact::host::record
