// SPDX-License-Identifier: Apache-2.0
// moved_organ.h - an organ displaced by the spheres of one tool, with finite rotations: positions
// of the spheres relative to the surface at rest, forces, and one potential.
//
// Letters: README.md. x_i, n_i, G_i, T_i are those of the surface point s_i (smooth_surface.h).
// Unknown is y_i, the centre relative to the organ at rest. Its height over the surface is r - e_i,
// with e the indentation by the tip alone; t_i is its offset across n_i, the displacement of the
// surface by friction or a bond.
//
//     ML-1   l_i = F(e_i) n_i - k_t t_i                   load on the sphere, not rotated
//     ML-2   L_i = -Q_i^(1-k) l_i                         load on the organ
//     ML-3   z_i = sum T_ij (L_j + L'_j)                  slope of the moved surface
//     ML-4   v_i = sum (G_ij (L_j + L'_j) + T_ji' m_j)    shift of the surface point, m
//            m_j = -d/dz_j (Q_j l_j) . (Q_j^k v_j + Q_j (y_j - x_j))   moment on the slope, N m
//     ML-5   c_i = x_i + Q_i^k v_i + Q_i (y_i - x_i)      solved for y
//     ML-6   P_i = Q_i l_i                                force on the tool
//     ML-7   W = sum (U(e_i) + k_t t_i^2 / 2 + (L_i . v_i + m_i . z_i) / 2)
//     ML-8   G_ij = h n_i n_j' + q (G_i + G_j) / 2,   T_ij = q T_i,   q = min(b / G_n, 1)
//
// F, U: law of the tip alone; k_t tangential stiffness, N/m; h, b of MC-2; G_n the mean of n' G n;
// L'_j additional load that represents creep (creep.h).
// With the surface points fixed P = -dW/dc exactly: (v, z) follow from (L, m) by one symmetric
// matrix. moved_contact.h decides how the surface points move.
#pragma once

#include <array>
#include <cstddef>

#include "model/contact/contact_law.h"
#include "model/contact/rotation.h"
#include "model/contact/small_lu.h"
#include "model/contact/smooth_surface.h"
#include "model/law/creep.h"

namespace tact::model::contact {

/// k, chosen: with it the liver is within 5.3 % of finite elements at finite strain.
inline constexpr double kChord_ratio = 0.4;

inline constexpr std::size_t kMaxUnknowns = 3 * kMaxSpheres;

/// ML-8 of two spheres: h and q.
struct PairCompliance {
  double near_field_m_per_N = 0.0, structural_ratio = 0.0;
};

/// One sphere of the system.
struct OrganSphere {
  std::size_t index = 0;  // of the tool's spheres
  bool slides = true;     // its surface point follows y; else it sticks
  bool is_held = false;   // bonded: it may pull and does not slip
  double friction_ratio = 0.0;
  double radius_m = 0.0;
  double depth_offset_m = 0.0;      // part of the depth that gives no force
  SurfaceFrame at;                  // s
  Vec3 centre_m;                    // c
  double speed_mps = 0.0;           // pressing
  double tangential_N_per_m = 0.0;  // k_t
  Vec3 rest_m;                      // t at zero tangential force
  Vec3 y_m;                         // first a guess, then the solution
  Vec3 slope;                       // z, likewise
  Vec3 shift_m;                     // v, likewise
  law::CreepState creep;            // of L
  Vec3 crept_N;                     // L'
  // Results of evaluate()
  double height_m = 0.0;
  double indentation_m = 0.0;  // e
  Vec3 tangential_m;           // t
  law::LawResponse tip;
  Vec3 load_N;     // l
  Vec3 organ_N;    // L
  Vec3 moment_Nm;  // m
  Rotation rotation;
  Vec3 residual_m;  // c less ML-5
  Vec3 force_N;     // P
  // Motion in this tick (moved_contact.h)
  Vec3 moved_m;              // dc
  double may_slide_m = 0.0;  // remaining motion of the surface point
  double may_slip_m = 0.0;   // remaining slip of a sphere that sticks
  Vec3 brake_N;              // ML-9
  // At the last search (moved_detect.cc)
  bool is_pressing = false;
  Vec3 seen_shift_m, seen_y_m;  // v and y
  double deep_m = 0.0;          // distance that y must move before it can be outside
};

/// Parts of dc/dy of one sphere.
struct SphereSlope {
  Mat3 whole, chord, tilt_m;  // of c: Q, Q^k, and A of the slope
  Mat3 load_N_per_m;          // of L
};

struct MovedOrgan {
  ContactLaw* law = nullptr;        // force of the indentation alone
  law::Creep creep;                 // of the organ
  double contact_modulus_Pa = 0.0;  // E*
  double chord_ratio = kChord_ratio;
  std::size_t count = 0;
  std::array<OrganSphere, kMaxSpheres> sphere;
  std::array<std::array<PairCompliance, kMaxSpheres>, kMaxSpheres> pair{};      // [i][j], j < i
  std::array<std::array<Mat3, kMaxSpheres>, kMaxSpheres> compliance_m_per_N{};  // G_ij
  std::array<std::array<Mat3, kMaxSpheres>, kMaxSpheres> slope_per_N{};         // T_ij
  std::array<SphereSlope, kMaxSpheres> of_sphere;                               // of find_slope
  SmallLu<kMaxUnknowns> slope;                                                  // dc/dy
  bool has_slope = false;
};

/// Input of the law in ML-1.
inline Indentation indentation_of(const OrganSphere& b) RT_SAFE {
  return {.sphere = b.index,
          .surface_point = b.at.surface_point,
          .normal = b.at.normal,
          .indentation_m = b.indentation_m,
          .held = b.is_held,
          .speed_mps = b.speed_mps};
}

/// ML-8 of all spheres, from their surface points and pairs.
void fill_matrices(MovedOrgan& organ) RT_SAFE;

/// q of ML-8 from b of MC-2: 0 if one of the two compliances is very small.
double structural_ratio(const MovedOrgan& organ, std::size_t i, std::size_t j,
                        double structural_m_per_N) RT_SAFE;

/// ML-1 to ML-6 at y: fills the results; returns the largest residual, m.
double evaluate(MovedOrgan& organ) RT_SAFE;

/// dc/dy at the last evaluate(), for newton_step(). False: it is singular.
bool find_slope(MovedOrgan& organ) RT_SAFE;

/// `share` of a Newton step on y with the last slope, at most max_step_m. False: y is unchanged.
bool newton_step(MovedOrgan& organ, double max_step_m, double share) RT_SAFE;

/// ML-7 at the last evaluate().
double stored_energy_J(const MovedOrgan& organ) RT_SAFE;
/// One sphere's share of it.
double stored_energy_J(const MovedOrgan& organ, std::size_t i) RT_SAFE;

}  // namespace tact::model::contact
