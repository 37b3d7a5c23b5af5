// SPDX-License-Identifier: Apache-2.0
#include "model/indent/membrane.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "model/law/ring_taper.h"
#include "model/ranges.h"

namespace tact::model::indent {
namespace {

// Chosen: the force is within 1e-4 of that with half the steps and twice the radii.
constexpr double kStepsPerLength = 25.0, kLengths = 14.0;  // of sqrt(T / k)
constexpr double kStep_ratio = 0.1;                        // of the radius, at most
constexpr int kBisections = 44;
constexpr int kIntervals = 64;  // of HX-33
constexpr double kNextRadius_ratio = 1.05;
constexpr double kFirstRadius_ratio = 0.01;  // of sqrt(2 R d_w), the radius at the working depth

struct Press {
  double depth_m = 0.0, force_N = 0.0;
};

class MembraneSolver {
 public:
  MembraneSolver(const MembraneParameters& p, double tip_radius_m)
      : p_(p),
        tip_radius_m_(tip_radius_m),
        length_m_(std::sqrt(p.tension_N_per_m / p.foundation_Pa_per_m)) {}

  Press at(double contact_radius_m) const {
    const double a = contact_radius_m, slope = -a / tip_radius_m_;
    double low_m = 0.0, high_m = a * a / tip_radius_m_ + 6.0 * length_m_ * a / tip_radius_m_;
    while (crosses(a, high_m, slope)) high_m *= 2.0;
    for (int i = 0; i < kBisections; ++i) {
      const double middle_m = 0.5 * (low_m + high_m);
      (crosses(a, middle_m, slope) ? low_m : high_m) = middle_m;
    }
    const double edge_m = 0.5 * (low_m + high_m), depth_m = edge_m + 0.5 * a * a / tip_radius_m_;
    // HX-33  the pressure inside, and the membrane that pulls at its edge
    const double force_N = 2.0 * std::numbers::pi *
                           (tip_radius_m_ * pressure_integral(edge_m, depth_m) +
                            p_.tension_N_per_m * a * a / tip_radius_m_);
    return {.depth_m = depth_m, .force_N = force_N};
  }

 private:
  double pressure_Pa(double w_m) const {
    return p_.foundation_Pa_per_m * w_m /
           std::pow(1.0 + std::max(w_m, 0.0) / p_.softening_depth_m, p_.softening_exponent);
  }

  /// Simpson's rule.
  double pressure_integral(double from_m, double to_m) const {
    const double h = (to_m - from_m) / kIntervals;
    double sum = pressure_Pa(from_m) + pressure_Pa(to_m);
    for (int i = 1; i < kIntervals; ++i)
      sum += (i % 2 == 0 ? 2.0 : 4.0) * pressure_Pa(from_m + i * h);
    return sum * h / 3.0;
  }

  /// Whether a membrane that leaves the tip so comes below the resting surface: w(a) is too small.
  bool crosses(double r_m, double w_m, double slope) const {
    const auto bend = [this](double r, double w, double s) {
      return pressure_Pa(w) / p_.tension_N_per_m - s / r;
    };
    const double end_m = r_m + kLengths * length_m_;
    while (r_m < end_m) {  // bounded: each step is a part of the radius, which grows
      const double h = std::min(length_m_ / kStepsPerLength, kStep_ratio * r_m);
      const double w1 = slope, s1 = bend(r_m, w_m, slope);
      const double w2 = slope + 0.5 * h * s1, s2 = bend(r_m + 0.5 * h, w_m + 0.5 * h * w1, w2);
      const double w3 = slope + 0.5 * h * s2, s3 = bend(r_m + 0.5 * h, w_m + 0.5 * h * w2, w3);
      const double w4 = slope + h * s3, s4 = bend(r_m + h, w_m + h * w3, w4);
      w_m += h / 6.0 * (w1 + 2.0 * w2 + 2.0 * w3 + w4);
      slope += h / 6.0 * (s1 + 2.0 * s2 + 2.0 * s3 + s4);
      r_m += h;
      if (w_m < 0.0) return true;
      if (slope > 0.0) return false;
    }
    return false;
  }

  MembraneParameters p_;
  double tip_radius_m_, length_m_;
};

/// ln F linear in ln d; below the first press F ~ d^e with its exponent.
law::CurvePoint between(const std::vector<Press>& presses, double depth_m) {
  if (depth_m <= 0.0) return {};
  const auto after = std::ranges::upper_bound(presses, depth_m, {}, &Press::depth_m);
  const auto next = std::clamp(after, presses.begin() + 1, presses.end() - 1);
  const Press &b = *next, &a = *(next - 1);
  const double e = std::log(b.force_N / a.force_N) / std::log(b.depth_m / a.depth_m);
  const double force_N = a.force_N * std::pow(depth_m / a.depth_m, e);
  return {.value = force_N, .slope = e * force_N / depth_m};
}

}  // namespace

law::LawResponse Membrane::respond(double depth_m) const RT_SAFE {
  return law::press_response(depth_m, press_.end(), [this](double inside_m) RT_SAFE {
    const law::CurvePoint at = press_.at(inside_m);
    return law::LawResponse{
        .force_N = at.value, .stiffness_N_per_m = at.slope, .energy_J = at.integral};
  });
}

std::size_t Membrane::profile(double depth_m, std::span<double> ring_m) const RT_SAFE {
  return law::lone_profile(depth_m, ring_m);
}

void visit(ParameterVisitor& v, MembraneParameters& p) {
  v.number("tension_N_per_m", {1e-3, 1e4}, "T of the membrane", p.tension_N_per_m);
  v.number("foundation_Pa_per_m", {1e2, 1e9}, "k: pressure over depth of a light press",
           p.foundation_Pa_per_m);
  v.number("softening_depth_m", {1e-5, 1.0}, "w_0: the foundation softens from here on",
           p.softening_depth_m);
  v.number("softening_exponent", {0.0, 2.0, kHard}, "g: 0 is linear", p.softening_exponent);
  v.number("working_depth_m", kDepth_m, "press up to here", p.working_depth_m);
}

Result<Membrane> make_membrane(const MembraneParameters& p, double tip_radius_m) {
  if (auto wrong = check_meaning("membrane", p)) return *wrong;
  if (!is_positive(tip_radius_m)) return Error{"membrane: the tip's radius must be above 0"};
  const MembraneSolver solver(p, tip_radius_m);
  std::vector<Press> presses;
  double a_m = kFirstRadius_ratio * std::sqrt(2.0 * tip_radius_m * p.working_depth_m);
  // The depth is at least a^2 / (2 R), so it gets there.
  while (presses.size() < 2 || presses.back().depth_m < p.working_depth_m) {
    const Press next = solver.at(a_m);
    if (!presses.empty() &&
        !(next.depth_m > presses.back().depth_m && next.force_N > presses.back().force_N))
      return Error{
          "membrane: the force does not rise with the depth; lower softening_exponent or raise "
          "softening_depth_m"};
    presses.push_back(next);
    a_m *= kNextRadius_ratio;
  }
  return Membrane(law::HermiteTable(p.working_depth_m / (law::kMaxKnots - 1), law::kMaxKnots,
                                    [&presses](double d) { return between(presses, d); }));
}

}  // namespace tact::model::indent
