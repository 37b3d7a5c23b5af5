// SPDX-License-Identifier: Apache-2.0
// memory_laws.h - the laws with memory that the maps probe: springs and masses, and relaxation.
//
// All at 1 kHz, on a square plate of 100 mm with triangles of 5 mm. Two terms fade so fast (30 and
// 100 ms) that a run of 3 s sees all of them.
#pragma once

#include <memory>

#include "model/law/law.h"
#include "tools/stability/laws/felt_tissue.h"

namespace tact::tools::stability {

inline constexpr double kPatchRange_m = 0.01;

/// Vendors of a mass-spring patch, and of a closed-form law that relaxes.
ContactLawMaker patch_maker(bool relaxes);
ContactLawMaker relaxing_maker(const std::shared_ptr<const model::law::Law>& law);

}  // namespace tact::tools::stability
