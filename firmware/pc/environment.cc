// SPDX-License-Identifier: Apache-2.0
#include "firmware/pc/environment.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <sstream>

#include "firmware/pc/pc_files.h"
#include "model/io/program/command_line.h"

namespace tact::firmware::pc {
namespace {

std::string line_of(const char* path) { return PcFiles{}.line(path).value_or("unknown"); }

/// A field of the first CPU; /proc/cpuinfo has a paragraph for each, with equal fields.
std::string cpu_fact(const std::string& name) {
  std::istringstream file(PcFiles{}.text("/proc/cpuinfo").value_or(""));
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with(name) && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Environment read_environment(const std::string& scene_hash) {
  utsname name{};
  uname(&name);
  return {
      .kernel_release = name.release,
      .kernel_version = name.version,
      .realtime_kernel = is_realtime_kernel(PcFiles{}),
      .cpu = cpu_fact("model name"),
      .cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)),
      .clock_source = line_of("/sys/devices/system/clocksource/clocksource0/current_clocksource"),
      .microcode = cpu_fact("microcode"),
      .boot_parameters = line_of("/proc/cmdline"),
      .git_revision = model::io::source_revision(),
      .compiler = model::io::compiler_version(),
      .scene_hash = scene_hash};
}

}  // namespace tact::firmware::pc
