// SPDX-License-Identifier: Apache-2.0
// scene_number.h - a number of a scene as it was read, with what it may be.
#pragma once

#include <string>

namespace tact::model::reader {

class Keys;  // scene_reader.h

struct SceneNumber {
  std::string key;               // "rhombus.growth", as --set takes it
  std::string unit;              // "N/m"; empty of a number without one
  double value = 0.0;            // the default where the scene leaves the key out
  double low = 0.0, high = 0.0;  // both included
  bool is_whole = false;         // a count
  std::string meaning;
};

}  // namespace tact::model::reader
