// SPDX-License-Identifier: Apache-2.0
// control_client.h - sends one request to the tactd that runs a scene: the client side of tactctl.
#pragma once

#include "firmware/console/control_socket.h"

namespace tact::firmware::console {

struct ControlQuestion {
  std::string folder;      // the runtime folder of tactd's user
  std::string scene_path;  // any path to the scene file
  pid_t process = 0;       // 0: the only tactd that runs the scene
  std::string word;        // arm, disarm, reset, stop, status, "set KEY=VALUE ..." or "event N"
};

/// tactd's answer; an error if there is no such tactd, if there are several, or after 5 s
/// (60 s of `set`, whose law is computed first).
model::Result<Answer> ask_tactd(const ControlQuestion& question);

}  // namespace tact::firmware::console
