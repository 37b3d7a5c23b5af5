// SPDX-License-Identifier: Apache-2.0
// scene_tasks.h - what an exercise asks of a person, one task after the other. The viewer shows
// and evaluates them by the frames of the telemetry; no force depends on one. Set-up code only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/mesh/mesh.h"
#include "model/reader/scene_reader.h"
#include "model/result.h"
#include "model/types.h"

namespace tact::model::scene {

inline constexpr std::size_t kMaxTasks = 16;
inline constexpr std::size_t kMaxTaskText = 120;  // bytes

struct Task {
  std::string text;
  Vec3 place_m{};         // of the organ; once placed, W
  double radius_m = 0.0;  // a contact point within it counts
  bool by_grip = false;   // the range of the grip ends it, else that of the force
  double force_min_N = 0.0, force_max_N = 0.0;
  double grip_min_ratio = 0.0, grip_max_ratio = 0.0;
  double hold_s = 0.0;
  reader::TextPosition position{};  // in the scene file
};

/// The keys of one [[task]].
void visit_task(reader::Keys& keys, Task& task);

/// Places go with the organ. Error: one that no contact can reach, or a force that the gate never
/// lets through.
std::optional<Error> place_tasks(std::vector<Task>& tasks, const mesh::SurfaceMesh& organ,
                                 const Vec3& organ_m, double force_limit_N);

}  // namespace tact::model::scene
