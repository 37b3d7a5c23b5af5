// SPDX-License-Identifier: Apache-2.0
// jitter_page.h - a measurement as one HTML file that needs nothing else: no network, no script.
#pragma once

#include <string>

#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter {

/// `histogram_svg`: the picture itself; empty where none was drawn.
std::string make_page(const JitterResult& result, const std::string& command,
                      const std::string& histogram_svg);

}  // namespace tact::tools::jitter
