// SPDX-License-Identifier: Apache-2.0
// contact_radius.h - how wide a rigid sphere touches an organ at a given depth.
//
// Near the tip the organ is taken as a half-space whose surface falls away by s(rho), the mean
// around the site, so the gap before contact is g(rho) = R - sqrt(R^2 - rho^2) + s(rho):
//
//     d0(a) = a int_0^(pi/2) g'(a sin t) dt
//     F(a)  = 2 E* a^2 int_0^(pi/2) g'(a sin t) sin(t)^2 dt           Sneddon 1965, eqs. 4.6, 4.7
//
// The organ as a whole gives way by c F on top (linear elasticity): d = d0(a) + c F(a). c comes
// from one coarse solve. a contact radius m, d depth m, F force N, E* = E / (1 - nu^2).
#pragma once

#include <vector>

#include "model/mesh/mesh.h"
#include "model/result.h"
#include "tools/reference/calculix/calculix.h"

namespace tact::tools::reference {

class TipContact {
 public:
  /// `fall_m`: s at 0, pitch, 2 pitch, ...; empty for a flat surface.
  TipContact(const Elasticity& material, double sphere_radius_m, std::vector<double> fall_m,
             double pitch_m);

  double depth_m(double contact_radius_m) const;  // d0
  double force_N(double contact_radius_m) const;  // F

  /// c, of a solve that found this force at this depth; m/N.
  double compliance_m_per_N(double solved_depth_m, double solved_force_N) const;
  /// a at this depth when the organ gives way by c.
  double radius_m(double depth_m, double compliance_m_per_N) const;

 private:
  double gap_slope(double rho_m) const;  // g'

  double modulus_Pa_, sphere_radius_m_;
  std::vector<double> fall_m_;
  double pitch_m_;
};

/// s around a vertex, at distances k * pitch from its normal, k = 0 .. rings - 1.
model::Result<std::vector<double>> surface_fall_m(const model::mesh::SurfaceMesh& surface,
                                                  std::uint32_t vertex, int rings, double pitch_m);

}  // namespace tact::tools::reference
