// SPDX-License-Identifier: Apache-2.0
#include "model/indent/hex_sheet.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>

#include "model/ranges.h"

namespace tact::model::indent {
namespace {

// 20 steps are enough for every sheet that the tests try.
constexpr int kMaxSheetSteps = 60;
constexpr int kMaxHalvings = 30;
// HX-28: the force settles with a few rings; this many stand for a sheet without end.
constexpr std::size_t kEndlessRings = 255;

constexpr std::array kWeights{
    Choice{"node", "a body spring per node: an elastic foundation"},
    Choice{"ring", "a body spring per ring"},
};
static_assert(kWeights.size() == static_cast<std::size_t>(HexWeight::kRing) + 1);

std::optional<Error> parameter_error(const HexSheetParameters& p) {
  if (auto wrong = check_meaning("hexagonal sheet", p)) return wrong;
  if (p.contact_stiffness_N_per_m + p.surface_stiffness_N_per_m + p.tension_N == 0.0)
    return Error{
        "hexagonal sheet: contact_stiffness_N_per_m, surface_stiffness_N_per_m and tension_N are "
        "all 0, so nothing resists the tool: raise one of them"};
  if (p.rings == 0) return Error{"hexagonal sheet: rings = 0; allowed: 1 or more"};
  return std::nullopt;
}

struct SpringForce {
  double force_N, slope_N_per_m, energy_J;
};

/// One surface spring at the drop l, m: its force across the surface.
SpringForce surface_spring(const HexSheetParameters& p, double l) RT_SAFE {
  const double r = p.ring_pitch_m, s = std::sqrt(r * r + l * l);
  // HX-20  e = s - r, without cancellation
  const double e = l * l / (s + r);
  const double tension_N = p.surface_stiffness_N_per_m * e + p.tension_N, share = r / s;
  return {// HX-21  p(l) = (K_T e + T0) l/s and its slope
          .force_N = tension_N * l / s,
          .slope_N_per_m =
              p.surface_stiffness_N_per_m * (l / s) * (l / s) + tension_N * share * share / s,
          .energy_J = e * (0.5 * p.surface_stiffness_N_per_m * e + p.tension_N)};
}

/// The rings 0 .. m of a sheet and the Newton system of its inner ones, without a heap.
template <std::size_t kRings>
class Solver {
 public:
  Solver(const HexSheetParameters& p, std::size_t rings, double depth_m) RT_SAFE : p_(p),
                                                                                   m_(rings) {
    for (std::size_t i = 0; i <= m_; ++i) {  // HX-24  w_i = d (1 - i/m)^3
      const double left = static_cast<double>(m_ - i) / static_cast<double>(m_);
      w_[i] = depth_m * left * left * left;
    }
    energy_J_ = assemble();
    for (iterations_ = 0; iterations_ < kMaxSheetSteps; ++iterations_)
      // A step below the rounding of the depth: nothing moves any more.
      if (newton_step() <= 1e-13 * depth_m) break;
  }

  double displacement_m(std::size_t i) const RT_SAFE { return w_[i]; }
  int iterations() const RT_SAFE { return iterations_; }
  double energy_J() const RT_SAFE { return energy_J_; }

  double force_N() const RT_SAFE {
    // HX-23  F = K_N0 d + 6 p(l_1)
    return p_.contact_stiffness_N_per_m * w_[0] + 6.0 * surface_spring(p_, w_[0] - w_[1]).force_N;
  }

  double boundary_force_N() const RT_SAFE {
    return springs(m_) * surface_spring(p_, w_[m_ - 1] - w_[m_]).force_N;
  }

  double stiffness_N_per_m() RT_SAFE {
    // dF/dd = K_N0 + 6 p'(l_1)(1 - dw_1/dd); dw/dd solves the Newton system for a unit of d
    const double first = 6.0 * surface_spring(p_, w_[0] - w_[1]).slope_N_per_m;
    // The matrix is that of the last assembly, at the solution; only its right side is new.
    for (std::size_t i = 1; i < m_; ++i) gradient_[i] = 0.0;
    if (m_ > 1) gradient_[1] = -first;
    solve();
    return p_.contact_stiffness_N_per_m + first * (m_ > 1 ? 1.0 - step_[1] : 1.0);
  }

 private:
  static double springs(std::size_t ring) RT_SAFE {
    return 6.0 * (2.0 * static_cast<double>(ring) - 1.0);
  }
  double body_N_per_m(std::size_t ring) const RT_SAFE {
    const double weight = p_.weight == HexWeight::kNode ? 6.0 * static_cast<double>(ring) : 1.0;
    return weight * p_.body_stiffness_N_per_m;
  }

  /// HX-20 at w, with its gradient HX-22 and its slope HX-24.
  double assemble() RT_SAFE {
    double energy = 0.5 * p_.contact_stiffness_N_per_m * w_[0] * w_[0];
    for (std::size_t i = 1; i < m_; ++i) {
      const double body = body_N_per_m(i);
      gradient_[i] = body * w_[i];
      diagonal_[i] = body;
      energy += 0.5 * body * w_[i] * w_[i];
    }
    for (std::size_t i = 1; i <= m_; ++i) {
      const double n = springs(i);
      const SpringForce spring = surface_spring(p_, w_[i - 1] - w_[i]);
      energy += n * spring.energy_J;
      beside_[i] = -n * spring.slope_N_per_m;  // between ring i-1 and ring i
      // Ring m is held and ring 0 is led by the tool: neither has an equation.
      if (i < m_) gradient_[i] -= n * spring.force_N, diagonal_[i] -= beside_[i];
      if (i > 1) gradient_[i - 1] += n * spring.force_N, diagonal_[i - 1] -= beside_[i];
    }
    return energy;
  }

  /// step = -slope^-1 gradient, by elimination from ring 1 outwards and back.
  void solve() RT_SAFE {
    for (std::size_t i = 1; i < m_; ++i) {
      // No search for pivots: with K_N > 0 the matrix is positive definite.
      const double factor = i > 1 ? beside_[i] / pivot_[i - 1] : 0.0;
      pivot_[i] = diagonal_[i] - (i > 1 ? factor * beside_[i] : 0.0);
      step_[i] = -gradient_[i] - (i > 1 ? factor * step_[i - 1] : 0.0);
    }
    for (std::size_t i = m_; i-- > 1;) {
      if (i + 1 < m_) step_[i] -= beside_[i + 1] * step_[i + 1];
      step_[i] /= pivot_[i];
    }
  }

  /// One step, halved while the energy grows by more than rounding; returns its largest part.
  double newton_step() RT_SAFE {
    solve();
    const std::array<double, kRings + 1> before = w_;
    double share = 1.0, largest = 0.0;
    for (int i = 0; i < kMaxHalvings; ++i, share *= 0.5) {
      largest = 0.0;
      for (std::size_t j = 1; j < m_; ++j) {
        w_[j] = before[j] + share * step_[j];
        largest = std::fmax(largest, std::abs(share * step_[j]));
      }
      const double energy = assemble();
      // U is convex, so a short enough step lowers it; rounding alone may not stop the search.
      const bool lower = energy <= energy_J_ * (1.0 + 1e-14);
      if (lower || i + 1 == kMaxHalvings) {
        energy_J_ = energy;
        break;
      }
    }
    return largest;
  }

  const HexSheetParameters& p_;
  std::size_t m_;
  int iterations_ = 0;
  double energy_J_ = 0.0;
  std::array<double, kRings + 1> w_{}, gradient_{}, diagonal_{}, beside_{}, pivot_{}, step_{};
};

double endless_force_N(const HexSheetParameters& p, std::size_t rings) {
  return Solver<kEndlessRings>(p, rings, p.working_depth_m).force_N();
}

}  // namespace

void visit(ParameterVisitor& v, HexSheetParameters& p) {
  v.choice("weight", kWeights, "body springs: one per node, or one per ring", p.weight);
  v.number("ring_pitch_m", {1e-4, 0.05}, "r, length of a surface spring", p.ring_pitch_m);
  v.number("contact_stiffness_N_per_m", {0.0, 1e5}, "K_N0, body spring at the contact",
           p.contact_stiffness_N_per_m);
  v.number("body_stiffness_N_per_m", {0.01, 1e5}, "K_N, the other body springs",
           p.body_stiffness_N_per_m);
  v.number("surface_stiffness_N_per_m", {0.0, 1e6}, "K_T, springs along the surface",
           p.surface_stiffness_N_per_m);
  v.number("tension_N", {0.0, 100.0}, "T0, of the surface springs at rest", p.tension_N);
  v.number("working_depth_m", kDepth_m, "press and pull up to here", p.working_depth_m);
  v.count("rings", {0, kMaxHexRings}, "m; 0: the fewest that meet [tolerance]", p.rings,
          Need::kOptional);
}

Result<HexSheet> make_hex_sheet(const HexSheetParameters& p) {
  if (auto wrong = parameter_error(p)) return *wrong;
  return HexSheet(p);
}

HexSheetState HexSheet::at_depth(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = law::LawStatus::kInvalid};
  const double limit_m = p_.working_depth_m, asked_m = std::abs(depth_m);
  Solver<kMaxHexRings> solver(p_, p_.rings, asked_m < limit_m ? asked_m : limit_m);
  const double sign = depth_m < 0.0 ? -1.0 : 1.0;  // F(-d) = -F(d)
  HexSheetState out{.force_N = sign * solver.force_N(),
                    .energy_J = solver.energy_J(),
                    .boundary_force_N = sign * solver.boundary_force_N(),
                    .iterations = solver.iterations(),
                    .status = asked_m > limit_m ? law::LawStatus::kSaturated : law::LawStatus::kOk};
  for (std::size_t i = 0; i <= p_.rings; ++i) out.ring_m[i] = sign * solver.displacement_m(i);
  out.stiffness_N_per_m = solver.stiffness_N_per_m();
  return out;
}

law::LawResponse HexSheet::respond(double depth_m) const RT_SAFE {
  const HexSheetState at = at_depth(depth_m);
  return law::response_of(at, at.ring_m[0], depth_m);
}

std::size_t HexSheet::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const HexSheetState at = at_depth(depth_m);
  const std::size_t count = p_.rings + 1 < ring_m.size() ? p_.rings + 1 : ring_m.size();
  for (std::size_t i = 0; i < count; ++i) ring_m[i] = at.ring_m[i];
  return count;
}

Result<std::size_t> rings_for_tolerance(const HexSheetParameters& parameters,
                                        double tolerance_ratio) {
  HexSheetParameters p = parameters;
  p.rings = kMaxHexRings;
  if (auto wrong = parameter_error(p)) return *wrong;
  if (!is_positive(tolerance_ratio))
    return Error{"hexagonal sheet: the force tolerance must be finite and above 0"};
  const double endless_N = endless_force_N(p, kEndlessRings);
  double miss_ratio = 0.0;
  for (std::size_t rings = 1; rings <= kMaxHexRings; ++rings) {
    // Holding the rim closer only stiffens the sheet: the force falls towards the endless one.
    miss_ratio = endless_force_N(p, rings) / endless_N - 1.0;
    if (std::abs(miss_ratio) <= tolerance_ratio) return rings;
  }
  return Error{
      fmt::format("hexagonal sheet: {} rings still miss the force of an endless sheet by {:g} %; "
                  "allow a larger force error or take a larger ring_pitch_m or less tension_N",
                  kMaxHexRings, 100.0 * miss_ratio)};
}

}  // namespace tact::model::indent
