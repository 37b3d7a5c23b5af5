// SPDX-License-Identifier: Apache-2.0
// The published cases of several spheres that press one half-space.
#include <algorithm>

#include "model/contact/coupling.h"
#include "model/indent/compliance_law.h"
#include "model/tissue/elastic_field.h"
#include "tools/verify/report.h"

namespace tact::tools::verify {
namespace spheres_cases {

using model::Vec3;
using model::contact::PressingSphere;
using nlohmann::json;

/// MC-2 between any two. What a sphere does to itself is in its own curve.
model::contact::Coupling coupling_of(const model::tissue::ElasticField& tissue,
                                     std::span<const PressingSphere> sphere,
                                     std::span<const Vec3> at_m) {
  model::contact::Coupling c{};
  for (std::size_t i = 0; i < sphere.size(); ++i)
    for (std::size_t j = 0; j < sphere.size(); ++j)
      if (i != j)
        c[i][j] =
            tissue.coupling(sphere[i].in, sphere[j].in, norm(at_m[i] - at_m[j])).near_field_m_per_N;
  return c;
}

json group_results(const json& one_case) {
  const json &p = one_case.at("params"), &inputs = one_case.at("inputs");
  const model::indent::ElasticTip tip{.youngs_modulus_Pa = number(p.at("youngs_modulus_Pa")),
                                      .poisson_ratio = number(p.at("poisson_ratio")),
                                      .radius_m = number(p.at("radius_m"))};
  double deepest_m = 0.0;
  for (const json& d : inputs.at("depth_m")) deepest_m = std::max(deepest_m, number(d));
  // A half-space and nothing else: no compliance of the organ's own, no ring.
  constexpr std::array<double, 1> kFlat{};
  const auto curve = model::indent::make_compliance_curve({.tip = tip,
                                                           // Beyond it the force would stay.
                                                           .working_depth_m = deepest_m,
                                                           .ring_pitch_m = tip.radius_m,
                                                           .ring_m_per_N = kFlat,
                                                           .table_knots = 257});
  const model::law::Law* law = &*curve;
  model::tissue::ElasticField tissue(
      {.curves = {&law, 1},
       .coordinate = {},
       .pull_coordinate = {},
       .surface = {},
       .relaxation = {},
       .neighbours = {.contact_modulus_Pa = tip.contact_modulus_Pa()}});
  const std::size_t n = inputs.at("depth_m").size();
  if (!curve || n > model::contact::kMaxSpheres) return {};  // main.cc names the damaged case
  std::array<PressingSphere, model::contact::kMaxSpheres> sphere{};
  std::array<Vec3, model::contact::kMaxSpheres> at_m{};
  for (std::size_t i = 0; i < n; ++i) {
    const double depth_m = number(inputs.at("depth_m").at(i));
    at_m[i] = {number(inputs.at("x_m").at(i)), number(inputs.at("y_m").at(i)), 0.0};
    sphere[i] = {.presses = true,
                 .depth_m = depth_m,
                 .in = {.sphere = i, .normal = {0, 0, 1}, .indentation_m = depth_m},
                 .response = {}};
  }
  auto c = coupling_of(tissue, {sphere.data(), n}, at_m);
  // MC-1: e_i = d_i - sum over j != i of C_ij F_j.
  press_together(tissue, c, {sphere.data(), n});
  json force_N = json::array();
  for (std::size_t i = 0; i < n; ++i) force_N.push_back(sphere[i].response.law.force_N);
  return {{"force_N", force_N}};
}

constexpr Verifier kVerifiers[] = {{"half_space_spheres", verify_cases<group_results>}};

}  // namespace spheres_cases

std::span<const Verifier> sphere_verifiers() { return spheres_cases::kVerifiers; }

}  // namespace tact::tools::verify
