// SPDX-License-Identifier: Apache-2.0
// remedy.h - what gives this process the rights that it lacks, by where it runs: in a container,
// from a build folder, from a package, or below another prefix.
#pragma once

#include <fmt/format.h>
#include <grp.h>

#include <array>
#include <fstream>
#include <string>
#include <system_error>

#include "model/io/program/installed.h"

namespace tact::model::io {

struct Container {
  const char *mark, *name;
};
/// By the file that its engine leaves in it; null: in none. `root`: "", or a copy of a PC's files.
inline const Container* container_of(const std::string& root = {}) {
  static constexpr std::array<Container, 3> kAll{{{"/.dockerenv", "docker"},
                                                  {"/run/.containerenv", "podman"},
                                                  {"/run/systemd/container", "lxc or nspawn"}}};
  std::error_code failed;
  for (const Container& one : kAll)
    if (std::filesystem::exists(root + one.mark, failed)) return &one;
  return nullptr;
}

/// Installs `packages`. A build folder has a file that says how they are made before.
inline std::string packages_remedy(const char* packages = "./tact_*.deb ./tact-rt_*.deb") {
  std::string made;
  std::getline(std::ifstream(program_folder() / "packages.remedy"), made);
  return fmt::format("{}sudo apt install {}", made, packages);
}

/// Brings the group haptics with its limits and udev rules.
inline std::string group_remedy() {
  const auto script = installed("pc/make-group");
  std::error_code failed;
  return std::filesystem::exists(script, failed) ? fmt::format("sudo '{}'", script.string())
                                                 : packages_remedy("./tact_*.deb");
}

/// The rights of that group: real-time priority, locked memory, no deep sleep of the CPU.
inline std::string rights_remedy(const std::string& root = {}) {
  if (const Container* in = container_of(root))
    return in->name[0] == 'l'
               ? "the container's settings on its host must allow rtprio 85, memlock unlimited and "
                 "/dev/cpu_dma_latency"
               : fmt::format(
                     "start the container by {} run --cap-add=SYS_NICE --ulimit rtprio=85 "
                     "--ulimit memlock=-1 --device /dev/cpu_dma_latency",
                     in->name);
  return fmt::format("{}{}sudo adduser $USER haptics, then log in again",
                     getgrnam("haptics") != nullptr ? "" : group_remedy(),
                     getgrnam("haptics") != nullptr ? "" : ", ");
}

}  // namespace tact::model::io
