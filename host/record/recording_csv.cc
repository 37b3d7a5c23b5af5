// SPDX-License-Identifier: Apache-2.0
#include "host/record/recording_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "firmware/protocol/record_text.h"
#include "host/record/operator_record.h"
#include "host/tracking/tracking_setup.h"

namespace tact::host::record {
namespace {

/// What of a frame has columns: spheres and profile points in use; of a patch the sums below; of
/// events and histograms nothing.
firmware::protocol::ElementLimit columns_of(const RunHeader& header) {
  return [&header](const firmware::protocol::Field& field) -> std::optional<std::size_t> {
    const std::string_view name = field.name;
    if (name == "contact") return header.spheres.size();
    if (name == "profile_m") return header.profile_points;
    return field.record != nullptr ? std::optional<std::size_t>(0) : std::nullopt;
  };
}

/// Number of cuts so far, of displaced vertices, and their largest displacement.
void put_patch(std::string& out, const firmware::protocol::FramePatch& patch) {
  const auto n = std::min<std::size_t>(patch.vertex_count, firmware::protocol::kMaxPatchVertices);
  double most_um = 0.0;
  for (const auto& [x, y, z] : std::span(patch.displacement_um).first(n))
    most_um = std::max(most_um, std::hypot(x, y, z));
  fmt::format_to(std::back_inserter(out), ",{},{},{:.6f}", patch.cut_total, n, 1e-6 * most_um);
}

void put_body(std::string& out, const tracking::TrackedBody& body) {
  const Eigen::Quaterniond& q = body.raw.rotation;
  const Eigen::Vector3d& p = body.raw.position_m;
  fmt::format_to(std::back_inserter(out), ",{},{},{},{},{},{},{},{},{},{}",
                 body_state(static_cast<std::uint64_t>(body.state)), p.x(), p.y(), p.z(), q.w(),
                 q.x(), q.y(), q.z(), body.rms_px, body.age_s);
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

std::string csv_facts(const RunHeader& header) {
  return firmware::protocol::csv_facts("tact frames", header) +
         "# row: the newest tick of each frame; margin, median and peak are over all ticks since "
         "the "
         "row before. Every tick: tactd --record LOG, then tactd --replay LOG --csv FILE\n";
}

std::string csv_header(const RunHeader& header, const std::vector<tracking::BodyRole>& bodies) {
  std::string out = firmware::protocol::csv_columns(Frame::fields(), columns_of(header)) +
                    ",cut_triangles,patch_vertices,patch_most_m";
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

void append_csv_row(std::string& out, const Frame& frame, const RunHeader& header,
                    const tracking::TrackedOperator* tracked,
                    const std::vector<tracking::BodyRole>& bodies) {
  firmware::protocol::append_csv(out, Frame::fields(), &frame, columns_of(header));
  put_patch(out, frame.patch);
  // Without an operator the columns are still written: all rows have the same length.
  const tracking::TrackedOperator none;
  for (const tracking::BodyRole role : bodies)
    put_body(out, (tracked != nullptr ? *tracked : none)[role]);
  out += '\n';
}

}  // namespace tact::host::record
