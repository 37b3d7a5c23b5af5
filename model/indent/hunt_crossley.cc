// SPDX-License-Identifier: Apache-2.0
#include "model/indent/hunt_crossley.h"

#include <algorithm>
#include <cmath>

#include "model/law/ring_taper.h"

namespace tact::model::indent {

law::LawResponse HuntCrossley::respond(double depth_m) const RT_SAFE {
  return law::press_response(depth_m, p_.working_depth_m, [this](double inside_m) RT_SAFE {
    // n >= 1, so x^(n-1) is finite at rest.
    const double n = p_.exponent, x = inside_m / p_.working_depth_m, power = std::pow(x, n - 1.0);
    // HC-1, HC-2
    return law::LawResponse{.force_N = p_.force_N * power * x,
                            .stiffness_N_per_m = n * p_.force_N * power / p_.working_depth_m,
                            .energy_J = p_.force_N * power * x * inside_m / (n + 1.0)};
  });
}

double HuntCrossley::damping_Ns_per_m(double depth_m) const RT_SAFE {
  // HC-2  b = lambda F: the factor (1 + lambda d') of HC-1 is then that of LW-3.
  return p_.dissipation_s_per_m * respond(depth_m).force_N;
}

std::size_t HuntCrossley::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  return law::lone_profile(depth_m, ring_m);
}

void visit(ParameterVisitor& v, HuntCrossleyParameters& p) {
  v.number("force_N", {1e-4, 100.0}, "of a slow press at working_depth_m", p.force_N);
  v.number("working_depth_m", kDepth_m, "press up to here", p.working_depth_m);
  v.number("exponent", {1.0, 4.0, kHard}, "n: the force grows as depth^n", p.exponent);
  v.number("dissipation_s_per_m", {0.0, 100.0}, "lambda: damping over force",
           p.dissipation_s_per_m);
}

Result<HuntCrossley> make_hunt_crossley(const HuntCrossleyParameters& p) {
  if (auto wrong = check_meaning("hunt_crossley", p)) return *wrong;
  return HuntCrossley(p);
}

}  // namespace tact::model::indent
