// SPDX-License-Identifier: Apache-2.0
#include "hal/mounting.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "model/units.h"

namespace tact::hal {
namespace {

constexpr double kNearly_rad = 0.1745;  // 10 degrees: what is called a direction of the room

/// Without -0, as a person reads it.
double plain(double value) { return std::abs(value) < 5e-4 ? 0.0 : value; }

std::string text_of(const Vec3& v) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", plain(v.x), plain(v.y), plain(v.z));
}

struct Stance {
  Vec3 axis_W;
  const char* words;
  const char* brief;
};
constexpr std::array<Stance, 6> kStances{
    {{{1, 0, 0}, "lies on its side, its axis points towards you", ""},
     {{-1, 0, 0}, "lies on its side, its axis points away from you", "axis away"},
     {{0, 1, 0}, "lies on its side, its axis points to the right", "axis right"},
     {{0, -1, 0}, "lies on its side, its axis points to the left", "axis left"},
     {{0, 0, 1}, "is upright, its axis points up", "upright"},
     {{0, 0, -1}, "hangs from above, its axis points down", "hangs"}}};

/// Null: along none of the six.
const Stance* stance_of(const Mounting& m) {
  const Vec3 axis_W = m.direction_W({1, 0, 0});
  for (const Stance& stance : kStances)
    if (dot(axis_W, stance.axis_W) > std::cos(kNearly_rad)) return &stance;
  return nullptr;
}

/// ", hangs, motion x 3": behind the name of the device, on the page and wherever it is named.
std::string brief_of(const Mounting& m) {
  const Stance* const stance = stance_of(m);
  std::string_view pose = stance != nullptr ? stance->brief : "tilted";
  if (pose.empty() && std::abs(m.turn.w) < 1.0 - 1e-9) pose = "turned";  // about its own axis
  std::string out = pose.empty() ? "" : fmt::format(", {}", pose);
  if (m.scale != 1.0) out += fmt::format(", motion x {:g}", m.scale);
  return out;
}

}  // namespace

Vec3 Mounting::gravity_in_base_mps2() const RT_SAFE {
  return direction_in_base({0.0, 0.0, -model::kGravity_mps2});
}

Mounting mounting_of(const model::DeviceSettings& settings) {
  return {.turn = model::quat_from_rotation_vector(std::numbers::pi / 180.0 *
                                                   settings.base_orientation_deg),
          .shift_m = settings.base_position_m,
          .scale = settings.motion_scale};
}

std::string text_of(const Mounting& m) {
  const Stance* const stance = stance_of(m);
  const std::string pose = stance != nullptr
                               ? stance->words
                               : fmt::format("is tilted, its axis points along {} of W",
                                             text_of(m.direction_W({1, 0, 0})));
  std::string out = fmt::format("the base {}; down is {} in its own axes", pose,
                                text_of(m.direction_in_base({0, 0, -1})));
  if (m.shift_m != Vec3{}) out += fmt::format("; its origin is at {} m of W", text_of(m.shift_m));
  if (m.scale != 1.0)
    out += fmt::format(
        "; the tool goes {0:g} times the way of the handle, and the hand gets {0:g} "
        "times the tool's force",
        m.scale);
  return out;
}

DeviceInfo mounted(DeviceInfo info, const Mounting& m) {
  const double s = m.scale;
  info.name += brief_of(m);
  info.max_force_N /= s;
  info.max_continuous_force_N /= s;
  info.motion_scale = s;
  // A cylinder about a, radius r and half length h, holds k times itself about x if
  //     k (h |a_x| + r b) <= h   and   k (h b + r) <= r,   b = sqrt(1 - a_x^2)
  const double r = info.workspace_radius_m, h = info.workspace_half_length_m;
  const double a_x = std::min(std::abs(m.direction_W({1, 0, 0}).x), 1.0);
  const double b = a_x > 1.0 - 1e-12 ? 0.0 : std::sqrt(1.0 - a_x * a_x);
  const double k =
      r > 0.0 && h > 0.0 ? std::min({1.0, h / (h * a_x + r * b), r / (h * b + r)}) : 0.0;
  const Vec3 t = m.shift_m;
  info.workspace_radius_m = std::max(s * k * r - std::hypot(t.y, t.z), 0.0);
  info.workspace_half_length_m = std::max(s * k * h - std::abs(t.x), 0.0);
  if (info.at_tool) {
    // F_W = F_B / s and v_W = s v_B: a damping b of the handle is b / s^2 at the tool.
    info.at_tool->damping_Ns_per_m /= s * s;
    info.at_tool->friction_N /= s;
    info.at_tool->position_step_m *= s;
  }
  return info;
}

}  // namespace tact::hal
