// SPDX-License-Identifier: Apache-2.0
// device_list.h - `tactd --list-devices`: what is plugged in and what it lacks, as text or JSON.
#pragma once

#include <string>
#include <vector>

#include "hal/list/list_devices.h"

namespace tact::firmware::run {

/// For people: one paragraph per part, then what is not there.
std::string devices_as_text(const std::vector<hal::list::FoundPart>& parts);

/// {"devices":[{"kind","name","what","scene","ready","lacking","remedy"}]}
std::string devices_as_json(const std::vector<hal::list::FoundPart>& parts);

}  // namespace tact::firmware::run
