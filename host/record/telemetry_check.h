// SPDX-License-Identifier: Apache-2.0
// telemetry_check.h - validates bytes from a socket or a file before any use. Each check returns
// nothing, or an error with the cause.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "firmware/telemetry/telemetry_record.h"
#include "model/result.h"

namespace tact::host::record {

using firmware::telemetry::Frame;
using firmware::telemetry::Hello;

/// Content of the memory file that comes with a Hello.
using MeshBytes = std::vector<std::byte>;

/// True if the meshes announced by this Hello have this size, with or without colours of the
/// organ's vertices.
bool is_mesh_size(const Hello& hello, std::uint64_t bytes);

/// Header, counts, and finite lengths of a Hello.
std::optional<model::Error> check_hello(const Hello& hello);

/// Size, finite vertices, and triangles that name existing vertices.
std::optional<model::Error> check_mesh(const Hello& hello, std::span<const std::byte> mesh);

/// Header of a Frame, its states, and a patch that names existing vertices and triangles. Lengths
/// and forces may be NaN, because such a fault must be shown.
std::optional<model::Error> check_frame(const Frame& frame, const Hello& hello);

/// A text of a wire struct: ends at the first NUL or with the array.
template <std::size_t n>
std::string_view text_of(const char (&field)[n]) {
  const std::string_view all(field, n);
  return all.substr(0, all.find('\0'));
}

}  // namespace tact::host::record
