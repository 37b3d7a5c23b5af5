// SPDX-License-Identifier: Apache-2.0
#include "host/pose/coordinate_chain.h"

#include <cmath>

namespace tact::host::pose {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond canonical(const Quaterniond& q) {
  // TR-2: chooses one of q and -q, so that equal rotations compare equal.
  for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
    if (part > 0.0) return q;
    if (part < 0.0) return Quaterniond(-q.coeffs());
  }
  return q;
}

std::optional<Quaterniond> rotation_from(const std::array<double, 4>& wxyz) {
  const Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  // A tracker's numbers may be huge or tiny: a plain norm would overflow or underflow.
  const double length = q.coeffs().stableNorm();
  if (!(length > 0.0 && std::isfinite(length))) return std::nullopt;
  return canonical(Quaterniond(q.coeffs() / length));
}

Quaterniond rotation_from(const EulerAngles& angles) {
  // q = qz(gamma) qy(beta) qx(alpha)    (TR-2)
  return canonical(AngleAxisd(angles.gamma_rad, Vector3d::UnitZ()) *
                   AngleAxisd(angles.beta_rad, Vector3d::UnitY()) *
                   AngleAxisd(angles.alpha_rad, Vector3d::UnitX()));
}

Vector3d to_world(const Pose& local, const Vector3d& p_local_m) {
  // p_world = q p_local q^-1 + o    (TR-3, TR-4)
  return local.rotation * p_local_m + local.position_m;
}

Vector3d to_local(const Pose& local, const Vector3d& p_world_m) {
  return local.rotation.conjugate() * (p_world_m - local.position_m);
}

Pose bind(const Pose& tracker, const Pose& bone) {
  // q_off = q_trk^-1 q_bone ,  p_off = q_trk^-1 (p_bone - p_trk) q_trk    (TR-5)
  const Quaterniond back = tracker.rotation.conjugate();
  return {.rotation = canonical((back * bone.rotation).normalized()),
          .position_m = back * (bone.position_m - tracker.position_m)};
}

Pose drive(const Pose& tracker, const Pose& offset) {
  // q_bone = q_trk q_off ,  p_bone = p_trk + q_trk p_off q_trk^-1    (TR-6)
  return {.rotation = canonical((tracker.rotation * offset.rotation).normalized()),
          .position_m = tracker.position_m + tracker.rotation * offset.position_m};
}

Pose between(const Pose& from, const Pose& to, double share) {
  // Eigen's slerp takes the sign with the dot product >= 0.
  return {.rotation = canonical(from.rotation.slerp(share, to.rotation)),
          .position_m = from.position_m + share * (to.position_m - from.position_m)};
}

}  // namespace tact::host::pose
