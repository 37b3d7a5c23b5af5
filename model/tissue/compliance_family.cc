// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/compliance_family.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tact::model::tissue {
namespace {

// Chosen: 17 are within 0.5 % already, and the loop may touch all of them.
constexpr std::size_t kMaxCurves = 65;

/// r and r_pull of every vertex, m/N.
struct Compliances {
  std::vector<double> press_m_per_N, pull_m_per_N;
  std::size_t limited_vertices = 0;
};

/// CF-3, each limited to kMaxStiffness_ratio.
Compliances compliances_of(const ComplianceMap& map, const indent::ElasticTip& tip) {
  const double disc = 1.0 / tip.pulled_stiffness_N_per_m();
  const double side = 1.0 / tip.sideways_stiffness_N_per_m();
  const double sphere = 1.0 / tip.stiffest_press_N_per_m();
  // r at which a place is kMaxStiffness_ratio times as stiff; the
  // smaller compliance keeps press and pull both within it.
  const double least = (1.0 / contact::kMaxStiffness_ratio - 1.0) * std::min(disc, sphere);
  Compliances out;
  for (std::size_t v = 0; v < map.vertices(); ++v) {
    const auto scaled = [&tip](float times_E_per_m) {
      return static_cast<double>(times_E_per_m) / tip.youngs_modulus_Pa;
    };
    const double r = scaled(map.regular_times_E_per_m[v]);
    const SidewaysCompliance& s = map.sideways_times_E_per_m[v];
    // n^2 / (c_side + s), where s, too, is limited: errors of the map may not turn its sign.
    const auto kept = [&](float n, float own) {
      return scaled(n) * scaled(n) /
             std::max(side + scaled(own), side / contact::kMaxStiffness_ratio);
    };
    // CF-3  r_pull = r - n1^2/(c_side + s1) - n2^2/(c_side + s2)
    const double pull = r - kept(s.n1, s.s1) - kept(s.n2, s.s2);
    out.limited_vertices += r < least || pull < least ? 1 : 0;
    out.press_m_per_N.push_back(std::max(r, least));
    out.pull_m_per_N.push_back(std::max(pull, least));
  }
  return out;
}

/// Mean rings of the vertices near curve k, m/N; far vertices count so little that any nearer one
/// outweighs them.
std::vector<double> rings_near(const ComplianceMap& map, std::span<const float> kappa, double k,
                               double youngs_modulus_Pa) {
  std::vector<double> sum(map.rings, 0.0);
  double weights = 0.0;
  for (std::size_t v = 0; v < map.vertices(); ++v) {
    const double away = static_cast<double>(kappa[v]) - k;
    // Half a curve wide. exp(-600) is above zero, so some vertex always counts.
    const double weight = std::exp(-std::min(2.0 * away * away, 600.0));
    weights += weight;
    for (std::size_t j = 0; j < map.rings; ++j)
      sum[j] += weight * static_cast<double>(map.ring_times_E_per_m[v * map.rings + j]);
  }
  for (double& g : sum) g /= weights * youngs_modulus_Pa;
  return sum;
}

Vec3 vector_of(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

/// s v v'
/// As TangentTensors has it.
std::array<float, 6> symmetric(const Mat3& m) {
  std::array<float, 6> out{};
  std::ranges::transform(
      std::array{m.row[0].x, m.row[1].y, m.row[2].z, m.row[1].z, m.row[2].x, m.row[0].y},
      out.begin(), [](double v) { return static_cast<float>(v); });
  return out;
}

Mat3 square(double s, const Vec3& v) { return {{s * v.x * v, s * v.y * v, s * v.z * v}}; }

/// The position of a compliance among the curves.
struct Scale {
  double disc_m_per_N, soft_N_per_m, span;  // c_disc; q_0; ln(q_(K-1) / q_0)
  double last;                              // K - 1

  // CF-1  q = 1/(c_disc + r)
  double stiffness_N_per_m(double r_m_per_N) const { return 1.0 / (disc_m_per_N + r_m_per_N); }
  // CF-2  kappa = (K - 1) ln(q/q_0)/ln(q_(K-1)/q_0)
  float coordinate(double r_m_per_N) const {
    return static_cast<float>(
        std::clamp(last * std::log(stiffness_N_per_m(r_m_per_N) / soft_N_per_m) / span, 0.0, last));
  }
  /// r of the curve `at`.
  double regular_m_per_N(double at) const {
    return 1.0 / (soft_N_per_m * std::exp(span * at / last)) - disc_m_per_N;
  }
};

/// From the softest press to the stiffest pull.
Scale scale_of(const Compliances& of, double disc_m_per_N, std::size_t curves) {
  Scale scale{.disc_m_per_N = disc_m_per_N,
              .soft_N_per_m = 0.0,
              .span = 0.0,
              .last = static_cast<double>(curves - 1)};
  // r_pull <= r (CF-3): the softest place presses, the stiffest one pulls.
  scale.soft_N_per_m =
      scale.stiffness_N_per_m(*std::max_element(of.press_m_per_N.begin(), of.press_m_per_N.end()));
  const double stiff_N_per_m =
      scale.stiffness_N_per_m(*std::min_element(of.pull_m_per_N.begin(), of.pull_m_per_N.end()));
  // An organ that gives alike everywhere has a span of 0, by which CF-2 divides.
  scale.span = std::max(std::log(stiff_N_per_m / scale.soft_N_per_m), 1e-9);
  return scale;
}

}  // namespace

std::vector<TangentTensors> tangent_compliance(const ComplianceMap& map,
                                               std::span<const Vec3> vertex_normal,
                                               double tip_radius_m) {
  const indent::ElasticTip unit{
      .youngs_modulus_Pa = 1.0, .poisson_ratio = map.poisson_ratio, .radius_m = tip_radius_m};
  const double disc = 1.0 / unit.pulled_stiffness_N_per_m();
  const double side = 1.0 / unit.sideways_stiffness_N_per_m();
  std::vector<TangentTensors> out;
  for (std::size_t v = 0; v < map.vertices(); ++v) {
    const SidewaysCompliance& g = map.sideways_times_E_per_m[v];
    const Vec3 a1 = vector_of(g.axis), a2 = cross(vertex_normal[v], a1);
    const auto no_stiffer = [side](float s) {
      return std::max(static_cast<double>(s), (1.0 / contact::kMaxStiffness_ratio - 1.0) * side);
    };
    const double s1 = no_stiffer(g.s1), s2 = no_stiffer(g.s2);
    // CF-4, with as much of n as leaves S_held within the limit
    const double n1 = static_cast<double>(g.n1), n2 = static_cast<double>(g.n2);
    const double normal = std::max(disc + static_cast<double>(map.regular_times_E_per_m[v]),
                                   disc / contact::kMaxStiffness_ratio);
    // How much of S may go until that direction is kMaxStiffness_ratio times as stiff.
    const auto room = [side](double s) {
      return std::max(s + (1.0 - 1.0 / contact::kMaxStiffness_ratio) * side, 1e-9 * side);
    };
    const double most = n1 * n1 / room(s1) + n2 * n2 / room(s2);
    const double share = 1.0 / std::max(normal, most);
    const Mat3 s = square(s1, a1) + square(s2, a2);
    out.push_back({.contact_per_m = symmetric(s),
                   .held_per_m = symmetric(s + square(-share, n1 * a1 + n2 * a2))});
  }
  return out;
}

Result<ComplianceFamily> make_compliance_family(const ComplianceMap& map,
                                                const ComplianceFamilyParameters& p) {
  if (p.curves < 2 || p.curves > kMaxCurves)
    return Error{"compliance: curves must lie between 2 and 65"};
  if (map.vertices() == 0) return Error{"compliance: the map has no vertices"};
  const indent::ElasticTip tip{.youngs_modulus_Pa = p.youngs_modulus_Pa,
                               .poisson_ratio = map.poisson_ratio,
                               .radius_m = p.tip_radius_m};
  const Compliances of = compliances_of(map, tip);
  const Scale scale = scale_of(of, 1.0 / tip.pulled_stiffness_N_per_m(), p.curves);
  ComplianceFamily out;
  out.limited_vertices = of.limited_vertices;
  for (const double r : of.press_m_per_N) out.press_coordinate.push_back(scale.coordinate(r));
  for (const double r : of.pull_m_per_N) out.pull_coordinate.push_back(scale.coordinate(r));
  for (std::size_t k = 0; k < p.curves; ++k) {
    const double at = static_cast<double>(k);
    const std::vector<double> rings =
        rings_near(map, out.press_coordinate, at, p.youngs_modulus_Pa);
    for (const double g : rings)
      out.ring_times_E_per_m.push_back(static_cast<float>(g * p.youngs_modulus_Pa));
    auto curve = indent::make_compliance_curve({.tip = tip,
                                                .regular_m_per_N = scale.regular_m_per_N(at),
                                                .working_depth_m = p.working_depth_m,
                                                .ring_pitch_m = map.ring_pitch_m,
                                                .ring_m_per_N = rings,
                                                .table_knots = p.table_knots});
    if (!curve) return curve.error();
    out.curve.push_back(std::move(*curve));
  }
  return out;
}

}  // namespace tact::model::tissue
