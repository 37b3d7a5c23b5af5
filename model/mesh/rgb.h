// SPDX-License-Identifier: Apache-2.0
// rgb.h - the colour of a vertex, for the viewer alone.
#pragma once

#include <array>
#include <cstdint>

namespace tact::model::mesh {

using Rgb = std::array<std::uint8_t, 3>;  // red, green, blue, sRGB; 255 is full

}  // namespace tact::model::mesh
