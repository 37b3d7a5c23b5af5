// SPDX-License-Identifier: Apache-2.0
// consent.h - before a real device is driven to its limits, a person must say so.
#pragma once

#include <istream>
#include <optional>
#include <string>

#include "model/result.h"

namespace tact::tools::limits {

/// What will happen, with what force, and how to stop it.
std::string warning_text(const std::string& device_name, double force_limit_N, bool has_lines);
/// The words to type: they name the force, so they are not typed for another one.
std::string consent_text(double force_limit_N);
/// Reads one line: nothing if it is the words exactly.
std::optional<model::Error> read_consent(std::istream& in, double force_limit_N);

}  // namespace tact::tools::limits
