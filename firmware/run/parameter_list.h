// SPDX-License-Identifier: Apache-2.0
// parameter_list.h - `tactd SCENE --parameters`: the numbers of the scene's law, as text or JSON.
#pragma once

#include <string>
#include <vector>

#include "model/scene/law_numbers.h"

namespace tact::firmware::run {

/// For people: one line per number, as --help-scene has them, with the scene's value.
std::string parameters_as_text(const std::vector<model::reader::SceneNumber>& numbers);

/// {"scene","law","simulated","parameters":[{"key","unit","value","low","high","whole","meaning"}]}
std::string parameters_as_json(const model::scene::Scene& scene,
                               const std::vector<model::reader::SceneNumber>& numbers);

}  // namespace tact::firmware::run
