// SPDX-License-Identifier: Apache-2.0
// export_run.h - a tick log, a black box or a viewer's recording as one MCAP file.
//
// Time 0 is the start of the loop; a log knows the date of its start, to the second, and adds it. A
// black box has both its ticks and its frames, in one time: the frames name their ticks.
#pragma once

#include <cstdint>
#include <string>

#include "model/result.h"

namespace tact::tools::mcap {

struct Exported {
  std::uint64_t ticks = 0, frames = 0, messages = 0;
  double length_s = 0.0;
  std::string damage;  // of what was read: what is not whole, or empty
};

/// Writes all that is whole. Error: nothing is whole, or `to` cannot be written; then no file is
/// made.
model::Result<Exported> export_run(const std::string& from, const std::string& to);

}  // namespace tact::tools::mcap
