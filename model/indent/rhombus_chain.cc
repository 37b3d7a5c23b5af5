// SPDX-License-Identifier: Apache-2.0
#include "model/indent/rhombus_chain.h"

#include <cmath>

namespace tact::model::indent {
namespace {

// Of the doublings, and of Newton and bisection together,
// which need 60 for the last bit of a double.
constexpr int kMaxChainSteps = 100;

}  // namespace

void visit(ParameterVisitor& v, RhombusChainParameters& p) {
  v.number("rod_length_m", {1e-4, 0.1}, "length a of each rod", p.rod_length_m);
  v.number("initial_angle_rad", {0.05, 1.5, kHard}, "angle of the rods to the surface at rest",
           p.initial_angle_rad);
  v.number("normal_stiffness_N_per_m", {0.01, 1e5}, "kN, along the normal",
           p.normal_stiffness_N_per_m);
  v.number("tangential_stiffness_N_per_m", {0.0, 1e5}, "kT of the first unit, along the surface",
           p.tangential_stiffness_N_per_m);
  v.number("growth", {0.1, 100.0}, "beta: unit i has kT exp((i - 1) / beta)", p.growth);
  v.count("units", {1, kMaxUnits, kHard}, "rhombus units in series", p.units);
}

Result<RhombusChain> make_rhombus_chain(const RhombusChainParameters& p) {
  if (auto wrong = check_meaning("rhombus chain", p)) return *wrong;
  RhombusChain chain;
  chain.count_ = p.units;
  for (std::size_t i = 0; i < p.units; ++i) {
    // RC-8  kT_i = kT1 exp((i - 1) / beta), here i counts from 0
    chain.unit_[i] = {.rod_length_m = p.rod_length_m,
                      .initial_angle_rad = p.initial_angle_rad,
                      .normal_stiffness_N_per_m = p.normal_stiffness_N_per_m,
                      .tangential_stiffness_N_per_m = p.tangential_stiffness_N_per_m *
                                                      std::exp(static_cast<double>(i) / p.growth)};
    if (!std::isfinite(chain.unit_[i].tangential_stiffness_N_per_m))
      return Error{"rhombus chain: growth is too small for so many units: exp overflows"};
    chain.unit_limit_[i] = press_limit(chain.unit_[i]);
    // RC-9: the first unit that goes flat or snaps ends the chain.
    // Which one depends on the springs, so all are asked.
    if (chain.unit_limit_[i].force_N < chain.unit_limit_[chain.weakest_].force_N)
      chain.weakest_ = i;
    chain.straight_m_ += straight_m(chain.unit_[i]);
  }
  chain.ring_pitch_m_ = 2.0 * p.rod_length_m * std::cos(p.initial_angle_rad);
  // A pull has no limit of its own, as it hardens: it ends at the force where the press does.
  chain.range_ = {.pull_m = chain.solve_force(-chain.force_limit_N()).depth_m,
                  .press_m = chain.solve_force(chain.force_limit_N()).depth_m};
  // Without tangential springs nothing hardens: stop short of straight rods.
  if (p.tangential_stiffness_N_per_m == 0.0)
    chain.range_.pull_m = std::fmax(chain.range_.pull_m, 0.95 * chain.straight_m_);
  return chain;
}

ChainState RhombusChain::solve_force(double force_N) const RT_SAFE {
  ChainState out{.force_N = force_N};
  double compliance_m_per_N = 0.0;
  for (std::size_t i = 0; i < count_; ++i) {
    const double x = shortening_at(unit_[i], unit_limit_[i], force_N);
    const UnitResponse r = model::indent::respond(unit_[i], x);
    out.shortening_m[i] = x;
    // RC-9  depth = sum x_i,  U = sum U_i,  1/K = sum 1/k_i
    out.depth_m += x;
    out.energy_J += r.energy_J;
    // At a snap k may be 0: the sum is then infinite, and K becomes 0.
    compliance_m_per_N += 1.0 / r.stiffness_N_per_m;
  }
  out.stiffness_N_per_m = 1.0 / compliance_m_per_N;
  return out;
}

ChainState RhombusChain::at_force(double force_N) const RT_SAFE {
  if (!std::isfinite(force_N)) return {.status = law::LawStatus::kInvalid};
  if (force_N > force_limit_N()) {
    ChainState out = solve_force(force_limit_N());
    out.status = law::LawStatus::kSaturated;
    return out;
  }
  // Without tangential springs nothing stops a pull before the rods are straight.
  if (force_N < 0.0 && unit_[0].tangential_stiffness_N_per_m == 0.0 &&
      force_N / unit_[0].normal_stiffness_N_per_m <= straight_m(unit_[0]))
    return {.status = law::LawStatus::kSingular};
  return solve_force(force_N);
}

ChainState RhombusChain::at_depth(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = law::LawStatus::kInvalid};
  if (depth_m <= straight_m_) return {.status = law::LawStatus::kSingular};
  if (depth_m >= range_.press_m) {
    ChainState out = solve_force(force_limit_N());
    if (depth_m > range_.press_m) out.status = law::LawStatus::kSaturated;
    return out;
  }
  // 0 is an end of the bracket, which a Newton step may not reach.
  if (depth_m == 0.0) return solve_force(0.0);
  // Newton in F with slope 1/K inside a bracket; a pull has no lower bound, so it grows one.
  double low = 0.0, high = force_limit_N();
  if (depth_m < 0.0) {
    high = 0.0, low = -force_limit_N();
    for (int i = 0; i < kMaxChainSteps && solve_force(low).depth_m > depth_m; ++i) low *= 2.0;
  }
  double force_N = solve_force(0.0).stiffness_N_per_m * depth_m;
  if (!(force_N > low && force_N < high)) force_N = 0.5 * (low + high);
  for (int i = 0; i < kMaxChainSteps; ++i) {
    const ChainState at = solve_force(force_N);
    (at.depth_m < depth_m ? low : high) = force_N;
    double next = force_N - (at.depth_m - depth_m) * at.stiffness_N_per_m;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool done = std::abs(next - force_N) <= 4e-16 * std::abs(next);
    force_N = next;
    if (done) break;
  }
  ChainState out = solve_force(force_N);
  // What was asked; the sum of the x_i is off by their rounding.
  out.depth_m = depth_m;
  return out;
}

law::LawResponse RhombusChain::respond(double depth_m) const RT_SAFE {
  return law::response_of(at_depth(depth_m), range_.press_m, depth_m);
}

std::size_t RhombusChain::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const ChainState at = at_depth(depth_m);
  // RC-11  u_j = sum of x_i, i > j, from the far end inwards; u_N = 0
  double u = 0.0;
  for (std::size_t j = count_ + 1; j-- > 0;) {
    if (j < count_) u += at.shortening_m[j];
    if (j < ring_m.size()) ring_m[j] = u;
  }
  return count_ + 1 < ring_m.size() ? count_ + 1 : ring_m.size();
}

}  // namespace tact::model::indent
