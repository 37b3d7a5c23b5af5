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

std::optional<Error> check_header(const firmware::telemetry::MessageHeader& header,
                                  firmware::telemetry::MessageKind kind) {
  if (header.magic != firmware::telemetry::kTelemetryMagic)
    return Error{"this is not tact telemetry"};
  if (header.version != firmware::telemetry::kTelemetryVersion) {
    return Error{fmt::format(
        "telemetry version {} meets tact-view version {}; use tactd and tact-view of one build",
        header.version, firmware::telemetry::kTelemetryVersion)};
  }
  if (header.kind != kind) return Error{"a telemetry message has an unexpected kind"};
  return std::nullopt;
}

std::uint64_t mesh_size(const Hello& hello) {
  // In 64 bits: the sum of four untrusted 32-bit counts may overflow 32 bits.
  const std::uint64_t triples = std::uint64_t{hello.organ_vertices} + hello.organ_triangles +
                                hello.tool_vertices + hello.tool_triangles;
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

std::optional<Error> check_patch(const firmware::telemetry::FramePatch& patch, const Hello& hello) {
  if (patch.vertex_count > firmware::telemetry::kMaxPatchVertices ||
      patch.cut_count > firmware::telemetry::kMaxCutsReported) {
    return Error{"a frame tells more displaced vertices or cuts than fit"};
  }
  // The page uses these numbers as indices into its mesh.
  if (patch.cut_total > hello.organ_triangles || patch.cut_count > patch.cut_total)
    return Error{"a frame tells more cuts than the organ has triangles"};
  const auto names_only = [](std::span<const std::uint32_t> ids, std::uint32_t below) {
    return std::all_of(ids.begin(), ids.end(), [below](std::uint32_t id) { return id < below; });
  };
  if (!names_only(std::span(patch.vertex).first(patch.vertex_count), hello.organ_vertices) ||
      !names_only(std::span(patch.cut_triangle).first(patch.cut_count), hello.organ_triangles)) {
    return Error{"a frame names a vertex or triangle that the organ does not have"};
  }
  return std::nullopt;
}

}  // namespace

bool is_mesh_size(const Hello& hello, std::uint64_t bytes) {
  const std::uint64_t meshes = mesh_size(hello);
  return bytes == meshes || bytes == meshes + kColorBytes * hello.organ_vertices;
}

std::optional<Error> check_hello(const Hello& hello) {
  if (std::optional<Error> error =
          check_header(hello.header, firmware::telemetry::MessageKind::kHello)) {
    return error;
  }
  for (const std::uint32_t count :
       {hello.organ_vertices, hello.organ_triangles, hello.tool_vertices, hello.tool_triangles}) {
    if (count > kMaxElements) return Error{"a mesh is larger than 4 million elements"};
  }
  if (hello.site_count > firmware::telemetry::kMaxSites)
    return Error{"there are more probe spheres than fit"};
  if (hello.ring_count > firmware::telemetry::kMaxRings)
    return Error{"there are more profile rings than fit"};
  if (hello.piece_count > firmware::telemetry::kMaxPieces)
    return Error{"there are more coloured pieces than fit"};
  for (const auto& color : hello.piece_color_ratio)
    for (const float ratio : color)
      if (!std::isfinite(ratio) || ratio < 0.0f) return Error{"a colour is not sensible"};
  for (const float value : {hello.ring_pitch_m, hello.rate_Hz, hello.frame_rate_Hz,
                            hello.force_limit_N, hello.continuous_force_N, hello.energy_budget_J}) {
    if (!std::isfinite(value) || value < 0.0f)
      return Error{"a number of the scene is not sensible"};
  }
  return std::nullopt;
}

std::optional<Error> check_mesh(const Hello& hello, std::span<const std::byte> mesh) {
  const std::uint64_t meshes = mesh_size(hello);
  if (!is_mesh_size(hello, mesh.size()))
    return Error{
        fmt::format("the meshes have {} bytes instead of {}, or {} with colours; use tactd and "
                    "tact-view of one build",
                    mesh.size(), meshes, meshes + kColorBytes * hello.organ_vertices)};
  const std::size_t organ_size =
      (std::size_t{hello.organ_vertices} + hello.organ_triangles) * kTripleBytes;
  if (std::optional<Error> error =
          check_part(mesh.first(organ_size), hello.organ_vertices, "organ")) {
    return error;
  }
  const std::span<const std::byte> tool = mesh.subspan(organ_size, meshes - organ_size);
  return check_part(tool, hello.tool_vertices, "tool");
}

std::optional<Error> check_frame(const Frame& frame, const Hello& hello) {
  if (std::optional<Error> error =
          check_header(frame.header, firmware::telemetry::MessageKind::kFrame)) {
    return error;
  }
  // Enums are the only values of a frame on which code branches.
  if (frame.state > firmware::loop::State::kStopped)
    return Error{"a frame has a state that is none"};
  for (const firmware::telemetry::FrameSite& site : frame.site)
    if (site.state > firmware::telemetry::SiteState::kInside)
      return Error{"a frame has a site whose state is none"};
  return check_patch(frame.patch, hello);
}

}  // namespace tact::host::record
