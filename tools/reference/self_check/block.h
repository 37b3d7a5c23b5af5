// SPDX-License-Identifier: Apache-2.0
// block.h - a round block standing on its held bottom, to check the solver where the answer is
// known.
#pragma once

#include "tools/reference/press/indentation.h"

namespace tact::tools::reference {

/// Vertex 0 is the middle of the top, z = 0; the block stands on z = -height.
model::Result<Organ> make_block(double radius_m, double height_m, const Elasticity& material);

}  // namespace tact::tools::reference
