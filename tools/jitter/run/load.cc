// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/load.h"

#include <algorithm>
#include <cmath>
#include <thread>

namespace tact::tools::jitter {

const std::vector<std::string>& load_kinds() {
  static const std::vector<std::string> kinds{"cpu", "memory", "disk", "net"};
  return kinds;
}

std::vector<std::string> stress_arguments(const std::vector<std::string>& kinds, unsigned cpus,
                                          const std::string& folder, double longest_s) {
  const std::string all = std::to_string(cpus);
  std::vector<std::string> out{"--temp-path", folder, "--oomable", "--timeout",
                               std::to_string(std::llround(longest_s)) + "s"};
  const auto add = [&](std::initializer_list<std::string> more) {
    out.insert(out.end(), more.begin(), more.end());
  };
  for (const std::string& kind : kinds) {
    if (kind == "cpu") add({"--cpu", all});  // all its methods in turn
    if (kind == "memory") add({"--vm", all, "--vm-bytes", "128m", "--cache", "1"});
    if (kind == "disk") add({"--hdd", "1", "--hdd-bytes", "64m"});
    if (kind == "net") add({"--sock", "1", "--udp", "1"});
  }
  return out;
}

model::Result<program::RunningProgram> start_load(const std::vector<std::string>& kinds,
                                                  const program::ScratchFolder& folder,
                                                  double longest_s) {
  const unsigned cpus = std::max(1U, std::thread::hardware_concurrency());
  return program::RunningProgram::start(
      {.program = "stress-ng",
       .arguments = stress_arguments(kinds, cpus, folder.path(), longest_s),
       .directory = folder.path(),
       .log_path = folder.file("stress-ng.txt"),
       .package = "stress-ng"});
}

}  // namespace tact::tools::jitter
