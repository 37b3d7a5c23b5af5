// SPDX-License-Identifier: Apache-2.0
#include "host/server/frame_json.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/protocol/record_text.h"
#include "model/io/json.h"

namespace tact::host::server {
namespace {

using firmware::protocol::append_json;
using firmware::protocol::Field;
using firmware::protocol::FrameContact;

/// RFC 4648, with padding.
void put_base64(std::string& out, std::span<const std::uint8_t> bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');  // EVP_EncodeBlock appends a zero
  text.resize(
      static_cast<std::size_t>(EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                               bytes.data(), static_cast<int>(bytes.size()))));
  out += text;
}

void put_patch(std::string& out, const firmware::protocol::FramePatch& patch) {
  const std::size_t n =
      std::min<std::size_t>(patch.vertex_count, firmware::protocol::kMaxPatchVertices);
  const std::size_t cuts =
      std::min<std::size_t>(patch.cut_count, firmware::protocol::kMaxCutsReported);
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

std::string frame_json(const record::Frame& frame, const record::RunHeader& header) {
  std::string out = "{\"kind\":\"frame\",";
  out.reserve(kMaxFrameJsonBytes);
  append_json(out, record::Frame::fields(), &frame);
  out += ",\"contacts\":[";
  const std::size_t contacts = std::min(header.spheres.size(), firmware::protocol::kMaxContacts);
  const std::size_t rings =
      std::min<std::size_t>(header.profile_points, firmware::protocol::kMaxProfilePoints);
  const auto limit_of = [rings](const Field& field) {
    return field.name == std::string_view("profile_m") ? std::optional(rings) : std::nullopt;
  };
  const char* separator = "";
  for (std::size_t i = 0; i < contacts; ++i) {
    // Free contacts are omitted to keep the frame short (kMaxFrameJsonBytes).
    if (frame.contact[i].state == model::ContactState::kFree) continue;
    fmt::format_to(std::back_inserter(out), "{}{{\"contact\":{},", std::exchange(separator, ","),
                   i);
    append_json(out, FrameContact::fields(), &frame.contact[i], limit_of);
    out += '}';
  }
  out += ']';
  // A law has profiles or a patch, never both.
  if (rings == 0) put_patch(out, frame.patch);
  out += '}';
  return out;
}

std::string scene_json(const record::RunHeader& header) {
  nlohmann::json scene = json_of(header);
  // Of the PC of tactd and its device, and of no use to a page.
  for (const char* key : {"hand_socket", "host_name", "joints", "overrides"}) scene.erase(key);
  // Repairs a name with broken UTF-8 instead of throwing.
  return model::io::text_of(scene);
}

}  // namespace tact::host::server
