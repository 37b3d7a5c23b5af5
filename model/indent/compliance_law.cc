// SPDX-License-Identifier: Apache-2.0
#include "model/indent/compliance_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "model/law/ring_taper.h"
#include "model/ranges.h"

namespace tact::model::indent {
namespace {

// Of the doublings, and of Newton and bisection together,
// which need 60 for the last bit of a double.
constexpr int kMaxTipSteps = 100;

const char* parameter_error(const ComplianceCurveParameters& p) {
  if (!is_positive(p.tip.youngs_modulus_Pa)) return "youngs_modulus_Pa must be finite and above 0";
  if (!(p.tip.poisson_ratio >= 0.0 && p.tip.poisson_ratio <= 0.5))
    return "poisson_ratio must lie between 0 and 0.5";
  if (!is_positive(p.tip.radius_m)) return "the tip's radius must be finite and above 0";
  if (!is_positive(p.working_depth_m)) return "working_depth_m must be finite and above 0";
  if (!is_positive(p.ring_pitch_m)) return "ring_pitch_m must be finite and above 0";
  if (p.ring_m_per_N.empty() || p.ring_m_per_N.size() > kMaxComplianceRings)
    return "there must be 1 to 31 rings";
  if (!std::all_of(p.ring_m_per_N.begin(), p.ring_m_per_N.end(),
                   [](double g) { return std::isfinite(g); }))
    return "the rings must be finite";
  if (p.table_knots < 2 || p.table_knots > law::kMaxKnots)
    return "table_knots must lie between 2 and 257";
  // CL-3 must stay positive however deep the tip.
  const double r = p.regular_m_per_N;
  if (!(std::isfinite(r) && 1.0 + p.tip.stiffest_press_N_per_m() * r > 0.0 &&
        1.0 + p.tip.pulled_stiffness_N_per_m() * r > 0.0))
    return "the place is stiffer than its own surface: it lies on the held side; choose a smaller "
           "tip";
  return nullptr;
}

}  // namespace

Result<ComplianceCurve> make_compliance_curve(const ComplianceCurveParameters& p) {
  if (const char* wrong = parameter_error(p)) return Error{std::string("compliance: ") + wrong};
  ComplianceCurve curve;
  curve.tip_ = p.tip;
  // In this order: r is still 0, so exact() speaks of the tip alone. CT-8 ends at this indentation
  // of it.
  const TipState last = curve.exact(kDeepestIndentation_ratio * p.tip.radius_m);
  curve.regular_m_per_N_ = p.regular_m_per_N;
  curve.press_depth_m_ = p.working_depth_m;
  if (p.tip.large_strain)
    curve.press_depth_m_ = std::min(p.working_depth_m,
                                    last.depth_m + p.regular_m_per_N * last.force_N);  // CL-1
  // CL-2  d = (c_disc + r) F
  curve.pulled_N_per_m_ = 1.0 / (1.0 / p.tip.pulled_stiffness_N_per_m() + p.regular_m_per_N);
  curve.pull_depth_m_ = p.pull_depth_m > 0.0 ? p.pull_depth_m : p.working_depth_m;
  curve.ring_pitch_m_ = p.ring_pitch_m;
  curve.rings_ = p.ring_m_per_N.size();
  curve.ring_m_per_N_[0] = p.regular_m_per_N;
  std::copy(p.ring_m_per_N.begin(), p.ring_m_per_N.end(), curve.ring_m_per_N_.begin() + 1);
  const double step_m = curve.press_depth_m_ / static_cast<double>(p.table_knots - 1);
  curve.press_ = law::HermiteTable(step_m, p.table_knots, [&curve, &p](double depth_m) {
    const TipState at = curve.exact(depth_m);
    const double k = at.stiffness_N_per_m;
    return law::CurvePoint{.value = at.force_N,
                           .slope = k / (1.0 + k * p.regular_m_per_N)};  // CL-3
  });
  return curve;
}

TipState ComplianceCurve::exact(double depth_m) const RT_SAFE {
  if (!(depth_m > 0.0)) return {};
  // CL-1 in s, where a = R tanh s: d(s) = d_tip(s) + r F(s) grows with s.
  const auto below = [this, depth_m](const TipState& t)
                         RT_SAFE { return depth_m - t.depth_m - regular_m_per_N_ * t.force_N; };
  // R s tanh s grows without limit, and CL-3 keeps the
  // slope above zero: some doubling is deep enough.
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kMaxTipSteps && below(tip_state(tip_, high)) > 0.0; ++i)
    low = high, high *= 2.0;
  double s = 0.5 * (low + high);
  for (int i = 0; i < kMaxTipSteps; ++i) {
    const TipState at = tip_state(tip_, s);
    const double miss_m = below(at);
    (miss_m > 0.0 ? low : high) = s;
    // dd/ds = (d d_tip / ds)(1 + K_tip r),  d d_tip / ds = R (tanh s + s / cosh^2 s)
    const double t = std::tanh(s);
    const double slope_m =
        tip_.radius_m * (t + s * (1.0 - t * t)) * (1.0 + at.stiffness_N_per_m * regular_m_per_N_);
    double next = s + miss_m / slope_m;
    // Newton where it stays in the bracket, else the middle:
    // so the bracket shrinks for any slope.
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const bool done = std::abs(next - s) <= 4e-16 * next;
    s = next;
    if (done) break;
  }
  return tip_state(tip_, s);
}

law::LawResponse ComplianceCurve::respond(double depth_m) const RT_SAFE {
  if (!std::isfinite(depth_m)) return {.status = law::LawStatus::kInvalid};
  const double inside_m = std::clamp(depth_m, -pull_depth_m_, press_depth_m_);
  law::LawResponse out;
  if (inside_m > 0.0) {
    const law::CurvePoint p = press_.at(inside_m);
    out = {p.value, p.slope, p.integral, law::LawStatus::kOk};
  } else {
    const double k = pulled_N_per_m_;
    // At rest the slope jumps from the pull's to zero: the mean of both.
    out = {k * inside_m, inside_m < 0.0 ? k : 0.5 * k, 0.5 * k * inside_m * inside_m,
           law::LawStatus::kOk};
  }
  return law::beyond_limit(out, inside_m, depth_m);
}

std::size_t ComplianceCurve::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  const double d_m = std::isfinite(depth_m) ? std::abs(depth_m) : 0.0;
  const bool pulled = depth_m < 0.0;
  const TipState press = pulled ? TipState{} : exact(d_m);
  const double force_N = pulled ? pulled_N_per_m_ * d_m : press.force_N;
  const double disc_m = force_N / tip_.pulled_stiffness_N_per_m();
  double before_m = d_m;
  for (std::size_t j = 0; j <= rings_ && j < ring_m.size(); ++j) {
    const double rho_m = static_cast<double>(j) * ring_pitch_m_;
    const double tip_m =
        pulled ? disc_m * pulled_shape(tip_, rho_m) : pressed_shape_m(tip_, press, rho_m);
    // CL-4  u_j = taper_j (u_tip(rho_j) + F g_j),  u_0 = d
    const double u_m =
        j == 0 ? d_m : law::ring_taper(j, rings_) * (tip_m + force_N * ring_m_per_N_[j]);
    // CL-4  0 <= u_j <= u_(j-1): an indentation is drawn as one bowl; errors of the map do not
    //       ripple it.
    before_m = std::clamp(u_m, 0.0, before_m);
    ring_m[j] = pulled ? -before_m : before_m;
  }
  return std::min(rings_ + 1, ring_m.size());
}

Result<ComplianceCurve> half_space_under(double radius_m, double working_depth_m) {
  constexpr double kRingsPerRadius =
      3.0;  // LW-4: the indentation bends most at the rim of the touch
  constexpr std::size_t kRings = 23;
  return half_space_under(radius_m, working_depth_m, radius_m / kRingsPerRadius, kRings);
}

Result<ComplianceCurve> half_space_under(double radius_m, double working_depth_m,
                                         double ring_pitch_m, std::size_t rings) {
  constexpr std::array<double, kMaxComplianceRings> kNothingRegular{};
  return make_compliance_curve(
      // nu = 0, so that E* is E, 1 Pa: its force is scaled by who asks.
      {.tip = {.youngs_modulus_Pa = 1.0, .poisson_ratio = 0.0, .radius_m = radius_m},
       .working_depth_m = working_depth_m,
       .ring_pitch_m = ring_pitch_m,
       .ring_m_per_N = std::span(kNothingRegular).first(rings)});
}

}  // namespace tact::model::indent
