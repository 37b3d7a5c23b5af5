// SPDX-License-Identifier: Apache-2.0
// The published cases of tracking: coordinate chain, pose from points, leg, chain of bones.
#include <limits>

#include "host/figure/ccd.h"
#include "host/figure/limb.h"
#include "host/pose/coordinate_chain.h"
#include "host/pose/epnp.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace tracking_cases {

using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using host::figure::JointKind;
using host::pose::Pose;
using nlohmann::json;

Vector2d vector_2(const json& v) { return {number(v.at(0)), number(v.at(1))}; }
Vector3d vector_3(const json& v) { return {number(v.at(0)), number(v.at(1)), number(v.at(2))}; }
Vector3d in_plane(const json& v) { return {number(v.at(0)), number(v.at(1)), 0.0}; }

/// The first `count` coordinates.
template <typename Vector>
json list(const Vector& v, Eigen::Index count = Vector::RowsAtCompileTime) {
  json out = json::array();
  for (Eigen::Index i = 0; i < count; ++i) out.push_back(v[i]);
  return out;
}
// w first, as the files have it; Eigen stores it last.
json list(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

Pose pose_of(const json& inputs, const char* rotation, const char* position) {
  const auto q = host::pose::rotation_from(inputs.at(rotation).get<std::array<double, 4>>());
  // A quaternion that is refused becomes NaN, which equals nothing but the file's own NaN.
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {.rotation = q.value_or(Quaterniond(nan, nan, nan, nan)),
          .position_m = vector_3(inputs.at(position))};
}

json transform_results(const json& one_case) {
  const json& inputs = one_case.at("inputs");
  if (inputs.at("mode") == "BIND_DRIVE") {
    // TR-5, TR-6.
    const Pose offset = host::pose::bind(pose_of(inputs, "q_tracker0", "p_tracker0"),
                                         pose_of(inputs, "q_bone0", "p_bone0"));
    const Pose bone = host::pose::drive(pose_of(inputs, "q_tracker", "p_tracker"), offset);
    return {{"q_offset", list(offset.rotation)},
            {"p_offset", list(offset.position_m)},
            {"q_bone", list(bone.rotation)},
            {"p_bone", list(bone.position_m)}};
  }
  const Vector3d angles = vector_3(inputs.at("euler")), p = vector_3(inputs.at("p"));
  // TR-1 to TR-4.
  const host::pose::EulerAngles euler{
      .alpha_rad = angles[0], .beta_rad = angles[1], .gamma_rad = angles[2]};
  const Quaterniond q = host::pose::rotation_from(euler);
  const Pose local{.rotation = q, .position_m = vector_3(inputs.at("origin"))};
  return {{"q", list(q)},
          {"p_inertial", list(Vector3d(q * p))},
          {"p_world", list(host::pose::to_world(local, p))}};
}

json leg_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  // CC-10: a leg by the law of cosines; its plane is z = 0 here.
  const Vector3d hip_m = in_plane(inputs.at("P1")), ankle_m = in_plane(inputs.at("P2"));
  const Vector3d counter_clockwise = Vector3d::UnitZ().cross(ankle_m - hip_m);
  const double bend = number(p.at("bend"));
  const host::figure::Limb at =
      host::figure::pose_limb({.upper_m = number(p.at("L_lap")), .lower_m = number(p.at("L_calf"))},
                              hip_m, ankle_m, bend * counter_clockwise, Vector3d::UnitY());
  if (!at.middle_m.allFinite()) return {{"status", "INVALID_ARGUMENT"}};
  return {{"status", at.missed_m == 0.0 ? "OK" : "UNREACHABLE"},
          {"knee", list(at.middle_m, 2)},
          {"ankle", list(at.end_m, 2)}};
}

constexpr const char* kReachStatus[] = {"CONVERGED", "MAX_ITERATIONS", "UNREACHABLE",
                                        "INVALID_ARGUMENT"};
constexpr const char* kPoseStatus[] = {"OK", "TOO_FEW_POINTS", "DEGENERATE", "INVALID_ARGUMENT",
                                       "NO_POSE"};

void add_spatial_joint(const json& j, host::figure::Chain& chain,
                       std::vector<host::figure::JointState>& start) {
  host::figure::Bone bone{.length_m = number(j.at("length")), .rest = vector_3(j.at("rest"))};
  host::figure::JointState state;
  if (j.at("type") == "BALL") {
    bone.kind = JointKind::kBall;
    bone.cone_rad = number(j.at("cone"));
    const json& q = j.at("q");
    state.rotation =
        Quaterniond(number(q.at(0)), number(q.at(1)), number(q.at(2)), number(q.at(3)));
  } else {
    bone.hinge = vector_3(j.at("axis"));
    bone.lo_rad = number(j.at("lo"));
    bone.hi_rad = number(j.at("hi"));
    state.angle_rad = number(j.at("angle"));
  }
  chain.bones.push_back(bone);
  start.push_back(state);
}

json ccd_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  // CC-5: a plane is z = 0 here, with hinges about z.
  const bool planar = p.at("kind") == "PLANAR";
  const auto point = [&](const json& v) { return planar ? in_plane(v) : vector_3(v); };
  host::figure::Chain chain{.base_m = point(inputs.at("base")), .bones = {}};
  std::vector<host::figure::JointState> start;
  if (planar) {
    for (std::size_t i = 0; i < p.at("lengths").size(); ++i) {
      const json& limits = p.at("limits").at(i);
      chain.bones.push_back(host::figure::planar_bone(number(p.at("lengths").at(i)),
                                                      number(limits.at(0)), number(limits.at(1))));
      start.push_back({.angle_rad = number(inputs.at("angles").at(i))});
    }
  } else {
    for (const json& joint : p.at("joints")) add_spatial_joint(joint, chain, start);
  }
  const host::figure::ReachResult at =
      host::figure::reach(chain, start,
                          {.target_m = point(inputs.at("target")),
                           .tolerance_m = number(p.at("eps")),
                           .sweeps = p.at("max_sweeps").get<int>()});
  // Nothing else is defined then.
  if (at.status == host::figure::ReachStatus::kInvalid)
    return {{"status", word(kReachStatus, at.status)}};
  json points = json::array(), swing = json::array();
  for (const Vector3d& m : at.points_m) points.push_back(list(m, planar ? 2 : 3));
  for (std::size_t i = 0; i < at.joints.size(); ++i)
    swing.push_back(host::figure::swing_rad(chain.bones[i], at.joints[i]));
  return {{"status", word(kReachStatus, at.status)},
          {"points", points},
          {"error", at.error_m},
          {"sweeps", at.sweeps},
          {"updates", at.updates},
          {planar ? "angles" : "swing", swing}};
}

/// The angle between a rotation and a row-major matrix.
double angle_to(const Quaterniond& got, const json& rows) {
  Eigen::Matrix3d want;
  for (Eigen::Index i = 0; i < 9; ++i)
    want(i / 3, i % 3) = number(rows.at(static_cast<std::size_t>(i)));
  // One number for nine: how far the rotation is off, in any direction.
  return got.angularDistance(Quaterniond(want));
}

/// The file gives tolerances by quantity, those of the polished pose and of the raw one; a true
/// pose beside a noisy one is a check of the fit, to what the raw pose is allowed.
void verify_pose(const host::pose::PoseEstimate& got, const json& one_case, Report& report) {
  const json& expect = one_case.at("expect");
  report.equal("status", word(kPoseStatus, got.status), expect.at("status"));
  if (expect.at("status") != "OK") return;
  const auto tolerance = [&](const char* stage, const char* quantity) {
    return number(one_case.at("tolerance").at(stage).at(quantity));
  };
  const double rot_rad = tolerance("refined", "rot_rad"), t_m = tolerance("refined", "trans_m");
  report.near("R", angle_to(got.pose.rotation, expect.at("R")), 0.0, rot_rad);
  report.near("q", list(got.pose.rotation), expect.at("q"), rot_rad);
  report.near("t", list(got.pose.position_m), expect.at("t"), t_m);
  report.near("rms_px", got.rms_px, expect.at("rms_px"), tolerance("refined", "rms_px"));
  if (!expect.contains("R_true")) return;
  report.near("R_true", angle_to(got.pose.rotation, expect.at("R_true")), 0.0,
              tolerance("unrefined", "rot_rad"));
  report.near("t_true", list(got.pose.position_m), expect.at("t_true"),
              tolerance("unrefined", "trans_m"));
}

void verify_poses(const json& file, Report& report) {
  for (const json& one_case : file.at("cases")) {
    report.begin_case(one_case.at("id"));
    const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
    std::vector<Vector3d> points_m;
    std::vector<Vector2d> pixels_px;
    for (const json& v : inputs.at("points")) points_m.push_back(vector_3(v));
    for (const json& v : inputs.at("pixels")) pixels_px.push_back(vector_2(v));
    const host::pose::Camera camera{.fx_px = number(p.at("fx")),
                                    .fy_px = number(p.at("fy")),
                                    .cx_px = number(p.at("cx")),
                                    .cy_px = number(p.at("cy"))};
    verify_pose(host::pose::estimate_pose(camera, points_m, pixels_px), one_case, report);
  }
}

constexpr Verifier kVerifiers[] = {
    {"coordinate_chain", verify_cases<transform_results>},
    {"epnp_pose", verify_poses},
    {"leg_two_bone_ik", verify_cases<leg_results>},
    {"ccd_sub_root", verify_cases<ccd_results>},
};

}  // namespace tracking_cases

std::span<const Verifier> tracking_verifiers() { return tracking_cases::kVerifiers; }

}  // namespace tact::tools::verify
