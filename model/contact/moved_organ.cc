// SPDX-License-Identifier: Apache-2.0
#include "model/contact/moved_organ.h"

#include <algorithm>

namespace tact::model::contact {
namespace {

using Column = SmallLu<kMaxUnknowns>::Column;

constexpr Mat3 outer(const Vec3& a, const Vec3& b) RT_SAFE { return {{a.x * b, a.y * b, a.z * b}}; }

// A' v
Vec3 times_transposed(const Mat3& a, const Vec3& v) RT_SAFE {
  return v.x * a.row[0] + v.y * a.row[1] + v.z * a.row[2];
}

Mat3 matrix_of(const SineCosine& by, const Vec3& axis) RT_SAFE {
  return transpose(
      {{rotated(by, axis, {1, 0, 0}), rotated(by, axis, {0, 1, 0}), rotated(by, axis, {0, 0, 1})}});
}

bool presses(const OrganSphere& b) RT_SAFE { return b.tip.force_N > 0.0 || b.is_held; }

// ML-1   l_i = F(e_i) n_i - k_t t_i
void fill_load(ContactLaw& law, OrganSphere& b) RT_SAFE {
  const LocalPosition at = local_position(b.at, b.y_m);
  b.height_m = at.height_m;
  b.indentation_m = b.radius_m - at.height_m - b.depth_offset_m;
  b.tip = b.indentation_m > 0.0 || b.is_held
              ? law.respond(indentation_of(b)).law
              : law::LawResponse{.status = law::LawStatus::kNoContact};
  b.tangential_m = presses(b) ? at.tangential_m - b.rest_m : Vec3{};
  b.load_N = b.tip.force_N * b.at.normal - b.tangential_N_per_m * b.tangential_m;
}

// ML-2, ML-6 and the moment of ML-4 with the present slopes and shifts.
void turn_load(OrganSphere& b, double chord_ratio) RT_SAFE {
  b.rotation = rotation_of_slope(b.at.normal, b.slope, chord_ratio);
  const Rotation& q = b.rotation;
  b.force_N = rotated(q.whole, q.axis, b.load_N);
  b.organ_N = -rotated(q.rest, q.axis, b.load_N);
  b.moment_Nm = moment_on_slope(q, chord_ratio, b.force_N, rotated(q.chord, q.axis, b.shift_m),
                                rotated(q.whole, q.axis, b.y_m - b.at.point_m));
}

// ML-2 to ML-4 once; returns by how much slopes and shifts have changed, m.
double pass(MovedOrgan& organ) RT_SAFE {
  // bound: spheres
  for (std::size_t i = 0; i < organ.count; ++i) turn_load(organ.sphere[i], organ.chord_ratio);
  double change_m = 0.0;
  for (std::size_t i = 0; i < organ.count; ++i) {  // bound: spheres
    OrganSphere& b = organ.sphere[i];
    Vec3 z, v_m;
    for (std::size_t j = 0; j < organ.count; ++j) {  // bound: spheres
      const OrganSphere& o = organ.sphere[j];
      const Vec3 load_N = o.organ_N + o.crept_N;
      z += organ.slope_per_N[i][j] * load_N;
      v_m += organ.compliance_m_per_N[i][j] * load_N +
             times_transposed(organ.slope_per_N[j][i], o.moment_Nm);
    }
    const double now_m = std::max(norm(v_m - b.shift_m), b.radius_m * norm(z - b.slope));
    if (!(now_m <= change_m)) change_m = now_m;  // NaN is not small
    b.slope = z, b.shift_m = v_m;
  }
  return change_m;
}

// dl/dy, of a point that sticks:
//     -K n n' - k_t (1 - n n')
// of one that slides, u = t / |t|, the last two terms with friction mu alone:
//     -K n n' + F dn/dy + (mu K u + k_t n) n' - k_t (1 - u u')
Mat3 load_slope(const OrganSphere& b) RT_SAFE {
  if (!presses(b)) return {};
  const Vec3& n = b.at.normal;
  const double k_N_per_m = b.tip.stiffness_N_per_m, side_N_per_m = b.tangential_N_per_m;
  const Mat3 push = outer(-k_N_per_m * n, n);
  if (!b.slides) return push + outer(side_N_per_m * n, n) + diagonal(-side_N_per_m);
  const Mat3 normal_turns = b.tip.force_N * normal_slope_per_m(b.at, b.height_m);
  const double t_m = norm(b.tangential_m);
  if (!(b.friction_ratio > 0.0 && t_m > 0.0)) return push + normal_turns;
  const Vec3 along = b.tangential_m / t_m;
  return push + normal_turns + outer((b.friction_ratio * k_N_per_m) * along + side_N_per_m * n, n) +
         outer(side_N_per_m * along, along) + diagonal(-side_N_per_m);
}

void put(SmallLu<kMaxUnknowns>& a, std::size_t i, std::size_t j, const Mat3& m) RT_SAFE {
  for (std::size_t k = 0; k < 3; ++k) {
    a.at(3 * i + k, 3 * j) = m.row[k].x;
    a.at(3 * i + k, 3 * j + 1) = m.row[k].y;
    a.at(3 * i + k, 3 * j + 2) = m.row[k].z;
  }
}

// dc_i/dy_j = Q_i delta_ij - (Q_i^k G_ij + A_i T_ij) Q_j^(1-k) dl_j/dy_j, with
// A dz = (n x dz) x (k Q^k v + Q (y - x)); without the second order of the rotations.
void fill_slope(MovedOrgan& organ) RT_SAFE {
  for (std::size_t j = 0; j < organ.count; ++j) {  // bound: spheres
    const OrganSphere& b = organ.sphere[j];
    SphereSlope& of = organ.of_sphere[j];
    const Rotation& q = b.rotation;
    of.whole = matrix_of(q.whole, q.axis);
    of.chord = matrix_of(q.chord, q.axis);
    of.load_N_per_m = -1.0 * (matrix_of(q.rest, q.axis) * load_slope(b));
    const Vec3 lever_m =
        organ.chord_ratio * (of.chord * b.shift_m) + of.whole * (b.y_m - b.at.point_m);
    // (n x dz) x lever = dz (n . lever) - n (dz . lever)
    of.tilt_m = diagonal(dot(q.normal, lever_m)) + outer(-1.0 * q.normal, lever_m);
  }
  for (std::size_t i = 0; i < organ.count; ++i)      // bound: spheres
    for (std::size_t j = 0; j < organ.count; ++j) {  // bound: spheres
      const SphereSlope& of = organ.of_sphere[i];
      const Mat3 m =
          (of.chord * organ.compliance_m_per_N[i][j] + of.tilt_m * organ.slope_per_N[i][j]) *
          organ.of_sphere[j].load_N_per_m;
      put(organ.slope, i, j, i == j ? m + of.whole : m);
    }
}

}  // namespace

// Goes to 0 where G_n falls below a tenth of the tip's compliance: b / G_n is unbounded there.
double structural_ratio(const MovedOrgan& organ, std::size_t i, std::size_t j,
                        double structural_m_per_N) RT_SAFE {
  const auto normal_m_per_N = [](const SurfaceFrame& at) RT_SAFE {
    return dot(at.normal, at.compliance_m_per_N * at.normal);
  };
  const double g_i = normal_m_per_N(organ.sphere[i].at), g_j = normal_m_per_N(organ.sphere[j].at);
  const double less = std::min(g_i, g_j);
  const double least = 0.05 / (organ.contact_modulus_Pa * organ.sphere[i].radius_m);
  if (!(less > 0.0 && structural_m_per_N > 0.0)) return 0.0;
  return std::min(2.0 * structural_m_per_N / (g_i + g_j), 1.0) * std::min(less / least, 1.0);
}

void fill_matrices(MovedOrgan& organ) RT_SAFE {
  auto& g = organ.compliance_m_per_N;
  auto& t = organ.slope_per_N;
  for (std::size_t i = 0; i < organ.count; ++i) {  // bound: spheres
    const SurfaceFrame& a = organ.sphere[i].at;
    g[i][i] = a.compliance_m_per_N;
    t[i][i] = a.slope_per_N;
    for (std::size_t j = 0; j < i; ++j) {  // bound: spheres - 1; pairs in all
      const SurfaceFrame& b = organ.sphere[j].at;
      const PairCompliance& pair = organ.pair[i][j];
      g[i][j] = outer(pair.near_field_m_per_N * a.normal, b.normal) +
                0.5 * pair.structural_ratio * (a.compliance_m_per_N + b.compliance_m_per_N);
      g[j][i] = transpose(g[i][j]);
      t[i][j] = pair.structural_ratio * a.slope_per_N;
      t[j][i] = pair.structural_ratio * b.slope_per_N;
    }
  }
}

double evaluate(MovedOrgan& organ) RT_SAFE {
  constexpr int kMaxPasses = 3;
  constexpr double kSettled_m = 3e-7;
  // bound: spheres
  for (std::size_t i = 0; i < organ.count; ++i) fill_load(*organ.law, organ.sphere[i]);
  double worst_m = 0.0;
  for (int i = 0; i < kMaxPasses; ++i) {  // bound: kMaxPasses
    worst_m = pass(organ);
    if (worst_m < kSettled_m) break;
  }
  for (std::size_t i = 0; i < organ.count; ++i) {  // bound: spheres
    OrganSphere& b = organ.sphere[i];
    const Rotation& q = b.rotation;
    b.residual_m = b.centre_m - b.at.point_m - rotated(q.chord, q.axis, b.shift_m) -
                   rotated(q.whole, q.axis, b.y_m - b.at.point_m);
    const double residual_m = norm(b.residual_m);
    if (!(residual_m <= worst_m)) worst_m = residual_m;
  }
  return worst_m;
}

bool find_slope(MovedOrgan& organ) RT_SAFE {
  constexpr double kMinSlopePivot = 1e-6;
  fill_slope(organ);
  organ.has_slope = organ.slope.factorise(3 * organ.count, Pivot::kOfColumn, kMinSlopePivot);
  return organ.has_slope;
}

bool newton_step(MovedOrgan& organ, double max_step_m, double share) RT_SAFE {
  constexpr double kLost_m = 1.0;                  // farther than this, or NaN: no step at all
  Column x;                                        // only the part in use is set
  for (std::size_t i = 0; i < organ.count; ++i) {  // bound: spheres
    const Vec3& r_m = organ.sphere[i].residual_m;
    x[3 * i] = r_m.x, x[3 * i + 1] = r_m.y, x[3 * i + 2] = r_m.z;
  }
  organ.slope.solve(x);
  for (std::size_t i = 0; i < organ.count; ++i)  // bound: spheres
    if (!(norm(Vec3{x[3 * i], x[3 * i + 1], x[3 * i + 2]}) < kLost_m)) return false;
  for (std::size_t i = 0; i < organ.count; ++i) {  // bound: spheres
    const Vec3 step_m = share * Vec3{x[3 * i], x[3 * i + 1], x[3 * i + 2]};
    const double length_m = norm(step_m);
    organ.sphere[i].y_m += (length_m > max_step_m ? max_step_m / length_m : 1.0) * step_m;
  }
  return true;
}

// ML-7   W = sum (U(e_i) + k_t t_i^2 / 2 + (L_i . v_i + m_i . z_i) / 2)
double stored_energy_J(const MovedOrgan& organ) RT_SAFE {
  double sum_J = 0.0;
  // bound: spheres
  for (std::size_t i = 0; i < organ.count; ++i) sum_J += stored_energy_J(organ, i);
  return sum_J;
}

// The creep loads L' are not part of the instantaneous energy; each creep term has its own.
double stored_energy_J(const MovedOrgan& organ, std::size_t i) RT_SAFE {
  const OrganSphere& b = organ.sphere[i];
  double twice_J = b.tangential_N_per_m * dot(b.tangential_m, b.tangential_m) +
                   dot(b.organ_N, b.shift_m) + dot(b.moment_Nm, b.slope);
  // bound: creeps * spheres (if it creeps)
  for (std::size_t j = 0; organ.creep.terms() > 0 && j < organ.count; ++j) {
    const OrganSphere& o = organ.sphere[j];
    const Mat3& g = organ.compliance_m_per_N[i][j];
    twice_J -=
        dot(b.organ_N, g * o.crept_N) + dot(b.moment_Nm, organ.slope_per_N[i][j] * o.crept_N);
    for (std::size_t k = 0; k < organ.creep.terms(); ++k)  // bound: terms (of the creep)
      twice_J += organ.creep.ratio(k) * dot(b.creep[k], g * o.creep[k]);
  }
  return b.tip.energy_J + 0.5 * twice_J;
}

}  // namespace tact::model::contact
