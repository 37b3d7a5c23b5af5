// SPDX-License-Identifier: Apache-2.0
#include "model/tissue/elastic_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "model/law/law_bounds.h"
#include "model/law/ring_taper.h"
#include "model/tissue/indentation_tilt.h"

namespace tact::model::tissue {
namespace {

// More than telemetry shows (32) and than any family has (kMaxComplianceRings + 1).
constexpr std::size_t kMaxProfile = 64;

// Of two parts of one force: a limit reached by either is reported.
law::LawStatus worse(law::LawStatus a, law::LawStatus b) RT_SAFE {
  return b >= law::LawStatus::kSaturated && b > a ? b : a;
}

}  // namespace

ElasticField::ElasticField(const ElasticFieldParts& parts) : parts_(parts) {
  // Once, at set-up: coupling asks for it every tick.
  for (const law::Law* curve : parts_.curves)
    stiffest_N_per_m_.push_back(
        law::stiffest_N_per_m(*curve, curve->range().pull_m, curve->range().press_m));
}

std::span<const float> ElasticField::coordinate(double depth_m) const RT_SAFE {
  return depth_m < 0.0 && !parts_.pull_coordinate.empty() ? parts_.pull_coordinate
                                                          : parts_.coordinate;
}

ElasticField::Blend ElasticField::blend_at(const contact::SurfacePoint& surface_point,
                                           double depth_m) const RT_SAFE {
  if (parts_.curves.size() < 2) return {};
  const std::span<const float> of_vertex = coordinate(depth_m);
  const contact::TriangleCorners& corner = parts_.surface.triangle[surface_point.triangle];
  double kappa = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    kappa += surface_point.weight[i] * static_cast<double>(of_vertex[corner[i]]);
  // The last curve has none above it: there f is 1.
  const std::size_t last = parts_.curves.size() - 2;
  const std::size_t low = kappa > 0.0 ? std::min(static_cast<std::size_t>(kappa), last) : 0;
  return {.low = low, .fraction = kappa - static_cast<double>(low)};
}

// grad kappa of a linear function on a triangle: sum of kappa_i (n x opposite edge i) / (2 area).
Vec3 ElasticField::coordinate_slope(std::uint32_t triangle, double depth_m) const RT_SAFE {
  const contact::SurfaceView& s = parts_.surface;
  const contact::TriangleCorners& corner = s.triangle[triangle];
  const Vec3 &a = s.vertex_m[corner[0]], &b = s.vertex_m[corner[1]], &c = s.vertex_m[corner[2]];
  const Vec3 twice_area = cross(b - a, c - a);
  const std::span<const float> of_vertex = coordinate(depth_m);
  Vec3 sum = static_cast<double>(of_vertex[corner[0]]) * (c - b);
  sum += static_cast<double>(of_vertex[corner[1]]) * (a - c);
  sum += static_cast<double>(of_vertex[corner[2]]) * (b - a);
  return cross(twice_area, sum) / dot(twice_area, twice_area);
}

ElasticField::Part ElasticField::part_at(const contact::SurfacePoint& surface_point,
                                         double depth_m) const RT_SAFE {
  const Blend blend = blend_at(surface_point, depth_m);
  // Energies are blended, and with the same f forces: so F stays dU/dd between two curves.
  const law::LawResponse soft = parts_.curves[blend.low]->respond(depth_m);
  if (parts_.curves.size() < 2) return {.law = soft};
  const law::LawResponse stiff = parts_.curves[blend.low + 1]->respond(depth_m);
  const double f = blend.fraction, step_J = stiff.energy_J - soft.energy_J;
  return {.law = {.force_N = soft.force_N + f * (stiff.force_N - soft.force_N),
                  .stiffness_N_per_m = soft.stiffness_N_per_m +
                                       f * (stiff.stiffness_N_per_m - soft.stiffness_N_per_m),
                  .energy_J = soft.energy_J + f * step_J,
                  .status = worse(soft.status, stiff.status)},
          .coordinate_slope_J = step_J};
}

// Kept while the sphere stays on its triangle: it is asked several times a tick.
const ElasticField::Gradient& ElasticField::gradient_at(const contact::Indentation& in) RT_SAFE {
  Gradient& gradient = gradient_[in.sphere];
  if (parts_.curves.size() < 2 || gradient.triangle == in.surface_point.triangle) return gradient;
  gradient.triangle = in.surface_point.triangle;
  gradient.per_m = {coordinate_slope(gradient.triangle, 0.0),
                    coordinate_slope(gradient.triangle, -1.0)};
  return gradient;
}

// Where nothing varies, the place does not matter.
bool ElasticField::is_known(const contact::Indentation& in) const RT_SAFE {
  return in.sphere < contact::kMaxSpheres && std::isfinite(in.indentation_m) &&
         (parts_.curves.size() < 2 || is_on_surface(in.surface_point, parts_.surface));
}

contact::ContactLawResponse ElasticField::respond(const contact::Indentation& in) RT_SAFE {
  if (!is_known(in)) return {.law = {.status = law::LawStatus::kInvalid}};
  const law::Relaxation& relaxation = parts_.relaxation;
  law::RelaxationState& next = next_[in.sphere];
  spheres_ = std::max(spheres_, in.sphere + 1);
  // From now_, not from next_: asked again in the same tick, the last answer counts.
  if (relaxation.terms() > 0) next = relaxation.after(now_[in.sphere], in.indentation_m, in.held);
  const Gradient& gradient = gradient_at(in);
  contact::ContactLawResponse sum{};
  for (std::size_t i = 0; i <= relaxation.terms(); ++i) {  // bound: terms + 1 (and the spring)
    const double depth_m = i == 0 ? in.indentation_m : next.stretch_m[i - 1];
    const Part part = part_at(in.surface_point, depth_m);
    // RX-4: q of this tick, for the next one.
    if (i > 0) next.flow_ratio[i - 1] = law::flow_ratio(depth_m, part.law);
    const double g = relaxation.share(i);
    sum.law.force_N += g * part.law.force_N;
    sum.law.stiffness_N_per_m += g * part.law.stiffness_N_per_m;
    sum.law.energy_J += g * part.law.energy_J;
    sum.law.status = i == 0 ? part.law.status : worse(sum.law.status, part.law.status);
    sum.slope_N += g * (part.coordinate_slope_J * gradient.per_m[depth_m < 0.0 ? 1 : 0]);
  }
  return sum;
}

// b is blended as the energy is.
double ElasticField::resistance_N(const contact::Indentation& in, double force_N) const RT_SAFE {
  if (!parts_.damps || !is_known(in)) return 0.0;
  const Blend blend = blend_at(in.surface_point, in.indentation_m);
  double b_Ns_per_m = parts_.curves[blend.low]->damping_Ns_per_m(in.indentation_m);
  if (parts_.curves.size() > 1)
    b_Ns_per_m += blend.fraction *
                  (parts_.curves[blend.low + 1]->damping_Ns_per_m(in.indentation_m) - b_Ns_per_m);
  return law::resistance_N(b_Ns_per_m, in.speed_mps, force_N, in.held);
}

// g between two rings is linear, within the first and beyond the last it stays.
double ElasticField::regular_m_per_N(const contact::SurfacePoint& surface_point,
                                     double distance_m) const RT_SAFE {
  const ElasticNeighbours& near = parts_.neighbours;
  if (near.rings == 0 || !is_on_surface(surface_point, parts_.surface)) return 0.0;
  const double last = static_cast<double>(near.rings - 1);
  const double at = std::clamp(distance_m / near.ring_pitch_m - 1.0, 0.0, last);
  const auto low = static_cast<std::size_t>(at), high = std::min(low + 1, near.rings - 1);
  const double f = at - static_cast<double>(low);
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t row = parts_.surface.triangle[surface_point.triangle][i] * near.rings;
    const double g_low = static_cast<double>(near.ring_times_E_per_m[row + low]);
    const double g_high = static_cast<double>(near.ring_times_E_per_m[row + high]);
    sum += surface_point.weight[i] * (g_low + f * (g_high - g_low));
  }
  return sum / near.youngs_modulus_Pa;
}

contact::ContactCoupling ElasticField::coupling(const contact::Indentation& a,
                                                const contact::Indentation& b,
                                                double distance_m) const RT_SAFE {
  const double modulus_Pa = parts_.neighbours.contact_modulus_Pa;
  if (!(modulus_Pa > 0.0) || !(distance_m > 0.0)) return {};
  // MC-2   h = 1 / (pi E* |c_i - c_j|) + min(S_ij, 0),   b = max(S_ij, 0)
  const double half_space_m_per_N = 1.0 / (std::numbers::pi * modulus_Pa * distance_m);
  const double map_m_per_N = 0.5 * (regular_m_per_N(a.surface_point, distance_m) +
                                    regular_m_per_N(b.surface_point, distance_m));
  return {.near_field_m_per_N =
              std::max(half_space_m_per_N + std::min(map_m_per_N, 0.0), 0.0),  // the map has errors
          .structural_m_per_N = std::max(map_m_per_N, 0.0)};
}

double ElasticField::relaxation_ratio() const RT_SAFE {
  double sum = 0.0;
  for (std::size_t i = 0; i < parts_.relaxation.terms(); ++i)
    sum += parts_.relaxation.share(i + 1) * parts_.relaxation.rate_per_tick(i);
  return sum;
}

double ElasticField::stiffest_N_per_m(const contact::SurfacePoint& surface_point,
                                      bool held) const RT_SAFE {
  if (parts_.curves.size() < 2) return stiffest_N_per_m_[0];
  if (!is_on_surface(surface_point, parts_.surface)) return 0.0;
  const auto at = [&](double depth_m) RT_SAFE {
    const Blend blend = blend_at(surface_point, depth_m);
    const double soft = stiffest_N_per_m_[blend.low];
    return soft + blend.fraction * (stiffest_N_per_m_[blend.low + 1] - soft);
  };
  // Any depth below 0 means pull, which has coordinates of its own.
  return held ? std::max(at(0.0), at(-1.0)) : at(0.0);
}

contact::TangentCompliance ElasticField::tangent_compliance(
    const contact::SurfacePoint& surface_point, bool held,
    const contact::Axes& axes) const RT_SAFE {
  const ElasticNeighbours& near = parts_.neighbours;
  if (!(near.contact_modulus_Pa > 0.0)) return {};
  const double nu = near.poisson_ratio;
  // MC-5   G_i = B / a_i I + S_i,   B = (2 - nu) / (4 E* (1 - nu))
  contact::TangentCompliance out{
      .contact_m2_per_N = (2.0 - nu) / (4.0 * (1.0 - nu) * near.contact_modulus_Pa),
      .rest_m_per_N = {}};
  if (near.tangent_times_E_per_m.empty() || !is_on_surface(surface_point, parts_.surface))
    return out;
  std::array<double, 6> s{};
  for (std::size_t i = 0; i < 3; ++i) {
    const TangentTensors& both =
        near.tangent_times_E_per_m[parts_.surface.triangle[surface_point.triangle][i]];
    const double weight_per_Pa = surface_point.weight[i] / near.youngs_modulus_Pa;
    for (std::size_t k = 0; k < s.size(); ++k)
      s[k] +=
          weight_per_Pa * static_cast<double>(held ? both.held_per_m[k] : both.contact_per_m[k]);
  }
  const Mat3 s_m_per_N{{Vec3{s[0], s[5], s[4]}, Vec3{s[5], s[1], s[3]}, Vec3{s[4], s[3], s[2]}}};
  const Vec3 &a = axes.unit[0], &b = axes.unit[1], s_a = s_m_per_N * a, s_b = s_m_per_N * b;
  out.rest_m_per_N = {.xx = dot(a, s_a), .xy = dot(a, s_b), .yy = dot(b, s_b)};
  return out;
}

std::size_t ElasticField::profile(const contact::Indentation& in,
                                  std::span<double> ring_m) const RT_SAFE {
  if (!is_known(in)) return 0;
  // The curves are springs without a shape (LW-4).
  if (parts_.indentation_shape != nullptr) {
    const std::size_t rings = parts_.indentation_shape->profile(in.indentation_m, ring_m);
    add_organ(in, ring_m.first(rings));
    return rings;
  }
  const Blend blend = blend_at(in.surface_point, in.indentation_m);
  const std::size_t count = parts_.curves[blend.low]->profile(in.indentation_m, ring_m);
  if (parts_.curves.size() < 2) return count;
  std::array<double, kMaxProfile> stiff_m{};
  parts_.curves[blend.low + 1]->profile(in.indentation_m, stiff_m);
  for (std::size_t j = 0; j < std::min({count, ring_m.size(), kMaxProfile}); ++j)
    ring_m[j] += blend.fraction * (stiff_m[j] - ring_m[j]);
  report_own_rings(in, ring_m.first(count));
  return count;
}

// CL-4 where the curve is the tip's alone: the organ's part is added, F r in the middle and F g_j
// at ring j.
void ElasticField::add_organ(const contact::Indentation& in,
                             std::span<double> ring_m) const RT_SAFE {
  const ElasticNeighbours& near = parts_.neighbours;
  if (near.regular_times_E_per_m.empty() || ring_m.empty()) return;
  const double force_N = parts_.curves[0]->respond(in.indentation_m).force_N;
  const contact::TriangleCorners& corner = parts_.surface.triangle[in.surface_point.triangle];
  double regular_m_per_N = 0.0;
  for (std::size_t i = 0; i < 3; ++i)
    regular_m_per_N += in.surface_point.weight[i] / near.youngs_modulus_Pa *
                       static_cast<double>(near.regular_times_E_per_m[corner[i]]);
  const double sign = in.indentation_m < 0.0 ? -1.0 : 1.0;
  ring_m[0] += force_N * regular_m_per_N;
  for (std::size_t j = 1; j < ring_m.size(); ++j) {
    const double more_m = force_N * this->regular_m_per_N(in.surface_point, static_cast<double>(j) *
                                                                                near.ring_pitch_m);
    const double u_m = ring_m[j] + law::ring_taper(j, near.rings) * more_m;
    ring_m[j] = sign * std::clamp(sign * u_m, 0.0, std::abs(ring_m[j - 1]));
  }
}

// CL-4 with the rings of this place: those of a curve are the mean of all places that give as much
// as it, rims and middles of lobes alike.
void ElasticField::report_own_rings(const contact::Indentation& in,
                                    std::span<double> ring_m) const RT_SAFE {
  const ElasticNeighbours& near = parts_.neighbours;
  if (parts_.curve_ring_times_E_per_m.empty() || near.rings == 0 || ring_m.empty()) return;
  const Blend blend = blend_at(in.surface_point, in.indentation_m);
  const double force_N = part_at(in.surface_point, in.indentation_m).law.force_N;
  const double sign = in.indentation_m < 0.0 ? -1.0 : 1.0;
  for (std::size_t j = 1; j < std::min(ring_m.size(), near.rings + 1); ++j) {
    const auto of_curve = [&](std::size_t k) RT_SAFE {
      return static_cast<double>(parts_.curve_ring_times_E_per_m[k * near.rings + j - 1]);
    };
    const double soft = of_curve(blend.low), stiff = of_curve(blend.low + 1);
    const double more_m_per_N =
        regular_m_per_N(in.surface_point, static_cast<double>(j) * near.ring_pitch_m) -
        (soft + blend.fraction * (stiff - soft)) / near.youngs_modulus_Pa;
    const double u_m = ring_m[j] + law::ring_taper(j, near.rings) * force_N * more_m_per_N;
    ring_m[j] = sign * std::clamp(sign * u_m, 0.0, std::abs(ring_m[j - 1]));
  }
}

Vec3 ElasticField::tilt(const contact::Indentation& in) const RT_SAFE {
  const ElasticNeighbours& near = parts_.neighbours;
  const bool bends = !near.vertex_compliance.empty();
  if ((near.tilt_times_E_per_m2.empty() && !bends) || !is_known(in)) return {};
  const double force_N = part_at(in.surface_point, in.indentation_m).law.force_N;
  const contact::TriangleCorners& corner = parts_.surface.triangle[in.surface_point.triangle];
  Vec3 sum;
  for (std::size_t i = 0; i < 3; ++i)
    sum += force_N / near.youngs_modulus_Pa * in.surface_point.weight[i] *
           (bends ? tilt_times_E_per_m2(near.vertex_compliance[corner[i]], in.normal)
                  : near.tilt_times_E_per_m2[corner[i]]);
  return sum;
}

}  // namespace tact::model::tissue
