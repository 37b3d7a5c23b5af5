// SPDX-License-Identifier: Apache-2.0
// control_name.h - where a running tactd listens to its operator, and how `tactctl SCENE` finds it.
//
//     control-PID-HASH.sock   in the runtime folder, which only its owner can open
//
// HASH is that of the scene file's whole path, so every tactd of a scene is found, on whatever
// device, the simulated one included.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace tact::firmware::console {

struct ControlName {
  pid_t process = 0;
  std::string path;
};

std::string control_path(const std::string& folder, const std::string& scene_path, pid_t process);
/// Those of this scene in the folder; some may be left over from a tactd that was killed.
std::vector<ControlName> find_controls(const std::string& folder, const std::string& scene_path);
/// Takes away what dead ones left, of whatever scene.
void remove_dead_controls(const std::string& folder);

}  // namespace tact::firmware::console
