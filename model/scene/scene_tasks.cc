// SPDX-License-Identifier: Apache-2.0
#include "model/scene/scene_tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tact::model::scene {
namespace {

constexpr Range kPlaces_m{-0.5, 0.5};
constexpr Range kRadii_m{0.001, 0.1};
constexpr Range kForces_N{0.01, 20.0};
constexpr Range kGrips{0.0, 1.0};
constexpr Range kHolds_s{0.0, 60.0};
constexpr std::array kEnds{
    Choice{"force", "the force on the hand is within force_min_N and force_max_N"},
    Choice{"grip", "the grip is within grip_min_ratio and grip_max_ratio"}};

/// Both keys, with the range that each may have.
void visit_range(reader::Keys& keys, const char* min_key, const char* max_key, Range range,
                 double& min_value, double& max_value) {
  keys.number(min_key, range, "least of the range that ends the task", min_value);
  keys.number(max_key, range, "most of the range that ends the task", max_value);
  if (!(min_value < max_value))
    keys.refuse({min_key, max_key},
                fmt::format("{} = {} must be below {} = {}; lower it or raise {}", min_key,
                            min_value, max_key, max_value, max_key));
}

}  // namespace

void visit_task(reader::Keys& keys, Task& task) {
  task.position = keys.position_of("place_m");
  keys.text("text", "what to do, at most 120 bytes; the viewer shows it", task.text);
  if (task.text.size() > kMaxTaskText)
    keys.refuse({"text"}, fmt::format("the text of a task has {} bytes; write at most {}",
                                      task.text.size(), kMaxTaskText));
  keys.vector("place_m", kPlaces_m, "where on the organ, in the frame of its mesh", task.place_m);
  keys.number("radius_m", kRadii_m, "a contact point so near to place_m counts", task.radius_m);
  keys.number("hold_s", kHolds_s, "so long within the range that ends it, in every frame",
              task.hold_s, Need::kOptional);
  keys.one_of("ends_by", kEnds, [&](std::size_t index) {
    task.by_grip = index == 1;
    if (task.by_grip)
      visit_range(keys, "grip_min_ratio", "grip_max_ratio", kGrips, task.grip_min_ratio,
                  task.grip_max_ratio);
    else
      visit_range(keys, "force_min_N", "force_max_N", kForces_N, task.force_min_N,
                  task.force_max_N);
  });
}

std::optional<Error> place_tasks(std::vector<Task>& tasks, const mesh::SurfaceMesh& organ,
                                 const Vec3& organ_m, double force_limit_N) {
  for (Task& task : tasks) {
    task.place_m += organ_m;
    if (!task.by_grip && task.force_min_N >= force_limit_N)
      return Error{fmt::format(
          "{}: force_min_N = {} of task \"{}\" is not below limits.force_N = {}; write a lower one",
          task.position.where, task.force_min_N, task.text, force_limit_N)};
    const Vec3 nearest_m = *std::ranges::min_element(
        organ.vertex_m, {},
        [&task](const Vec3& vertex_m) { return norm(vertex_m - task.place_m); });
    if (const double away_m = norm(nearest_m - task.place_m); away_m > task.radius_m)
      return Error{fmt::format(
          "{}: place_m of task \"{}\" is {:.4f} m from the organ's nearest vertex, more than "
          "radius_m = {}; write place_m = [{:.4f}, {:.4f}, {:.4f}], that vertex",
          task.position.where, task.text, away_m, task.radius_m, nearest_m.x - organ_m.x,
          nearest_m.y - organ_m.y, nearest_m.z - organ_m.z)};
  }
  return std::nullopt;
}

}  // namespace tact::model::scene
