// SPDX-License-Identifier: Apache-2.0
// Letting go of tissue that remembers: neither the grip nor a tear gives energy back.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/contact/contact.h"
#include "model/indent/rhombus_chain.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/model/contact/contact_bench.h"
#include "tests/support/shapes.h"

namespace tact::model::contact::contact_memory_test {

using contact_bench::kRadius_m;

struct RelaxingBench {
  Contact contact() {
    return Contact({.law = &field,
                    .parameters = parameters,
                    .spheres = {&sphere, 1},
                    .surface = mesh.view(),
                    .tree = tree.view(),
                    .blade = {}});
  }
  indent::RhombusChain chain = contact_bench::soft_chain();
  const law::Law* curve = &chain;
  mesh::SurfaceMesh mesh = tests::make_plate(100_mm, 20);
  TriangleTree tree = make_triangle_tree(mesh.view());
  ProbeSphere sphere{{}, kRadius_m};
  std::vector<law::PronyTerm> terms{{.share = 0.3, .time_s = 0.2}, {.share = 0.4, .time_s = 2.0}};
  tissue::ElasticField field{{.curves = {&curve, 1},
                              .coordinate = {},
                              .pull_coordinate = {},
                              .surface = {},
                              .relaxation = *make_relaxation(terms, 0.001)}};
  ContactParameters parameters{
      .friction_ratio = 0.4, .sliding_stiffness_N_per_m = 100.0, .tear_force_N = 10.0};
};

struct Rendered {
  double energy_J = 0.0, force_N = 0.0;
};

Rendered render_force(Contact& contact, const Vec3& at_m, double grip_ratio, int ticks = 1) {
  Wrench w;
  for (int i = 0; i < ticks; ++i) {
    const Tool tool{.position_m = at_m, .grip_ratio = grip_ratio};
    contact.detect_contact(tool);
    w = contact.render_force(tool, false).wrench;
  }
  return {contact.contacts()[0].energy_J, w.force_N.z};
}

/// Presses to a depth, closes the grip there and stays.
Rendered press_and_hold(Contact& contact, double depth_m, int ticks) {
  for (int i = 0; i <= 100; ++i)
    render_force(contact, {0, 0, kRadius_m - depth_m * i / 100.0}, 0.0);
  return render_force(contact, {0, 0, kRadius_m - depth_m}, 1.0, ticks);
}

class Spring final : public law::Law {
 public:
  explicit Spring(double k_N_per_m) : k_(k_N_per_m) {}
  law::LawResponse respond(double d) const RT_SAFE override {
    return {k_ * d, k_, 0.5 * k_ * d * d, law::LawStatus::kOk};
  }
  law::LawRange range() const RT_SAFE override { return {-0.02, 0.02}; }
  std::size_t profile(double, std::span<double>) const RT_SAFE override { return 0; }
  double ring_pitch_m() const RT_SAFE override { return 1e-3; }

 private:
  double k_;
};

TEST(ContactMemory, OpeningTheGripInRelaxedTissueNeverAddsEnergy) {
  RelaxingBench bench;
  Contact contact = bench.contact();
  const Vec3 deep_m{0, 0, kRadius_m - 5_mm};
  const Rendered fresh = press_and_hold(contact, 5_mm, 1);
  const Rendered relaxed = render_force(contact, deep_m, 1.0, 5000);
  EXPECT_LT(relaxed.force_N, 0.6 * fresh.force_N) << "it did relax";
  const Rendered open = render_force(contact, deep_m, 0.0);
  EXPECT_EQ(contact.contacts()[0].state, ContactState::kInContact);
  EXPECT_LE(open.energy_J, relaxed.energy_J + 1e-15);
  EXPECT_NEAR(open.force_N, relaxed.force_N, 1e-3 * relaxed.force_N);
}

TEST(ContactMemory, ASidewaysTearInRelaxedTissueNeverAddsEnergy) {
  RelaxingBench bench;
  bench.parameters.tear_force_N = 0.6;
  Contact contact = bench.contact();
  Rendered before = press_and_hold(contact, 5_mm, 5000);
  for (double x_m = 0.0; contact.contacts()[0].state == ContactState::kHeld; x_m += 0.05_mm) {
    ASSERT_LT(x_m, 10_mm);
    const Rendered now = render_force(contact, {x_m, 0, kRadius_m - 5_mm}, 1.0);
    if (contact.contacts()[0].state != ContactState::kHeld) {
      EXPECT_LE(now.energy_J, before.energy_J);
      EXPECT_NEAR(now.force_N, before.force_N, 1e-3 * before.force_N);
    }
    before = now;
  }
}

TEST(ContactMemory, LettingGoWhileATermIsPulledDropsThatTerm) {
  // Relaxed at 5 mm and drawn back to 1 mm: what relaxed pulls now, and free tissue cannot.
  RelaxingBench bench;
  Contact contact = bench.contact();
  press_and_hold(contact, 5_mm, 20000);
  const Rendered held = render_force(contact, {0, 0, kRadius_m - 1_mm}, 1.0);
  EXPECT_LT(held.force_N, 0.0);
  const Rendered open = render_force(contact, {0, 0, kRadius_m - 1_mm}, 0.0);
  EXPECT_LE(open.energy_J, held.energy_J);
  EXPECT_GT(open.force_N, 0.0);
  EXPECT_LT(open.force_N, bench.chain.respond(1_mm).force_N);
}

TEST(ContactMemory, LettingGoOverStifferTissueNeverAddsEnergy) {
  const Spring soft(50.0), stiff(200.0);
  const std::array<const law::Law*, 2> curves{&soft, &stiff};
  for (const bool relaxes : {false, true}) {
    RelaxingBench bench;
    bench.parameters.sliding_stiffness_N_per_m = 10.0;
    std::vector<float> coordinate;  // stiffer by 3 N/m a millimetre, along x
    for (const Vec3& v : bench.mesh.vertex_m)
      coordinate.push_back(std::clamp(0.02F * static_cast<float>(v.x / 1_mm), 0.0F, 1.0F));
    bench.field = tissue::ElasticField(
        {.curves = curves,
         .coordinate = coordinate,
         .pull_coordinate = {},
         .surface = bench.mesh.view(),
         .relaxation = relaxes ? *make_relaxation(bench.terms, 0.001) : law::Relaxation()});
    Contact contact = bench.contact();
    press_and_hold(contact, 5_mm, 500);
    const Vec3 aside_m{30_mm, 0, kRadius_m - 5_mm};
    render_force(contact, aside_m, 1.0);
    const double shift_J = 0.5 * 10.0 * 30_mm * 30_mm;
    const Rendered held = render_force(contact, aside_m, 1.0, 500);
    const Rendered open = render_force(contact, aside_m, 0.0);
    EXPECT_EQ(contact.contacts()[0].state, ContactState::kInContact);
    EXPECT_LE(open.energy_J, held.energy_J - shift_J + 1e-12);
    EXPECT_GT(open.energy_J, 0.98 * (held.energy_J - shift_J)) << "nor takes what it need not";
    EXPECT_GT(contact.contacts()[0].depth_offset_m, 1_mm);
    // what was taken up is paid back only by withdrawing
    EXPECT_LE(render_force(contact, aside_m, 0.0, 10).energy_J, open.energy_J + 1e-12);
  }
}

TEST(ContactMemory, LettingGoOfAPullForgets) {
  RelaxingBench bench;
  Contact contact = bench.contact();
  press_and_hold(contact, 1_mm, 1);
  render_force(contact, {0, 0, kRadius_m + 3_mm}, 1.0, 3000);
  render_force(contact, {0, 0, kRadius_m + 3_mm}, 0.0);
  const Rendered again = render_force(contact, {0, 0, kRadius_m - 2_mm}, 0.0);
  EXPECT_NEAR(again.force_N, bench.chain.respond(2_mm).force_N, 2e-3 * again.force_N);
}

}  // namespace tact::model::contact::contact_memory_test
