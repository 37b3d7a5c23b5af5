// SPDX-License-Identifier: Apache-2.0
// replay.h - computes a recorded run again: equal samples must give equal forces, bit for bit.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/protocol/tick_log.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

namespace tact::firmware::run {

struct ReplayOutcome {
  std::uint64_t ticks = 0;
  std::uint64_t different = 0;        // ticks whose force has other bits
  std::uint64_t first_different = 0;  // tick number, meaningful if different > 0
  std::uint64_t gap_before = 0;       // ticks are missing before this one; 0: no gap
  std::string damage;                 // of the log; the good ticks before it were compared
  std::uint64_t force_hash = 0;       // force_hash.h
};

/// An error if the log belongs to another scene or cannot be read.
model::Result<ReplayOutcome> replay(const std::string& path, const model::scene::Scene& scene,
                                    const model::scene::Tissue& tissue);

}  // namespace tact::firmware::run
