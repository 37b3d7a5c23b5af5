#include "firmware/environment.h"

#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>

#include "firmware/rt_setup.h"

namespace tact::firmware {
namespace {

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line.empty() ? "unknown" : line;
}

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

}  // namespace

Environment read_environment(const std::string& scene_hash) {
  utsname name{};
  uname(&name);
  return {.kernel_release = name.release,
          .kernel_version = name.version,
          .realtime_kernel = kernel_is_realtime(),
          .cpu = cpu_name(),
          .cores = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN)),
          .clock_source =
              first_line("/sys/devices/system/clocksource/clocksource0/current_clocksource"),
          .git_revision = TACT_GIT_REVISION,
          .compiler = __VERSION__,
          .scene_hash = scene_hash};
}

}  // namespace tact::firmware
