// SPDX-License-Identifier: Apache-2.0
// falcon_boot.h - how a Falcon is woken, against published requests and words.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/verify/report.h"

namespace tact::tools::verify {

/// `ftdi`: requests of the USB adapter by name, words of the boot loader, and their order.
void verify_falcon_boot(const nlohmann::json& ftdi, Report& report);

}  // namespace tact::tools::verify
