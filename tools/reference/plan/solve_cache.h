// SPDX-License-Identifier: Apache-2.0
// solve_cache.h - solved cases on disk, one file each, found again by everything they depend on.
//
// The key is a text that names mesh, material, held box, site, load, mesh level, method and solver;
// the file's name is its hash and the file repeats the whole key, so two keys are never mixed up. A
// file that cannot be read counts as absent: the case is solved again.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "tools/reference/press/indentation.h"
#include "tools/reference/press/tool_press.h"

namespace tact::tools::reference {

class SolveCache {
 public:
  /// The folder is made at the first keep().
  explicit SolveCache(std::string directory) : directory_(std::move(directory)) {}

  std::optional<ground_truth::ReferenceCase> find(const std::string& key) const;
  std::optional<std::vector<ground_truth::ToolCase>> find_tool(const std::string& key) const;
  /// Any number of threads and programs may keep the same case: one of them wins, all succeed. The
  /// error says which file could not be written.
  std::optional<model::Error> keep(const std::string& key,
                                   const ground_truth::ReferenceCase& solved) const;
  std::optional<model::Error> keep_tool(const std::string& key,
                                        const std::vector<ground_truth::ToolCase>& solved) const;

  std::string path_of(const std::string& key) const;

 private:
  std::optional<nlohmann::json> read(const std::string& key) const;
  std::optional<model::Error> write(const std::string& key, nlohmann::json solved) const;

  std::string directory_;
};

/// $XDG_CACHE_HOME/tact/reference, else ~/.cache/tact/reference.
std::string default_cache_directory();

/// Of vertices (to the nanometre) and triangles, 16 hex digits.
std::string mesh_hash(const model::mesh::SurfaceMesh& mesh);

/// `solver`: names and versions of the programs.
std::string cache_key(const Organ& organ, const Indentation& what, const std::string& solver);

std::string cache_key(const Organ& organ, const ToolPress& what, const std::string& solver);

/// The coarse solve that every press on a vertex needs first.
Indentation probe_of(std::uint32_t vertex, double tool_radius_m);

/// From the cache, or solved and kept. A press without a contact radius is solved coarsely first;
/// that force gives the radius (see indentation.h).
model::Result<ground_truth::ReferenceCase> solve_once(const Organ& organ, const Indentation& what,
                                                      const std::string& solver,
                                                      const SolveCache& cache);
model::Result<std::vector<ground_truth::ToolCase>> solve_once(const Organ& organ,
                                                              const ToolPress& what,
                                                              const std::string& solver,
                                                              const SolveCache& cache);

}  // namespace tact::tools::reference
