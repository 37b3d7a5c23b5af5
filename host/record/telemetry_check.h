// SPDX-License-Identifier: Apache-2.0
// telemetry_check.h - validates bytes from a socket or a file before any use. Each check returns
// nothing, or an error with the cause.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "firmware/protocol/frame.h"
#include "firmware/protocol/run_header.h"
#include "model/result.h"

namespace tact::host::record {

using firmware::protocol::Frame;
using firmware::protocol::RunHeader;

/// Organ vertices (3 float each, W, m), organ triangles (3 uint32 each), the same for the tool mesh
/// (tool frame, m), then, if the scene has them, the colours of the organ's vertices (3 uint8 each,
/// sRGB).
using MeshBytes = std::vector<std::byte>;

/// Counts, and finite lengths.
std::optional<model::Error> check_header(const RunHeader& header);

/// Size, finite vertices, and triangles that name existing vertices.
std::optional<model::Error> check_mesh(const RunHeader& header, std::span<const std::byte> mesh);

/// The states of a frame, and a patch that names existing vertices and triangles. Lengths and
/// forces may be NaN, because such a fault must be shown.
std::optional<model::Error> check_frame(const Frame& frame, const RunHeader& header);

}  // namespace tact::host::record
