// SPDX-License-Identifier: Apache-2.0
#include "hal/rights_remedy.h"

#include <fmt/format.h>
#include <grp.h>

#include <array>
#include <filesystem>
#include <system_error>

#include "hal/permission.h"
#include "model/io/program/installed.h"

namespace tact::hal {

const Container* container_of(const std::string& root) {
  static constexpr std::array<Container, 3> kAll{
      {{"/.dockerenv", "docker", true},
       {"/run/.containerenv", "podman", true},
       {"/run/systemd/container", "lxc or nspawn", false}}};
  std::error_code failed;
  for (const Container& one : kAll)
    if (std::filesystem::exists(root + one.mark, failed)) return &one;
  return nullptr;
}

std::string packages_remedy(const char* packages) {
  return fmt::format("{}sudo apt install {}",
                     first_line(model::io::program_folder() / "packages.remedy"), packages);
}

std::string group_remedy() {
  const auto script = model::io::installed("pc/make-group");
  std::error_code failed;
  return std::filesystem::exists(script, failed) ? fmt::format("sudo '{}'", script.string())
                                                 : packages_remedy("./tact_*.deb");
}

std::string rights_remedy(const std::string& root) {
  if (const Container* in = container_of(root))
    return in->has_run_command
               ? fmt::format(
                     "start the container by {} run --cap-add=SYS_NICE --ulimit rtprio=85 "
                     "--ulimit memlock=-1 --device /dev/cpu_dma_latency",
                     in->name)
               : "the container's settings on its host must allow rtprio 85, memlock unlimited and "
                 "/dev/cpu_dma_latency";
  const std::string group = getgrnam("haptics") != nullptr ? "" : group_remedy() + ", ";
  return group + "sudo adduser $USER haptics, then log in again";
}

}  // namespace tact::hal
