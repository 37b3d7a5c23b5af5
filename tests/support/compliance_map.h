// SPDX-License-Identifier: Apache-2.0
// compliance_map.h - a map that a test made, as the file that model/scene/compliance_file.h reads.
#pragma once

#include <fstream>
#include <string>

#include "model/fnv1a.h"
#include "model/tissue/compliance_map.h"

namespace tact::tests {

/// The bytes written; 0 if there is no such folder.
inline std::size_t write_compliance_map(const model::tissue::ComplianceMap& map,
                                        const std::string& path) {
  std::string bytes = "TACTCOMP";
  const auto append = [&bytes](const auto* first, std::size_t count) {
    bytes.append(reinterpret_cast<const char*>(first), count * sizeof *first);
  };
  const auto vertices = static_cast<std::uint32_t>(map.vertices());
  const std::uint32_t numbers[]{2, vertices, static_cast<std::uint32_t>(map.rings), map.inclusions};
  const double lengths[]{map.poisson_ratio, map.patch_radius_m, map.ring_pitch_m};
  append(numbers, 4);
  append(lengths, 3);
  append(&map.fixed_min_m, 1);
  append(&map.fixed_max_m, 1);
  bytes += map.mesh_hash;
  append(map.regular_times_E_per_m.data(), map.vertices());
  append(map.sideways_times_E_per_m.data(), map.vertices());
  append(map.ring_times_E_per_m.data(), map.ring_times_E_per_m.size());
  const std::uint64_t sum = model::fnv1a(bytes);
  append(&sum, 1);
  return std::ofstream(path, std::ios::binary) << bytes ? bytes.size() : 0;
}

}  // namespace tact::tests
