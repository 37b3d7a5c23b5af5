// SPDX-License-Identifier: Apache-2.0
#include "tools/chart/compare/tool_check.h"

#include <cmath>

#include "firmware/loop/controller.h"
#include "model/scene/scene_strokes.h"
#include "model/scene/tissue.h"
#include "tools/ground_truth/reference_fits.h"
#include "tools/program/interrupt.h"
#include "tools/program/run_program.h"

namespace tact::tools::chart {
namespace {

using ground_truth::tool_at;
using ground_truth::ToolPoint;
using ground_truth::ToolReference;
using model::Result;
using model::Tool;
using model::Vec3;
using model::scene::Scene;

constexpr double kSpeed_mps = 0.02;  // of a press stroke (tool_check.h)
constexpr double kAbove_m = 0.003;   // where the way begins

/// As the reference is: elastic, linear, without friction.
Scene reference_scene(Scene scene) {
  scene.relaxation.clear();
  scene.contact.friction_ratio = 0.0;
  scene.compliance.large_strain = false;
  return scene;
}

/// The force against the way, from above down to each depth.
class Press {
 public:
  Press(const Scene& scene, const model::scene::Tissue& tissue, const ToolPoint& place)
      : scene_(scene),
        place_(place),
        contact_(tissue.contact_scene()),
        is_stepped_(tissue.law().curve() == nullptr) {}

  double force_at(double depth_m) {
    const double step_m = kSpeed_mps / scene_.rate_Hz;
    // Tick by tick, as a hand brings it: contact remembers where it touched first.
    while (at_m_ + step_m < depth_m) tick(at_m_ += step_m);
    at_m_ = depth_m;
    return settle(is_stepped_, [&] { return tick(depth_m); }).force_N;
  }

 private:
  double tick(double depth_m) {
    const Tool tool = tool_at(scene_, place_, depth_m);
    contact_.detect_contact(tool);
    return -dot(contact_.render_force(tool, false).wrench.force_N, place_.direction);
  }

  const Scene& scene_;
  const ToolPoint& place_;
  model::contact::Contact contact_;
  bool is_stepped_;
  double at_m_ = -kAbove_m;
};

/// A tool that goes round over the hand's site while it sinks in and comes back.
std::vector<Tool> moving_tool(const Scene& scene, const ToolPoint& place) {
  constexpr std::size_t kTurnTicks = 1000;
  constexpr double kTurnRadius_m = 0.004, kShallow_m = 0.001, kDeep_m = 0.009;
  const Vec3 side = std::abs(place.direction.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 e1 = normalized(cross(place.direction, side)), e2 = cross(place.direction, e1);
  std::vector<Tool> path;
  for (std::size_t i = 0; i < kTurnTicks; ++i) {
    const double turn_rad = 2.0 * M_PI * static_cast<double>(i) / kTurnTicks;
    const double depth_m =
        kShallow_m + (kDeep_m - kShallow_m) * 0.5 * (1.0 - std::cos(2.0 * turn_rad));
    path.push_back(tool_at(scene, place, depth_m));
    path.back().position_m += kTurnRadius_m * (std::cos(turn_rad) * e1 + std::sin(turn_rad) * e2);
  }
  return path;
}

/// As the first place of a reference.
ToolPoint hands_place(const Scene& scene) {
  return {.vertex = {},
          .point_m = scene.hand_site_m - scene.organ.position_m,
          .direction = scene.hand_inward,
          .orientation = {},
          .cases = {}};
}

}  // namespace

Result<Timing> time_tool(const Scene& scene, const TimingSettings& settings) {
  const auto tissue = make_tissue(scene);
  if (!tissue) return tissue.error();
  firmware::loop::Controller controller(
      (*tissue)->contact_scene(), firmware::gate::Gate(scene.limits, 1.0 / scene.rate_Hz, 1.0),
      /*hard_real_time=*/false);
  const std::vector<Tool> path = moving_tool(scene, hands_place(scene));
  firmware::loop::TickInput input;
  input.sample.fresh = true;
  const auto tick = [&](const Tool& tool) {
    input.sample.tool = tool;
    return controller.tick(input);
  };
  // From outside: a tool that starts in the organ has no force. The first tick makes it ready.
  for (double above_m = 2.0 * kAbove_m; above_m > 0.0; above_m -= kSpeed_mps / scene.rate_Hz) {
    Tool tool = path.front();
    tool.position_m -= above_m * scene.hand_inward;
    tick(tool);
    input.commands.arm = true;
  }
  if (!(norm(tick(path.front()).wanted.force_N) > 0.0))
    return model::Error{scene.path +
                        ": the tool is not in contact with the organ where it is timed"};
  std::size_t at = 0;
  return measure_time(
      [&] {
        at = at + 1 == path.size() ? 0 : at + 1;
        tick(path[at]);
      },
      settings);
}

Result<std::vector<double>> press_tool(const Scene& scene, const ToolReference& reference) {
  if (auto differs = check_tool_reference_fits(reference, scene)) return std::move(*differs);
  const Scene elastic = reference_scene(scene);
  const auto tissue = make_tissue(elastic);
  if (!tissue) return tissue.error();
  std::vector<double> force_N;
  for (const ToolPoint& place : reference.places) {
    Press press(elastic, **tissue, place);
    for (const ground_truth::ToolCase& at : place.cases) {
      if (program::is_interrupted()) return program::interruption();
      force_N.push_back(press.force_at(at.depth_m));
    }
  }
  return force_N;
}

}  // namespace tact::tools::chart
