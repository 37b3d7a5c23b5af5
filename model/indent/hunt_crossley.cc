// SPDX-License-Identifier: Apache-2.0
#include "model/indent/hunt_crossley.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "model/ranges.h"

namespace tact::model::indent {

law::LawResponse HuntCrossley::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = law::LawStatus::kInvalid};
  if (depth_m < 0.0) return {.status = law::LawStatus::kNoContact};
  // n >= 1, so x^(n-1) is finite at rest.
  const double n = p_.exponent, inside_m = std::min(depth_m, p_.working_depth_m);
  const double x = inside_m / p_.working_depth_m, power = std::pow(x, n - 1.0);
  // HC-1, HC-2
  const law::LawResponse out{.force_N = p_.force_N * power * x,
                             .stiffness_N_per_m = n * p_.force_N * power / p_.working_depth_m,
                             .energy_J = p_.force_N * power * x * inside_m / (n + 1.0)};
  return law::beyond_limit(out, inside_m, depth_m);
}

double HuntCrossley::damping_Ns_per_m(double depth_m) const RT_SAFE {
  // HC-2  b = lambda F: the factor (1 + lambda d') of HC-1 is then that of LW-3.
  return p_.dissipation_s_per_m * respond(depth_m).force_N;
}

std::size_t HuntCrossley::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const std::array<double, 2> u_m{std::fmax(depth_m, 0.0), 0.0};
  const std::size_t count = std::min(u_m.size(), ring_m.size());
  std::copy_n(u_m.begin(), count, ring_m.begin());
  return count;
}

Result<HuntCrossley> make_hunt_crossley(const HuntCrossleyParameters& p) {
  const char* wrong = nullptr;
  if (!is_positive(p.force_N)) wrong = "force_N must be finite and above 0";
  if (!is_positive(p.working_depth_m)) wrong = "working_depth_m must be finite and above 0";
  if (!(p.exponent >= 1.0 && p.exponent <= 4.0)) wrong = "exponent must lie between 1 and 4";
  if (!is_not_negative(p.dissipation_s_per_m))
    wrong = "dissipation_s_per_m must be finite and 0 or more";
  if (wrong != nullptr) return Error{std::string("hunt_crossley: ") + wrong};
  return HuntCrossley(p);
}

}  // namespace tact::model::indent
