// SPDX-License-Identifier: Apache-2.0
// rights_remedy.h - how a person gives this process the rights that it lacks: in a container, in a
// build folder, from a package, or below another prefix. Set-up code.
#pragma once

#include <string>

namespace tact::hal {

struct Container {
  const char *mark, *name;
  bool has_run_command;  // its rights are options of `NAME run`, else settings on the host
};
/// By the file that its engine leaves in it; null: in none. `root`: "", or a copy of a PC's files.
const Container* container_of(const std::string& root = {});

/// Installs `packages`. A build folder has a file that says how they are made before.
std::string packages_remedy(const char* packages = "./tact_*.deb ./tact-rt_*.deb");

/// Creates the group haptics with its limits and udev rules.
std::string group_remedy();

/// The rights of that group: real-time priority, locked memory, no deep sleep of the CPU.
std::string rights_remedy(const std::string& root = {});

}  // namespace tact::hal
