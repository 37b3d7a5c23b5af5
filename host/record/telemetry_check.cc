// SPDX-License-Identifier: Apache-2.0
#include "host/record/telemetry_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tact::host::record {
namespace {

using model::Error;

constexpr std::uint64_t kTripleBytes = 12;  // 3 floats or 3 uint32
constexpr std::uint64_t kColorBytes = 3;    // red, green, blue
// Chosen: far beyond an organ; limits one mesh to 48 MB.
constexpr std::uint32_t kMaxElements = 4'000'000;  // vertices or triangles of one mesh

std::uint64_t mesh_size(const RunHeader& header) {
  // In 64 bits: the sum of four untrusted 32-bit counts may overflow 32 bits.
  const std::uint64_t triples = std::uint64_t{header.organ_vertices} + header.organ_triangles +
                                header.tool_vertices + header.tool_triangles;
  return triples * kTripleBytes;
}

std::optional<Error> check_part(std::span<const std::byte> part, std::uint32_t vertices,
                                const char* name) {
  const std::size_t triangle_start = vertices * kTripleBytes;
  for (std::size_t at = 0; at < triangle_start; at += sizeof(float)) {
    float value_m = 0.0f;
    // Copied, because the bytes of a file or socket may be unaligned.
    std::memcpy(&value_m, &part[at], sizeof value_m);
    if (!std::isfinite(value_m))
      return Error{fmt::format("vertex {} of the {} mesh is not finite", at / kTripleBytes, name)};
  }
  for (std::size_t at = triangle_start; at < part.size(); at += sizeof(std::uint32_t)) {
    std::uint32_t vertex = 0;
    std::memcpy(&vertex, &part[at], sizeof vertex);
    if (vertex >= vertices) {
      return Error{fmt::format("triangle {} of the {} mesh names vertex {} of {}",
                               (at - triangle_start) / kTripleBytes, name, vertex, vertices)};
    }
  }
  return std::nullopt;
}

std::optional<Error> check_patch(const firmware::protocol::FramePatch& patch,
                                 const RunHeader& header) {
  if (patch.vertex_count > firmware::protocol::kMaxPatchVertices ||
      patch.cut_count > firmware::protocol::kMaxCutsReported) {
    return Error{"a frame holds more displaced vertices or cuts than fit"};
  }
  // The page uses these numbers as indices into its mesh.
  if (patch.cut_total > header.organ_triangles || patch.cut_count > patch.cut_total)
    return Error{"a frame holds more cuts than the organ has triangles"};
  const auto names_only = [](std::span<const std::uint32_t> ids, std::uint32_t below) {
    return std::all_of(ids.begin(), ids.end(), [below](std::uint32_t id) { return id < below; });
  };
  if (!names_only(std::span(patch.vertex).first(patch.vertex_count), header.organ_vertices) ||
      !names_only(std::span(patch.cut_triangle).first(patch.cut_count), header.organ_triangles)) {
    return Error{"a frame names a vertex or triangle that the organ does not have"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check_header(const RunHeader& header) {
  for (const std::uint32_t count : {header.organ_vertices, header.organ_triangles,
                                    header.tool_vertices, header.tool_triangles}) {
    if (count > kMaxElements) return Error{"a mesh is larger than 4 million elements"};
  }
  if (header.spheres.size() > firmware::protocol::kMaxContacts)
    return Error{"there are more probe spheres than fit"};
  if (header.profile_points > firmware::protocol::kMaxProfilePoints)
    return Error{"there are more profile rings than fit"};
  if (header.piece_color_ratio.size() > firmware::protocol::kMaxPieces)
    return Error{"there are more coloured pieces than fit"};
  for (const auto& color : header.piece_color_ratio)
    for (const float ratio : color)
      if (!std::isfinite(ratio) || ratio < 0.0f) return Error{"a colour is not sensible"};
  if (header.tasks.size() > firmware::protocol::kMaxTasks)
    return Error{"there are more tasks than fit"};
  for (const firmware::protocol::Task& task : header.tasks)
    for (const double value :
         {task.place_m[0], task.place_m[1], task.place_m[2], task.radius_m, task.force_min_N,
          task.force_max_N, task.grip_min_ratio, task.grip_max_ratio, task.hold_s})
      if (!std::isfinite(value)) return Error{"a task is not sensible"};
  for (const double value :
       {header.profile_pitch_m, header.rate_Hz, header.frame_rate_Hz, header.force_limit_N,
        header.continuous_force_N, header.energy_budget_J}) {
    if (!std::isfinite(value) || value < 0.0) return Error{"a number of the scene is not sensible"};
  }
  return std::nullopt;
}

std::optional<Error> check_mesh(const RunHeader& header, std::span<const std::byte> mesh) {
  const std::uint64_t meshes = mesh_size(header);
  if (mesh.size() != meshes && mesh.size() != meshes + kColorBytes * header.organ_vertices)
    return Error{
        fmt::format("the meshes have {} bytes instead of {}, or {} with colours; use tactd and "
                    "tact-view of one build",
                    mesh.size(), meshes, meshes + kColorBytes * header.organ_vertices)};
  const std::size_t organ_size =
      (std::size_t{header.organ_vertices} + header.organ_triangles) * kTripleBytes;
  if (std::optional<Error> error =
          check_part(mesh.first(organ_size), header.organ_vertices, "organ")) {
    return error;
  }
  const std::span<const std::byte> tool = mesh.subspan(organ_size, meshes - organ_size);
  return check_part(tool, header.tool_vertices, "tool");
}

std::optional<Error> check_frame(const Frame& frame, const RunHeader& header) {
  // Enums are the only values of a frame on which code branches.
  if (frame.state > firmware::loop::State::kStopped)
    return Error{fmt::format("frame: state {} is unknown (0 to {})", static_cast<int>(frame.state),
                             static_cast<int>(firmware::loop::State::kStopped))};
  for (const firmware::protocol::FrameContact& contact : frame.contact)
    if (contact.state > model::ContactState::kInside)
      return Error{fmt::format("frame: a contact has the unknown state {}",
                               static_cast<int>(contact.state))};
  return check_patch(frame.patch, header);
}

}  // namespace tact::host::record
