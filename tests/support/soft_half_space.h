// SPDX-License-Identifier: Apache-2.0
// soft_half_space.h - a flat half-space of E = 5 kPa, nu = 0.45 below balls of 4 mm, through the
// field that scenes use.
#pragma once

#include <vector>

#include "model/indent/compliance_law.h"
#include "model/tissue/elastic_field.h"

namespace tact::tests {

struct SoftHalfSpace {
  model::indent::ElasticTip tip{
      .youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = 0.004};
  std::vector<double> flat{0.0};
  model::indent::ComplianceCurve curve =
      *model::indent::make_compliance_curve({.tip = tip,
                                             .working_depth_m = 0.012,
                                             .ring_pitch_m = 0.002,
                                             .ring_m_per_N = flat,
                                             .table_knots = 257});
  const model::law::Law* law = &curve;
  model::tissue::ElasticField field{
      {.curves = {&law, 1},
       .coordinate = {},
       .pull_coordinate = {},
       .surface = {},
       .relaxation = {},
       .neighbours = {.contact_modulus_Pa = tip.contact_modulus_Pa(), .poisson_ratio = 0.45}}};
};

}  // namespace tact::tests
