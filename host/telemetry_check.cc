#include "host/telemetry_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tact::host {
namespace {

constexpr std::uint64_t kTripleBytes = 12;         // 3 floats or 3 uint32
constexpr std::uint32_t kMaxElements = 4'000'000;  // vertices or triangles of one mesh

std::string check_header(const firmware::MessageHeader& header, firmware::MessageKind kind) {
  if (header.magic != firmware::kTelemetryMagic) return "this is not tact telemetry";
  if (header.version != firmware::kTelemetryVersion) {
    return fmt::format(
        "telemetry version {} meets tact-view version {}; use tactd and tact-view of one build",
        header.version, firmware::kTelemetryVersion);
  }
  if (header.kind != kind) return "a telemetry message has an unexpected kind";
  return {};
}

std::string check_part(std::span<const std::byte> part, std::uint32_t vertices, const char* name) {
  const std::size_t triangle_start = vertices * kTripleBytes;
  for (std::size_t at = 0; at < triangle_start; at += sizeof(float)) {
    float value_m = 0.0f;
    std::memcpy(&value_m, &part[at], sizeof value_m);
    if (!std::isfinite(value_m)) {
      return fmt::format("vertex {} of the {} mesh is not finite", at / kTripleBytes, name);
    }
  }
  for (std::size_t at = triangle_start; at < part.size(); at += sizeof(std::uint32_t)) {
    std::uint32_t vertex = 0;
    std::memcpy(&vertex, &part[at], sizeof vertex);
    if (vertex >= vertices) {
      return fmt::format("triangle {} of the {} mesh names vertex {} of {}",
                         (at - triangle_start) / kTripleBytes, name, vertex, vertices);
    }
  }
  return {};
}

std::string check_patch(const firmware::FramePatch& patch, const Hello& hello) {
  if (patch.vertex_count > firmware::kMaxPatchVertices ||
      patch.cut_count > firmware::kMaxCutsTold) {
    return "a frame tells more displaced vertices or cuts than fit";
  }
  if (patch.cut_total > hello.organ_triangles || patch.cut_count > patch.cut_total) {
    return "a frame tells more cuts than the organ has triangles";
  }
  const auto names_only = [](std::span<const std::uint32_t> ids, std::uint32_t below) {
    return std::all_of(ids.begin(), ids.end(), [below](std::uint32_t id) { return id < below; });
  };
  if (!names_only(std::span(patch.vertex).first(patch.vertex_count), hello.organ_vertices) ||
      !names_only(std::span(patch.cut_triangle).first(patch.cut_count), hello.organ_triangles)) {
    return "a frame names a vertex or triangle that the organ does not have";
  }
  return {};
}

}  // namespace

std::uint64_t mesh_size(const Hello& hello) {
  const std::uint64_t triples = std::uint64_t{hello.organ_vertices} + hello.organ_triangles +
                                hello.tool_vertices + hello.tool_triangles;
  return triples * kTripleBytes;
}

std::string check_hello(const Hello& hello) {
  if (std::string wrong = check_header(hello.header, firmware::MessageKind::kHello);
      !wrong.empty()) {
    return wrong;
  }
  for (const std::uint32_t count :
       {hello.organ_vertices, hello.organ_triangles, hello.tool_vertices, hello.tool_triangles}) {
    if (count > kMaxElements) return "a mesh is larger than 4 million elements";
  }
  if (hello.site_count > firmware::kMaxSites) return "there are more probe spheres than fit";
  if (hello.ring_count > firmware::kMaxRings) return "there are more profile rings than fit";
  for (const float value : {hello.ring_pitch_m, hello.rate_Hz, hello.frame_rate_Hz,
                            hello.force_limit_N, hello.continuous_force_N, hello.energy_budget_J}) {
    if (!std::isfinite(value) || value < 0.0f) return "a number of the scene is not sensible";
  }
  return {};
}

std::string check_mesh(const Hello& hello, std::span<const std::byte> mesh) {
  const std::uint64_t expected = mesh_size(hello);
  if (mesh.size() != expected) {
    return fmt::format("the meshes have {} bytes instead of {}", mesh.size(), expected);
  }
  const std::size_t organ_size =
      (std::size_t{hello.organ_vertices} + hello.organ_triangles) * kTripleBytes;
  std::string wrong = check_part(mesh.first(organ_size), hello.organ_vertices, "organ");
  if (wrong.empty()) wrong = check_part(mesh.subspan(organ_size), hello.tool_vertices, "tool");
  return wrong;
}

std::string check_frame(const Frame& frame, const Hello& hello) {
  if (std::string wrong = check_header(frame.header, firmware::MessageKind::kFrame);
      !wrong.empty()) {
    return wrong;
  }
  if (frame.state > firmware::State::kStopped) return "a frame has a state that is none";
  for (const firmware::FrameSite& site : frame.site) {
    if (site.state > firmware::SiteState::kHeld) return "a frame has a site whose state is none";
  }
  return check_patch(frame.patch, hello);
}

}  // namespace tact::host
