// SPDX-License-Identifier: Apache-2.0
// lists.h - the lists that tactd prints, as text and JSON: `--list-devices`, `--parameters`.
#pragma once

#include <string>
#include <vector>

#include "hal/list/list_devices.h"
#include "model/scene/scene.h"

namespace tact::firmware::run {

/// Text: one paragraph per connected part, then the kinds that were not found.
std::string devices_as_text(const std::vector<hal::list::FoundPart>& parts,
                            const std::vector<hal::UsbPart>& looked_for);

/// {"devices":[{"kind","name","what","scene","ready","lacking","remedy"}]}
std::string devices_as_json(const std::vector<hal::list::FoundPart>& parts);

/// Text: one line per number of the law in use, as in --help-scene, with its value.
std::string parameters_as_text(model::scene::Scene scene);

/// {"scene","law","simulated","parameters":[{"key","unit","value","low","high","whole","meaning"}]}
std::string parameters_as_json(model::scene::Scene scene);

/// CITATION.cff, with the commit of this build.
std::string citation();

}  // namespace tact::firmware::run
