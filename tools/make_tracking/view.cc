// SPDX-License-Identifier: Apache-2.0
// What two cameras make of the motion, and what goes wrong with it. Chance hides single markers for
// a while and throws one far off now and then. By plan:
//
//      9.0 .. 10.2 s  the waist is behind the table's edge: nothing comes, it is lost
//     14.13           two looks at the shoulder change places on the way
//     18.0 .. 18.4    a hand before the markers: three of them are left
//     22.1            the head is seen in a mirror, a metre away
//     25.0 .. 26.2    the front camera repeats itself for the shoulder
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "tools/make_tracking/seen_operator.h"

namespace tact::tools::make_tracking {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using host::pose::Camera;
using host::pose::Pose;

constexpr unsigned kSeed = 6;
constexpr double kHide_ratio = 0.006;    // of the looks in which a marker goes out of sight ...
constexpr int kHiddenLooks = 12;         // ... for so many
constexpr double kOutlier_ratio = 0.01;  // of the looks have one marker far off
constexpr double kOutlier_px = 45.0;
constexpr std::size_t kLeftOver = 3;  // markers

constexpr Camera kLens{.fx_px = 2000.0, .fy_px = 2000.0, .cx_px = 960.0, .cy_px = 540.0};

// Upright camera, from one place to another.
TrackingCamera camera(const char* name, const Vector3d& from_m) {
  const Vector3d look_at_m(0.30, 0.02, 0.26);
  const Vector3d ahead = (look_at_m - from_m).normalized();
  const Vector3d right = ahead.cross(Vector3d::UnitZ()).normalized();
  Matrix3d axes;  // 3 x 3, columns: right, down, ahead
  axes << right, ahead.cross(right), ahead;
  return {.name = name,
          .lens = kLens,
          .pose = {.rotation = host::pose::canonical(Quaterniond(axes)), .position_m = from_m}};
}

Vector2d pixel(const TrackingCamera& eye, const Vector3d& p_W_m) {
  const Vector3d x = host::pose::to_local(eye.pose, p_W_m);
  return {eye.lens.fx_px * x.x() / x.z() + eye.lens.cx_px,
          eye.lens.fy_px * x.y() / x.z() + eye.lens.cy_px};
}

bool is_within(double time_s, double from_s, double to_s) {
  return time_s >= from_s - 1e-6 && time_s < to_s - 1e-6;
}

class Cameraman {
 public:
  std::vector<Sight> film() {
    for (int frame = 0; frame < kFrames; ++frame) {
      for (const TrackedBody& body : tracked_bodies())
        if (frame % body.every == body.first) look_at(body, frame);
    }
    for (std::size_t i = 0; i + 1 < film_.size(); ++i) change_places(i);
    return std::move(film_);
  }

 private:
  void look_at(const TrackedBody& body, int frame) {
    const auto eyes = tracking_cameras();
    const std::size_t which = static_cast<std::size_t>(frame) % eyes.size();
    const double ahead_s = which == 0 ? 1.0 / kFrames_Hz - kApart_s : 0.0;
    Sight sight{.time_s = frame / kFrames_Hz + ahead_s,
                .sequence = frame / static_cast<int>(eyes.size()),
                .camera = &eyes[which],
                .body = &body,
                .points = {}};
    const std::string name = body.name;
    Pose pose = body_pose(body, sight.time_s);
    if (name == "head" && is_within(sight.time_s, 22.1, 22.13)) pose.position_m.y() -= 1.0;
    for (std::size_t id = 0; id < body.marker_m.size(); ++id) {
      Vector2d p_px = pixel(eyes[which], host::pose::to_world(pose, body.marker_m[id]));
      const double down = normal_(random_), right = normal_(random_);
      p_px += kNoise_px * Vector2d(right, down);
      if (!is_hidden(name, id)) sight.points.push_back({static_cast<int>(id), p_px});
    }
    spoil(sight);
    if (name == "waist" && is_within(sight.time_s, 9.0, 10.2)) return;
    if (name == "hand" && is_within(sight.time_s, 18.0, 18.4)) sight.points.resize(kLeftOver);
    if (name == "shoulder" && is_within(sight.time_s, 25.0, 26.2)) {
      if (still_.empty()) still_ = sight.points;
      sight.points = still_;
    }
    film_.push_back(sight);
  }

  // Each draw is made whether it is needed or not, so that a change of plan changes no more.
  bool is_hidden(const std::string& body, std::size_t id) {
    int& left = hidden_[{body, id}];
    if (share_(random_) < kHide_ratio && left == 0) left = kHiddenLooks;
    if (left == 0) return false;
    --left;
    return true;
  }

  void spoil(Sight& sight) {
    const double chance = share_(random_), which = share_(random_), way_rad = 6.0 * share_(random_);
    if (chance > kOutlier_ratio || sight.points.empty()) return;
    const auto i = static_cast<std::size_t>(which * static_cast<double>(sight.points.size()));
    sight.points[i].pixel_px += kOutlier_px * Vector2d(std::cos(way_rad), std::sin(way_rad));
  }

  void change_places(std::size_t i) {
    const auto is_it = [&](std::size_t k) {
      return film_[k].body->name == std::string("shoulder") &&
             is_within(film_[k].time_s, 14.13, 14.16);
    };
    if (swapped_ || !is_it(i)) return;
    for (std::size_t k = i + 1; k < film_.size(); ++k) {
      if (film_[k].body != film_[i].body) continue;
      std::swap(film_[i], film_[k]);
      swapped_ = true;
      return;
    }
  }

  std::mt19937 random_{kSeed};  // NOLINT(bugprone-random-generator-seed): the same run every time
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> share_;
  std::map<std::pair<std::string, std::size_t>, int> hidden_;  // looks left
  std::vector<SeenPoint> still_;
  std::vector<Sight> film_;
  bool swapped_ = false;
};

}  // namespace

Pose registration() {
  // The tracker's y is up and its -z looks past the operator; its origin stands on the floor.
  const Quaterniond rotation(AngleAxisd(25.0 * std::numbers::pi / 180.0, Vector3d::UnitZ()) *
                             AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()));
  return {.rotation = host::pose::canonical(rotation), .position_m = {-0.8, 0.6, -0.95}};
}

std::span<const TrackingCamera> tracking_cameras() {
  static const std::vector<TrackingCamera> eyes{camera("front", {-1.35, -0.60, 0.85}),
                                                camera("side", {0.50, 1.98, 0.75})};
  return eyes;
}

// NOLINTNEXTLINE(readability-function-size): a table of markers
std::span<const TrackedBody> tracked_bodies() {
  // Each on stalks, no two alike, and their middle near the body's origin.
  static const std::vector<TrackedBody> bodies{{"head",
                                                {{0.11, 0.06, 0.03},
                                                 {0.10, -0.07, 0.05},
                                                 {-0.10, 0.07, 0.06},
                                                 {-0.11, -0.05, 0.02},
                                                 {0.02, 0.13, -0.04},
                                                 {-0.01, -0.13, -0.05},
                                                 {0.04, 0.01, 0.13},
                                                 {-0.05, -0.02, -0.12}},
                                                1,
                                                0},
                                               {"shoulder",
                                                {{0.10, 0.04, 0.06},
                                                 {0.09, -0.08, 0.02},
                                                 {-0.11, 0.05, 0.04},
                                                 {-0.09, -0.06, 0.07},
                                                 {0.03, 0.11, -0.06},
                                                 {-0.04, -0.10, -0.08},
                                                 {0.05, 0.02, 0.12},
                                                 {-0.03, 0.03, -0.11}},
                                                2,
                                                0},
                                               {"waist",
                                                {{0.13, 0.05, 0.05},
                                                 {0.11, -0.09, 0.03},
                                                 {-0.12, 0.06, 0.07},
                                                 {-0.12, -0.07, 0.02},
                                                 {0.03, 0.15, -0.06},
                                                 {-0.02, -0.15, -0.04},
                                                 {0.05, 0.01, 0.12},
                                                 {-0.06, 0.02, -0.13}},
                                                2,
                                                1},
                                               {"hand",
                                                {{0.08, 0.04, 0.04},
                                                 {0.07, -0.06, 0.03},
                                                 {-0.08, 0.05, 0.05},
                                                 {-0.07, -0.05, 0.02},
                                                 {0.02, 0.09, -0.04},
                                                 {-0.01, -0.09, -0.06},
                                                 {0.03, 0.01, 0.09},
                                                 {-0.04, 0.02, -0.08}},
                                                1,
                                                0}};
  return bodies;
}

std::vector<Sight> look() { return Cameraman().film(); }

}  // namespace tact::tools::make_tracking
