// SPDX-License-Identifier: Apache-2.0
// contact_bench.h - one sphere on a soft plate, and how a tool is moved over it.
#pragma once

#include <utility>
#include <vector>

#include "model/contact/contact.h"
#include "model/indent/rhombus_chain.h"
#include "model/law/tabulated_law.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::contact_bench {

inline constexpr double kRadius_m = 4_mm;

inline indent::RhombusChain soft_chain() {
  return *indent::make_rhombus_chain({.rod_length_m = 5_mm,
                                      .initial_angle_rad = 30_deg,
                                      .normal_stiffness_N_per_m = 150.0,
                                      .tangential_stiffness_N_per_m = 180.0,
                                      .growth = 2.0,
                                      .units = 10});
}

// A soft surface with everything that a Contact borrows.
struct Bench {
  explicit Bench(mesh::SurfaceMesh m, std::vector<ProbeSphere> s = {{{}, kRadius_m}})
      : mesh(std::move(m)), tree(make_triangle_tree(mesh.view())), spheres(std::move(s)) {}

  Contact contact() {
    return Contact({.law = &field,
                    .parameters = parameters,
                    .spheres = spheres,
                    .surface = mesh.view(),
                    .tree = tree.view(),
                    .blade = {}});
  }

  indent::RhombusChain chain = soft_chain();
  law::TabulatedLaw law = *tabulate(chain, 65);
  const law::Law* curve = &law;
  tissue::ElasticField field{{.curves = {&curve, 1},
                              .coordinate = {},
                              .pull_coordinate = {},
                              .surface = {},
                              .relaxation = {}}};
  mesh::SurfaceMesh mesh;
  TriangleTree tree;
  std::vector<ProbeSphere> spheres;
  ContactParameters parameters{
      .friction_ratio = 0.4, .sliding_stiffness_N_per_m = 100.0, .tear_force_N = 0.6};
};

inline Bench plate_bench() { return Bench(tests::make_plate(100_mm, 20)); }

// Moves the tool and returns the force there.
inline Wrench render_at(Contact& contact, const Vec3& position_m, double grip_ratio = 0.0) {
  const Tool tool{.position_m = position_m, .grip_ratio = grip_ratio};
  contact.detect_contact(tool);
  return contact.render_force(tool, true).wrench;
}

inline void glide(Contact& contact, const Vec3& from_m, const Vec3& to_m, double grip_ratio = 0.0) {
  for (int i = 0; i <= 200; ++i)
    render_at(contact, from_m + (i / 200.0) * (to_m - from_m), grip_ratio);
}

}  // namespace tact::model::contact::contact_bench
