// telemetry_check.h - are these bytes what tactd promises? Nothing from a socket or a file is used
// before it passed here. Each check returns an empty string, or one sentence that says what is
// wrong.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/telemetry_record.h"

namespace tact::host {

using firmware::Frame;
using firmware::Hello;

/// Content of the memory file that comes with a Hello.
using MeshBytes = std::vector<std::byte>;

/// Size in bytes of the meshes that this Hello announces.
std::uint64_t mesh_size(const Hello& hello);

/// Header, counts, and finite lengths of a Hello.
std::string check_hello(const Hello& hello);

/// Size, finite vertices, and triangles that name existing vertices.
std::string check_mesh(const Hello& hello, std::span<const std::byte> mesh);

/// Header of a Frame, its states, and a patch that names existing vertices and triangles. Lengths
/// and forces may be NaN: that is something to show, not to hide.
std::string check_frame(const Frame& frame, const Hello& hello);

/// A text of a wire struct: ends at the first NUL or with the array.
template <std::size_t n>
std::string_view text_of(const char (&field)[n]) {
  const std::string_view all(field, n);
  return all.substr(0, all.find('\0'));
}

}  // namespace tact::host
