// SPDX-License-Identifier: Apache-2.0
#include "firmware/console/control_name.h"

#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>

#include "model/fnv1a.h"
#include "model/io/socket_file.h"

namespace tact::firmware::console {
namespace {

constexpr std::string_view kBegin = "control-", kEnd = ".sock";

/// "-HASH.sock" of a scene.
std::string end_of(const std::string& scene_path) {
  std::error_code failed;
  // Absolute and without links, because tactd and tactctl may be given different paths to one file.
  const auto whole = std::filesystem::weakly_canonical(scene_path, failed);
  return fmt::format("-{:016x}{}", model::fnv1a(failed ? scene_path : whole.string()), kEnd);
}

std::vector<ControlName> controls_that_end_in(const std::string& folder, std::string_view end) {
  std::vector<ControlName> found;
  std::error_code failed;
  // increment(), as ++ throws; either makes the end of it.
  for (std::filesystem::directory_iterator at(folder, failed), end_of_folder; at != end_of_folder;
       at.increment(failed)) {
    const std::string name = at->path().filename();
    if (!name.starts_with(kBegin) || !name.ends_with(end)) continue;
    pid_t process = 0;
    // from_chars stops at the next dash; without digits `process` stays 0.
    std::from_chars(name.data() + kBegin.size(), name.data() + name.size(), process);
    found.push_back({.process = process, .path = at->path()});
  }
  std::ranges::sort(found, {}, &ControlName::process);
  return found;
}

/// The socket file of a killed process remains: only a connection attempt shows that it is dead.
bool is_abandoned(const std::string& path) {
  const auto address = model::io::socket_address(path);
  const int probe = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  // Only ECONNREFUSED means that no process listens; a full queue means a live process.
  const bool dead = address && probe >= 0 &&
                    connect(probe, model::io::plain(*address), sizeof *address) != 0 &&
                    errno == ECONNREFUSED;
  if (probe >= 0) close(probe);
  return dead;
}

}  // namespace

std::string control_path(const std::string& folder, const std::string& scene_path, pid_t process) {
  return fmt::format("{}/{}{}{}", folder, kBegin, process, end_of(scene_path));
}

std::vector<ControlName> find_controls(const std::string& folder, const std::string& scene_path) {
  return controls_that_end_in(folder, end_of(scene_path));
}

void remove_dead_controls(const std::string& folder) {
  for (const ControlName& control : controls_that_end_in(folder, kEnd))
    if (is_abandoned(control.path)) unlink(control.path.c_str());
}

}  // namespace tact::firmware::console
