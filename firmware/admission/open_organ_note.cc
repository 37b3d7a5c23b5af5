// SPDX-License-Identifier: Apache-2.0
#include "firmware/admission/open_organ_note.h"

#include <fmt/format.h>

#include "model/mesh/mesh.h"

namespace tact::firmware::admission {

std::string open_organ_note(const model::scene::Scene& scene) {
  const std::size_t edges = model::mesh::summarize(scene.organ_mesh).boundary_edges;
  if (edges == 0) return {};
  return fmt::format(
      "{}: the organ is open, with {} boundary edges; beside the boundary of an open surface there "
      "is no inside: a tool that comes in through a hole feels nothing until it has once been "
      "outside; tact-mesh MESH --close-holes closes it",
      scene.path, edges);
}

}  // namespace tact::firmware::admission
