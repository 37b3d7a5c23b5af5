// SPDX-License-Identifier: Apache-2.0
// The published kinematics cases: delta pose by pose, its workspace, its counted motion, the
// Falcon.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hal/delta/delta_dynamics.h"
#include "hal/delta/delta_kinematics.h"
#include "hal/falcon/falcon_kinematics.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace kinematics_cases {

using hal::delta::DeltaGeometry;
using hal::delta::DeltaKinematics;
using hal::delta::DeltaMasses;
using hal::delta::Joints;
using model::Mat3;
using model::Vec3;
using nlohmann::json;

Vec3 vec3(const json& v) { return {v.at(0), v.at(1), v.at(2)}; }
json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }
json to_json(const Mat3& m) { return {to_json(m.row[0]), to_json(m.row[1]), to_json(m.row[2])}; }

/// Relative to the largest element, so that a small one beside a large one is no special case.
void compare_matrix(Report& report, const std::string& field, const Mat3& got, const json& want,
                    double rel) {
  double largest = 0.0;
  for (const json& row : want)
    for (const json& value : row) largest = std::max(largest, std::abs(value.get<double>()));
  report.near(field, to_json(got), want, rel * largest);
}

DeltaGeometry geometry_of(const json& p) {
  const double third = 2.0 * std::numbers::pi / 3.0;
  DeltaGeometry out{.base_radius_m = p.at("rb"),
                    .platform_radius_m = p.at("rp"),
                    .upper_arm_m = p.at("la"),
                    .forearm_m = p.at("lb"),
                    .azimuth_rad = {0.0, third, 2.0 * third}};
  if (p.contains("phi")) out.azimuth_rad = p.at("phi").get<Joints>();
  out.theta_min_rad = p.value("theta_min", 0.0);
  out.theta_max_rad = p.value("theta_max", 0.0);
  return out;
}
DeltaMasses masses_of(const json& p) {
  return {.arm_kg = p.at("m_arm"),
          .arm_com_m = p.at("com_arm"),
          .arm_inertia_kgm2 = p.at("j_arm"),
          .rotor_inertia_kgm2 = p.at("j_motor"),
          .gear_ratio = p.at("gear"),
          .forearm_kg = p.at("m_forearm"),
          .platform_kg = p.at("m_platform")};
}

void verify_delta_pose(const DeltaKinematics& delta, const DeltaMasses& masses, const json& one,
                       const json& tolerance, Report& report) {
  const Vec3 p = vec3(one.at("p"));
  const hal::delta::DeltaInverse inverse = delta.inverse(p);
  report.equal("reachable", inverse.reachable, one.at("reachable"));
  // A pose out of reach has no numbers; where the two disagree, that has been reported.
  if (!inverse.reachable || !one.at("reachable").get<bool>()) return;
  const double tau = tolerance.at("tau_abs");
  report.near("theta", inverse.theta_rad, one.at("theta"), tolerance.at("theta"));

  const hal::delta::DeltaForward forward = delta.forward(inverse.theta_rad);
  report.near("fk_far", to_json(forward.far_m), one.at("fk_far"), tolerance.at("p"));

  const hal::delta::DeltaPose pose = delta.pose(p, inverse.theta_rad);
  compare_matrix(report, "K", joint_rate_matrix(pose), one.at("K"), tolerance.at("K_rel"));
  compare_matrix(report, "J", jacobian(pose), one.at("J"), tolerance.at("J_rel"));
  report.near("tau", joint_torques_Nm(pose, vec3(one.at("force"))), one.at("tau"), tau);
  report.near("tau_gravity",
              gravity_torques_Nm(delta.geometry(), masses, pose, vec3(one.at("gravity"))),
              one.at("tau_gravity"), tau);
  compare_matrix(report, "task_inertia", task_inertia_kg(delta.geometry(), masses, pose),
                 one.at("task_inertia"), tolerance.at("inertia_rel"));
}

void verify_delta(const json& file, Report& report) {
  const json& tolerance = file.at("tolerance");
  for (const auto& [name, device] : file.at("devices").items()) {
    const DeltaKinematics delta(geometry_of(device.at("params")));
    const DeltaMasses masses = masses_of(device.at("params"));
    report.each(name + "/cases", device.at("cases"),
                [&](const json& one) { verify_delta_pose(delta, masses, one, tolerance, report); });
    report.each(name + "/from_joints", device.at("from_joints"), [&](const json& one) {
      const hal::delta::DeltaForward forward = delta.forward(one.at("theta").get<Joints>());
      report.equal("solvable", forward.solved, one.at("solvable"));
      if (!one.at("solvable").get<bool>()) return;
      report.near("fk_far", to_json(forward.far_m), one.at("fk_far"), tolerance.at("p"));
    });
  }
}

/// The summary over the cylinder: 13 radii (the axis once), 48 angles, 31 heights.
void verify_cylinder(const DeltaKinematics& delta, const json& want, double rel, Report& report) {
  bool reachable = true;
  // 9 rad lies beyond every joint angle.
  double sigma_max = 0.0, cond_max = 0.0, column_max = 0.0, theta_min = 9.0, theta_max = -9.0;
  for (int r = 0; r < 13; ++r) {
    for (int k = 0; k < (r == 0 ? 1 : 48); ++k) {
      for (int h = 0; h < 31; ++h) {
        const double radius = want.at("radius").get<double>() * r / 12.0;
        const double angle = 2.0 * std::numbers::pi * k / 48.0;
        const double z =
            want.at("z_near").get<double>() + want.at("length").get<double>() * h / 30.0;
        const Vec3 p{radius * std::cos(angle), radius * std::sin(angle), z};
        const hal::delta::DeltaInverse inverse = delta.inverse(p);
        reachable = reachable && inverse.reachable;
        const Mat3 j = jacobian(delta.pose(p, inverse.theta_rad));
        // Largest first.
        const Joints sigma = model::singular_values(j);
        sigma_max = std::max(sigma_max, sigma[0]);
        cond_max = std::max(cond_max, sigma[0] / sigma[2]);
        for (const Vec3& column : transpose(j).row) column_max = std::max(column_max, norm(column));
        for (const double theta : inverse.theta_rad) {
          theta_min = std::min(theta_min, theta);
          theta_max = std::max(theta_max, theta);
        }
      }
    }
  }
  report.begin_case("cylinder");
  report.equal("all_points_reachable", reachable, want.at("all_points_reachable"));
  report.near_ratio("sigma_max", sigma_max, want.at("sigma_max"), rel);
  report.near_ratio("cond_max", cond_max, want.at("cond_max"), rel);
  report.near_ratio("column_norm_max", column_max, want.at("column_norm_max"), rel);
  report.near_ratio("theta_min", theta_min, want.at("theta_min"), rel);
  report.near_ratio("theta_max", theta_max, want.at("theta_max"), rel);
}

void verify_workspace(const json& file, Report& report) {
  const DeltaKinematics delta(geometry_of(file.at("device")));
  const json& tolerance = file.at("tolerance");
  verify_cylinder(delta, file.at("cylinder"), tolerance.at("other_rel"), report);
  report.each("cases", file.at("cases"), [&](const json& one) {
    const Vec3 p = vec3(one.at("p"));
    const hal::delta::DeltaInverse inverse = delta.inverse(p);
    report.equal("reachable", inverse.reachable, one.at("reachable"));
    if (!inverse.reachable || !one.at("reachable").get<bool>()) return;
    const Joints sigma = model::singular_values(jacobian(delta.pose(p, inverse.theta_rad)));
    report.near("theta", inverse.theta_rad, one.at("theta"), tolerance.at("theta"));
    report.near_ratio("sigma", sigma, one.at("sigma"), tolerance.at("sigma_rel"));
  });
}

void verify_trajectory(const json& file, Report& report) {
  const DeltaKinematics delta(geometry_of(file.at("params")));
  const double counts_per_rad =
      file.at("counts_per_joint_rev").get<double>() / (2.0 * std::numbers::pi);
  report.each("rows", file.at("rows"), [&](const json& row) {
    const auto counts = row.at("counts").get<std::array<long, 3>>();
    const hal::delta::DeltaInverse inverse = delta.inverse(vec3(row.at("p_true")));
    Joints counted_rad{};
    std::array<long, 3> got_counts{};
    for (std::size_t i = 0; i < 3; ++i) {
      counted_rad[i] = static_cast<double>(counts[i]) / counts_per_rad;
      // What an encoder would have counted there.
      got_counts[i] = std::lround(inverse.theta_rad[i] * counts_per_rad);
    }
    report.equal("counts", got_counts, row.at("counts"));
    report.near("p_from_counts", to_json(delta.forward(counted_rad).far_m), row.at("p_from_counts"),
                file.at("tolerance").at("p_from_counts"));
  });
}

double in_deg(double angle_rad) { return angle_rad * 180.0 / std::numbers::pi; }

Joints falcon_thighs_rad(const json& counts) {
  return {hal::falcon::falcon_thigh_rad(counts.at(0)), hal::falcon::falcon_thigh_rad(counts.at(1)),
          hal::falcon::falcon_thigh_rad(counts.at(2))};
}

void verify_falcon_pose(const hal::falcon::FalconKinematics& falcon, const json& one,
                        const json& tolerance, Report& report) {
  const hal::falcon::FalconInverse legs = falcon.inverse(vec3(one.at("p")));
  report.equal("reachable", legs.reachable, true);
  if (!legs.reachable) return;
  report.near("theta1", legs.thigh_rad, one.at("theta1"), tolerance.at("theta"));
  report.near("theta2", legs.knee_rad, one.at("theta2"), tolerance.at("theta"));
  report.near("theta3", legs.side_rad, one.at("theta3"), tolerance.at("theta"));
  const Mat3 k = falcon.joint_rate_matrix(legs);
  compare_matrix(report, "K", k, one.at("K"), tolerance.at("K_rel"));
  // The file has no tolerance for J; it is the inverse of K.
  compare_matrix(report, "J", model::inverse(k), one.at("J"), tolerance.at("K_rel"));
  report.near("tau", hal::falcon::falcon_torques_Nm(k, vec3(one.at("force"))), one.at("tau"),
              tolerance.at("tau_abs"));
  std::array<long, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i)
    counts[i] = std::lround(hal::falcon::falcon_counts(legs.thigh_rad[i]));
  report.equal("counts_rounded", counts, one.at("counts_rounded"));
  const hal::falcon::FalconForward forward =
      falcon.forward(falcon_thighs_rad(one.at("counts_rounded")), hal::falcon::kFalconHome_m);
  report.near("p_from_counts", to_json(forward.position_m), one.at("p_from_counts"),
              tolerance.at("p"));
}

void verify_falcon_constants(const json& want, Report& report) {
  constexpr double kRel = 1e-12;
  const hal::falcon::FalconGeometry g;
  const std::array<std::pair<const char*, double>, 8> lengths{{{"a", g.thigh_m},
                                                               {"b", g.shin_m},
                                                               {"c", g.platform_m},
                                                               {"d", g.knee_link_m},
                                                               {"e", g.ankle_link_m},
                                                               {"f", g.side_shift_m},
                                                               {"r", g.base_radius_m},
                                                               {"s", g.base_shift_m}}};
  for (const auto& [name, value] : lengths) report.near_ratio(name, value, want.at(name), kRel);
  report.near_ratio("phi", g.azimuth_rad, want.at("phi"), kRel);
  report.near_ratio("theta_at_zero_counts_deg", in_deg(hal::falcon::falcon_thigh_rad(0.0)),
                    want.at("theta_at_zero_counts_deg"), kRel);
  const double rad_per_count =
      hal::falcon::falcon_thigh_rad(1.0) - hal::falcon::falcon_thigh_rad(0.0);
  report.near_ratio("rad_per_count", rad_per_count, want.at("rad_per_count"), kRel);
  // The code has the parts only as this product: each of them, out of it and the others.
  const double motor_rad = 2.0 * std::numbers::pi / want.at("counts_per_motor_rev").get<double>();
  const double drum_m = want.at("drum_diameter"), shaft_m = want.at("shaft_diameter");
  report.near_ratio("counts_per_motor_rev", motor_rad * shaft_m / rad_per_count, drum_m, kRel);
  // An encoder in quadrature counts four edges a slot.
  report.near_ratio("encoder_slots", want.at("counts_per_motor_rev").get<double>() / 4.0,
                    want.at("encoder_slots"), kRel);
}

void verify_falcon_kinematics(const json& file, Report& report) {
  const hal::falcon::FalconKinematics falcon;
  const json& tolerance = file.at("tolerance");
  report.begin_case("constants");
  verify_falcon_constants(file.at("constants"), report);
  report.each("cases", file.at("cases"),
              [&](const json& one) { verify_falcon_pose(falcon, one, tolerance, report); });
  report.each("symmetric", file.at("symmetric"), [&](const json& one) {
    const hal::falcon::FalconForward forward =
        falcon.forward(falcon_thighs_rad(one.at("counts")), hal::falcon::kFalconHome_m);
    report.equal("solved", forward.solved, true);
    report.near("p", to_json(forward.position_m), one.at("p"), tolerance.at("p"));
    json thighs_deg = json::array(), want_deg = json::array();
    for (const double thigh_rad : falcon_thighs_rad(one.at("counts"))) {
      thighs_deg.push_back(in_deg(thigh_rad));
      want_deg.push_back(one.at("theta_deg"));
    }
    report.near_ratio("theta_deg", thighs_deg, want_deg, 1e-9);
  });
}

constexpr std::array kVerifiers{
    Verifier{"kinematics_delta/1", verify_delta},
    Verifier{"kinematics_workspace/1", verify_workspace},
    Verifier{"kinematics_trajectory/1", verify_trajectory},
    Verifier{"kinematics_falcon/1", verify_falcon_kinematics},
};

}  // namespace kinematics_cases

std::span<const Verifier> kinematics_verifiers() { return kinematics_cases::kVerifiers; }

}  // namespace tact::tools::verify
