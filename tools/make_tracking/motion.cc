// SPDX-License-Identifier: Apache-2.0
// The operator's motion: he leans over the cover, presses, looks to his right for the manual, bends
// to the left to see the gasket from the side, looks up, and comes back to where he began.
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "tools/make_tracking/seen_operator.h"

namespace tact::tools::make_tracking {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using host::pose::Pose;

struct Key {
  double time_s = 0.0, value = 0.0;
};

// From key to key with rest at each.
double along(std::span<const Key> keys, double time_s) {
  std::size_t i = 1;
  while (i + 1 < keys.size() && keys[i].time_s < time_s) ++i;
  const Key &a = keys[i - 1], &b = keys[i];
  const double x = std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0);
  return a.value + (b.value - a.value) * x * x * (3.0 - 2.0 * x);
}

// Nobody stands still: `waves` whole waves in the recording.
double sway(double time_s, double waves, double phase_rad) {
  return std::sin(2.0 * std::numbers::pi * waves * time_s / kLength_s + phase_rad);
}

// Degrees and metres. Forward is -x: to lean forward turns about -y, to look right about -z.
constexpr std::array<Key, 9> kLean{
    {{0, 0}, {5, 0}, {8, 14}, {12, 14}, {15, -2}, {19, -3}, {22, 8}, {26, 8}, {30, 0}}};
constexpr std::array<Key, 5> kTilt{{{0, 0}, {19, 0}, {22, 11}, {26, 11}, {30, 0}}};
constexpr std::array<Key, 5> kTwist{{{0, 0}, {12, 0}, {15, 12}, {18, 12}, {21, 0}}};
constexpr std::array<Key, 8> kNod{
    {{0, 43}, {5, 43}, {8, 52}, {12, 52}, {14, 8}, {18, 8}, {20, 43}, {30, 43}}};
constexpr std::array<Key, 10> kLook{{{0, 0},
                                     {2.5, 14},
                                     {5, 0},
                                     {12, 0},
                                     {14.5, 40},
                                     {17.5, 40},
                                     {20, 0},
                                     {26, 0},
                                     {27.5, -28},
                                     {30, 0}}};
constexpr std::array<Key, 5> kBack{
    {{0, 0}, {5, 0}, {8, 0.05}, {12, 0.05}, {15, 0}}};  // of the hips
constexpr std::array<Key, 5> kSide{{{0, 0}, {19, 0}, {22, -0.06}, {26, -0.06}, {30, 0}}};

// The tool's tip in one round of the scene's strokes: maintenance.toml, [[hand.stroke]].
constexpr double kRound_s = 10.0;
constexpr std::array<Key, 8> kTipX{
    {{0, 0.006}, {1.2, 0}, {2, 0}, {3, 0.006}, {4, 0}, {5.5, 0}, {7.5, 0}, {10, 0.006}}};
constexpr std::array<Key, 5> kTipY{{{0, 0}, {4, 0}, {5.5, 0.02}, {7.5, -0.02}, {10, 0}}};
constexpr std::array<Key, 8> kTipZ{{{0, 0.022},
                                    {1.2, -0.0045},
                                    {2, -0.0045},
                                    {3, 0.022},
                                    {4, -0.003},
                                    {5.5, -0.003},
                                    {7.5, -0.003},
                                    {10, 0.022}}};

// A man of 1.75 m: places on the body, by the shares of host/figure/body_plan.h.
const Vector3d waist_m(0.45, -0.0875, -0.05);
const Vector3d neck_m(0.0, 0.0, 0.417);        // from the waist, in the trunk's axes
const Vector3d shoulder_m(0.0, 0.226, 0.417);  // the right one
const Vector3d head_m(0.0, 0.0, 0.167);        // from the neck
const Vector3d hand_m(0.035, 0.010, 0.120);    // from the tip, where the handle is held

Quaterniond turned(double degrees, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

Pose waist_pose(double t) {
  const Vector3d shift_m(along(kBack, t) + 0.004 * sway(t, 7, 0.4),
                         along(kSide, t) + 0.006 * sway(t, 5, 1.0), 0.002 * sway(t, 9, 2.0));
  // Hips turn and tilt by a third of what the trunk does.
  const Quaterniond rotation = turned(-along(kTwist, t) / 3.0, Vector3d::UnitZ()) *
                               turned(along(kTilt, t) / 3.0, Vector3d::UnitX()) *
                               turned(-along(kLean, t) / 3.0, Vector3d::UnitY());
  return {.rotation = rotation, .position_m = waist_m + shift_m};
}

Pose trunk_pose(double t) {
  const double breath_deg = 0.5 * sway(t, 8, 0.0);
  const Quaterniond rotation = turned(-along(kTwist, t), Vector3d::UnitZ()) *
                               turned(along(kTilt, t), Vector3d::UnitX()) *
                               turned(-along(kLean, t) + breath_deg, Vector3d::UnitY());
  return {.rotation = rotation, .position_m = waist_pose(t).position_m};
}

Pose head_pose(double t) {
  const Pose trunk = trunk_pose(t);
  // The head looks where it wants to, wherever the trunk leans.
  const Quaterniond rotation = turned(-along(kLook, t) - along(kTwist, t), Vector3d::UnitZ()) *
                               turned(0.4 * along(kTilt, t), Vector3d::UnitX()) *
                               turned(-along(kNod, t) + 1.0 * sway(t, 11, 0.7), Vector3d::UnitY());
  return {.rotation = rotation,
          .position_m = host::pose::to_world(trunk, neck_m) + rotation * head_m};
}

Pose hand_pose(double t) {
  const double round_s = std::fmod(t, kRound_s);
  const Vector3d tip_m(along(kTipX, round_s), along(kTipY, round_s), along(kTipZ, round_s));
  const Quaterniond rotation = turned(3.0 * sway(t, 6, 0.2), Vector3d::UnitZ()) *
                               turned(2.0 * sway(t, 9, 1.1), Vector3d::UnitY());
  return {.rotation = rotation, .position_m = tip_m + hand_m};
}

Pose shoulder_pose(double t) {
  // It comes forward a little while the hand is down.
  const double down_m = kTipZ.front().value - along(kTipZ, std::fmod(t, kRound_s));
  const Pose trunk = trunk_pose(t);
  return {.rotation = trunk.rotation,
          .position_m = host::pose::to_world(trunk, shoulder_m - 0.5 * down_m * Vector3d::UnitX())};
}

}  // namespace

Pose body_pose(const TrackedBody& body, double time_s) {
  const double t = std::fmod(time_s, kLength_s);
  const std::string name = body.name;
  if (name == "head") return head_pose(t);
  if (name == "shoulder") return shoulder_pose(t);
  if (name == "waist") return waist_pose(t);
  return hand_pose(t);
}

}  // namespace tact::tools::make_tracking
