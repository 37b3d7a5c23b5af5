// SPDX-License-Identifier: Apache-2.0
// self_check.h - the solver against answers that no tact code made, and exact ones.
//
//   block   a round block under a sphere and a bonded disc, linear and with large strain
//           (independent, FEniCS; the linear bond: CalculiX)
//   space   a big block under a sphere against the half-space (half_space.h)
//   organ   a closed body, patches of triangles moved as one piece (independent, CalculiX)
#pragma once

#include <string>

#include "model/result.h"

namespace tact::tools::reference {

/// Prints one line a case; true if all are within their bars. `folder` holds organ_patch.json and
/// organ_patch.obj. Takes about a quarter of an hour.
model::Result<bool> self_check(const std::string& folder);

}  // namespace tact::tools::reference
