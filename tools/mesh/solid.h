// SPDX-License-Identifier: Apache-2.0
// solid.h - is a closed surface a solid, or two sheets on each other?
#pragma once

#include <optional>
#include <string>

#include "model/mesh/mesh.h"
#include "model/result.h"

namespace tact::tools::mesh {

/// An error if the surface is closed and has no volume. An open one may be flat.
std::optional<model::Error> check_solid(const std::string& path,
                                        const model::mesh::SurfaceMesh& mesh);

}  // namespace tact::tools::mesh
