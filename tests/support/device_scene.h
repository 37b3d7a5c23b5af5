// SPDX-License-Identifier: Apache-2.0
// device_scene.h - the liver on a delta on CAN, as a person writes it: tools/deploy/devices.toml.
#pragma once

#include <string>

#include "tests/support/files.h"

namespace tact::tests {

/// The scene with the sections of all real devices in place of its [device]; kind = "can-odrive".
inline std::string scene_on_real_devices() {
  const std::string root = TACT_SOURCE_DIR, scenes = root + "/model/scenes/";
  std::string text = content(scenes + "liver.toml");
  const std::string meshes = "\"meshes/";  // named from another folder
  for (auto at = text.find(meshes); at != text.npos; at = text.find(meshes, at + scenes.size()))
    text.insert(at + 1, scenes);
  const auto section = text.find("[device]"), next = text.find("# Soft tissue needs");
  if (section == text.npos || next == text.npos) return {};
  return text.substr(0, section) + content(root + "/tools/deploy/devices.toml") + text.substr(next);
}

/// The same without a line, as one that was forgotten.
inline std::string without_line(std::string text, const std::string& beginning) {
  const auto at = text.find("\n" + beginning);
  if (at != text.npos) text.erase(at, text.find('\n', at + 1) - at);
  return text;
}

}  // namespace tact::tests
