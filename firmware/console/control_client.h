// SPDX-License-Identifier: Apache-2.0
// control_client.h - asks the tactd that runs a scene: the side of `tactctl`.
#pragma once

#include "firmware/console/control_socket.h"

namespace tact::firmware::console {

struct ControlQuestion {
  std::string folder;      // the runtime folder of the user whose tactd it is
  std::string scene_path;  // as tactd was given it, by whatever path
  pid_t process = 0;       // 0: the only one that runs the scene
  std::string word;        // arm, disarm, reset, stop, status
};

/// What tactd answered; an error: there is none, or several, or it does not answer within 5 s.
model::Result<Answer> ask_tactd(const ControlQuestion& question);

}  // namespace tact::firmware::console
