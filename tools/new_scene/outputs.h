// SPDX-License-Identifier: Apache-2.0
// outputs.h - the files of a new scene: none of them before all are whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/result.h"

namespace tact::tools::new_scene {

/// FOLDER/NAME.toml and what lies beside it.
struct OutputNames {
  std::string scene, map, organ, tool;
  std::string reference, tool_reference;  // of tact-lab reference, with --plan
  std::string name;                       // NAME
};

/// An error if `out` does not end in .toml.
model::Result<OutputNames> names_of(const std::string& out);

/// Before the work: may this file be written? One that is there is replaced only if `force` is set
/// and it is of the same kind (file_writer.h). `source`: what is read.
std::optional<model::Error> check_new(const std::string& path, const std::string& beginning,
                                      const std::string& source, bool force);

struct OutputFile {
  std::string path, content;
};

/// All under temporary names and on the disk first, then one rename each, in this order. Without
/// `force` a file that has appeared since check_new() is kept, and none of ours stays.
std::optional<model::Error> write_all(const std::vector<OutputFile>& files, bool force);

}  // namespace tact::tools::new_scene
