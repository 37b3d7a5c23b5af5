// SPDX-License-Identifier: Apache-2.0
// environment.h - facts of PC and build that every measurement must record.
#pragma once

#include <string>

namespace tact::firmware::pc {

struct Environment {
  std::string kernel_release, kernel_version;
  bool realtime_kernel = false;
  std::string cpu;
  int cores = 0;
  std::string clock_source;
  std::string microcode;        // of the first CPU
  std::string boot_parameters;  // of the kernel
  std::string git_revision;     // of this build
  std::string compiler;
  std::string scene_hash;
};

Environment read_environment(const std::string& scene_hash);

}  // namespace tact::firmware::pc
