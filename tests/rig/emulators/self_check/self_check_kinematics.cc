// SPDX-License-Identifier: Apache-2.0
// self_check_kinematics.cc - the vectors of both mechanisms: inverse, forward, K, statics, gravity.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/rig/emulators/mechanics/delta_mechanism.h"
#include "tests/rig/emulators/mechanics/falcon_mechanism.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace tact::rig {
namespace {

using Json = nlohmann::json;

constexpr double kMaxStep_m = 0.005;

Vec3 vec3(const Json& array) { return {array[0], array[1], array[2]}; }
Joints joints(const Json& array) { return {array[0], array[1], array[2]}; }
double component(const Vec3& v, std::size_t i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

/// Newton on the inverse: dp = K^-1 dtheta, where column i of K^-1 is K_j x K_k / det K.
template <typename Inverse>
Vec3 forward(const Inverse& inverse, const Joints& theta_rad, Vec3 position_m) {
  for (int turn = 0; turn < 50; ++turn) {
    const auto pose = inverse(position_m);
    if (!pose) return Vec3{1.0, 1.0, 1.0} * std::numeric_limits<double>::quiet_NaN();
    const auto& k = pose->k_rad_per_m;
    const double det = model::dot(k[0], model::cross(k[1], k[2]));
    Vec3 step_m;
    for (std::size_t i = 0; i < 3; ++i)
      step_m += model::cross(k[(i + 1) % 3], k[(i + 2) % 3]) *
                ((theta_rad[i] - pose->theta_rad[i]) / det);
    // Not past the reach on the way to a pose near it.
    position_m += step_m * std::min(1.0, kMaxStep_m / std::max(1e-12, model::norm(step_m)));
  }
  return position_m;
}

void check_vec3(SelfCheck& check, const std::string& where, const Vec3& own, const Vec3& theirs,
                double tolerance) {
  for (std::size_t i = 0; i < 3; ++i)
    check.equal(where, component(own, i), component(theirs, i), tolerance);
}

void check_statics(SelfCheck& check, const Pose& pose, const Json& item, const Json& tolerance) {
  double largest = 0.0;
  for (const Json& row : item["K"])
    for (const Json& value : row) largest = std::max(largest, std::abs(value.get<double>()));
  for (std::size_t i = 0; i < 3; ++i)
    check_vec3(check, "K", pose.k_rad_per_m[i], vec3(item["K"][i]),
               tolerance["K_rel"].get<double>() * largest);
  const Joints tau = joints(item["tau"]), own = torque_of(pose, vec3(item["force"]));
  for (std::size_t i = 0; i < 3; ++i) check.equal("tau", own[i], tau[i], tolerance["tau_abs"]);
  check_vec3(check, "F of tau", force_of(pose, tau), vec3(item["force"]), 1e-6);
}

}  // namespace

void check_delta_kinematics(SelfCheck& check) {
  const Json vectors = check.load("kinematics_delta.json");
  const Json& tolerance = vectors["tolerance"];
  for (const auto& [name, device] : vectors["devices"].items()) {
    check.begin("Delta " + name);
    const Json& p = device["params"];
    const DeltaShape shape{.base_radius_m = p["rb"],
                           .platform_radius_m = p["rp"],
                           .upper_arm_m = p["la"],
                           .forearm_m = p["lb"],
                           .azimuth_rad = joints(p["phi"]),
                           .upper_arm_kg = p["m_arm"],
                           .upper_arm_com_m = p["com_arm"],
                           .forearm_kg = p["m_forearm"],
                           .platform_kg = p["m_platform"]};
    for (const Json& item : device["cases"]) {
      const bool reaches = item["reachable"];
      const Vec3 gravity = reaches && item.contains("gravity") ? vec3(item["gravity"]) : Vec3{};
      const auto pose = delta_pose(shape, vec3(item["p"]), gravity);
      check.equal("reachable", pose.has_value(), reaches, 0.0);
      if (!pose || !reaches) continue;
      for (std::size_t i = 0; i < 3; ++i)
        check.equal("theta", pose->theta_rad[i], item["theta"][i], tolerance["theta"]);
      if (!item.contains("K")) continue;
      check_statics(check, *pose, item, tolerance);
      // What holds the device against gravity undoes its weight.
      check_vec3(check, "weight", force_of(*pose, joints(item["tau_gravity"])), -pose->weight_N,
                 1e-6);
      const auto inverse = [&](const Vec3& q) { return delta_pose(shape, q, {}); };
      const Vec3 off = 0.02 * shape.upper_arm_m * Vec3{1.0, -1.0, 1.0};
      check_vec3(check, "forward", forward(inverse, pose->theta_rad, vec3(item["p"]) + off),
                 vec3(item["fk_far"]), tolerance["p"]);
    }
  }
}

void check_falcon_kinematics(SelfCheck& check) {
  const Json vectors = check.load("kinematics_falcon.json");
  const Json& tolerance = vectors["tolerance"];
  check.begin("Falcon poses");
  check.equal("rad per count", kFalconRadPerCount, vectors["constants"]["rad_per_count"], 1e-12);
  const auto of_counts = [](const Json& counts) {
    Joints theta{};
    for (std::size_t i = 0; i < 3; ++i)
      theta[i] = kFalconZero_rad + kFalconRadPerCount * counts[i].get<double>();
    return theta;
  };
  for (const Json& item : vectors["cases"]) {
    const auto pose = falcon_pose(vec3(item["p"]));
    check.equal("reachable", pose.has_value(), 1.0, 0.0);
    if (!pose) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      check.equal("theta", pose->theta_rad[i], item["theta1"][i], tolerance["theta"]);
      check.equal("counts", falcon_counts(pose->theta_rad[i]), item["counts_rounded"][i], 0.0);
    }
    check_statics(check, *pose, item, tolerance);
    check_vec3(check, "forward",
               forward(falcon_pose, of_counts(item["counts_rounded"]), vec3(item["p"])),
               vec3(item["p_from_counts"]), tolerance["fk_required_m"]);
  }
  check.begin("Falcon on its axis");
  for (const Json& item : vectors["symmetric"])
    check_vec3(check, "forward", forward(falcon_pose, of_counts(item["counts"]), {0.0, 0.0, 0.110}),
               vec3(item["p"]), tolerance["fk_required_m"]);
}

}  // namespace tact::rig
