// reference_fits.h - is this reference about this scene? A residual against another organ means
// nothing.
#pragma once

#include <optional>

#include "model/scene.h"
#include "tools/common/reference_data.h"

namespace tact::tools {

/// Whether Young's modulus must be the scene's; a fit may look for it.
enum class ModulusOf { kSame, kAny };

/// The tip's radius, the sites' places, and, where the scene has [elastic], its numbers. An error
/// names the first that differs and how to solve the reference again.
std::optional<model::Error> check_reference_fits(const ReferenceData& reference,
                                                 const model::Scene& scene, ModulusOf modulus);

}  // namespace tact::tools
