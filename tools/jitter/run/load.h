// SPDX-License-Identifier: Apache-2.0
// load.h - a load beside the loop, by stress-ng: what a PC does while a person works on it.
#pragma once

#include <string>
#include <vector>

#include "model/result.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter {

/// Kinds of load: cpu, memory, disk, net.
const std::vector<std::string>& load_kinds();

/// The arguments of stress-ng for these kinds on so many CPUs; its files go below `folder`, and it
/// ends by itself after `longest_s`.
std::vector<std::string> stress_arguments(const std::vector<std::string>& kinds, unsigned cpus,
                                          const std::string& folder, double longest_s);

/// Starts it in a process group of its own. It ends with its object, and with us.
model::Result<program::RunningProgram> start_load(const std::vector<std::string>& kinds,
                                                  const program::ScratchFolder& folder,
                                                  double longest_s);

}  // namespace tact::tools::jitter
