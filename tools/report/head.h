// SPDX-License-Identifier: Apache-2.0
// head.h - the head of a report: when and where.
#pragma once

#include <string>

namespace tact::tools::report {

/// "2026-11-25T16:40:02Z"
std::string now_utc();
/// The name of this PC.
std::string host_name();

}  // namespace tact::tools::report
