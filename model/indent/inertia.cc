// SPDX-License-Identifier: Apache-2.0
#include "model/indent/inertia.h"

#include <cmath>

namespace tact::model::indent {

double inertia_speed_mps(const ElasticTip& tip, double depth_m, double share) {
  // IN-1 is a theory of small strain: the force that it is held against is CT-2, not CT-8.
  const ElasticTip small{.youngs_modulus_Pa = tip.youngs_modulus_Pa,
                         .poisson_ratio = tip.poisson_ratio,
                         .radius_m = tip.radius_m};
  // CT-1: the depth grows with s, and is above R (s - 1)
  double low = 0.0, high = 1.0 + depth_m / tip.radius_m;
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double s = 0.5 * (low + high);
    (tip_state(small, s).depth_m < depth_m ? low : high) = s;
  }
  // The upper end, which is above zero: a force of zero over a contact of zero would be no number.
  const TipState at = tip_state(small, high);
  const double shear_Pa = tip.youngs_modulus_Pa / (2.0 * (1.0 + tip.poisson_ratio));
  // IN-1  F_wave = c v,   c = 3.4 a^2 sqrt(rho G)/(1 - nu)
  const double wave_Ns_per_m = 3.4 * at.contact_radius_m * at.contact_radius_m *
                               std::sqrt(kTissueDensity_kg_per_m3 * shear_Pa) /
                               (1.0 - tip.poisson_ratio);
  // IN-2  v_q = q F(d)/c
  return share * at.force_N / wave_Ns_per_m;
}

}  // namespace tact::model::indent
