// SPDX-License-Identifier: Apache-2.0
// law_numbers.h - the numbers of the law that is felt: what a person may change, to feel it.
//
// Keys, units and ranges are those of the scene's reader. What a law or a device can bear is asked
// where a run is opened. Set-up code only.
#pragma once

#include <string>
#include <vector>

#include "model/reader/scene_number.h"
#include "model/result.h"
#include "model/scene/scene.h"

namespace tact::model::scene {

/// Of the section that the scene's law names. `scene` was loaded with the same overrides.
Result<std::vector<reader::SceneNumber>> law_numbers(const Scene& scene,
                                                     const std::vector<std::string>& overrides);

}  // namespace tact::model::scene
