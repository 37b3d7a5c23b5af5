// replay.h - a recorded run computed again: the same samples must give the same forces, bit for
// bit.
#pragma once

#include <cstdint>
#include <string>

#include "firmware/tick_log.h"
#include "model/scene.h"
#include "model/tissue.h"

namespace tact::firmware {

struct ReplayOutcome {
  std::uint64_t ticks = 0;
  std::uint64_t different = 0;        // ticks whose force has other bits
  std::uint64_t first_different = 0;  // tick number, meaningful if different > 0
  std::uint64_t gap_before = 0;       // the log misses ticks before this one; 0: no gap
  bool truncated = false;             // the log's last tick is torn; all before it was compared
  std::uint64_t force_hash = 0;       // FNV-1a over all forces: equal hashes, equal runs
};

/// An error if the log belongs to another scene or cannot be read.
model::Result<ReplayOutcome> replay(const std::string& path, const model::Scene& scene,
                                    const model::Tissue& tissue);

/// FNV-1a step over the bytes of a wrench.
std::uint64_t hash_wrench(std::uint64_t hash, const model::Wrench& wrench);
inline constexpr std::uint64_t kHashStart = 0xcbf29ce484222325u;

}  // namespace tact::firmware
