// SPDX-License-Identifier: Apache-2.0
// control_name.h - the name of a tactd's control socket, by which `tactctl SCENE` finds it.
//
//     control-PID-HASH.sock   in the runtime folder, which only its owner can open
//
// HASH is the hash of the scene file's absolute path, so every tactd of a scene is found, with any
// device.
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
/// The sockets of this scene in the folder, including those left by a killed tactd.
std::vector<ControlName> find_controls(const std::string& folder, const std::string& scene_path);
/// Removes the sockets that killed tactds left, of any scene.
void remove_dead_controls(const std::string& folder);

}  // namespace tact::firmware::console
