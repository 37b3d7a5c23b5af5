// SPDX-License-Identifier: Apache-2.0
// Held tissue of an organ that bends, dragged anywhere and let go.
#include <gtest/gtest.h>

#include <random>

#include "tests/model/scene/moved_liver.h"

namespace tact::model::scene::moved_release_test {

using namespace moved_liver;

/// Presses with closed jaws at random places, drags what it holds up to 12 mm anywhere.
class RandomDrag {
 public:
  explicit RandomDrag(std::uint32_t seed)
      : random_(seed), scene_(liver().tissue->contact_scene()), contact_(unbreakable(scene_)) {}

  void press_and_drag() {
    const std::size_t vertices = liver().scene.organ_mesh.vertex_m.size();
    const Press press = press_at_vertex(random_() % vertices, between(0, 180));
    contact_ = contact::Contact(unbreakable(scene_));
    tool_ = press.at(-kBefore_m);
    go_to(press.at(between(1_mm, 10_mm)).position_m, 0.0);
    go_to(tool_.position_m, 1.0);
    go_to(tool_.position_m + between(0, 12_mm) * direction(), 1.0);
    go_to(tool_.position_m, 1.0);
  }
  /// The jaws open where they are.
  void let_go() { go_to(tool_.position_m, 0.0); }
  bool holds() const {
    return std::ranges::any_of(contact_.contacts(),
                               [](const contact::SphereContact& sphere_contact) {
                                 return sphere_contact.state == ContactState::kHeld;
                               });
  }
  double stored_J() const { return stored_energy_J(contact_.moved().organ()); }

 private:
  static contact::ContactScene unbreakable(contact::ContactScene scene) {
    scene.parameters.tear_force_N = 1e3;
    return scene;
  }
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 direction() { return normalized(Vec3{between(-1, 1), between(-1, 1), between(-1, 1)}); }
  void go_to(const Vec3& to_m, double grip_ratio) {
    const Vec3 from_m = tool_.position_m;
    const int ticks = std::max(1, static_cast<int>(norm(to_m - from_m) / 0.05_mm));
    tool_.grip_ratio = grip_ratio;
    for (int i = 1; i <= ticks; ++i) {
      tool_.position_m = from_m + static_cast<double>(i) / ticks * (to_m - from_m);
      contact_.detect_contact(tool_);
      contact_.render_force(tool_, false);
    }
  }

  std::mt19937 random_;
  contact::ContactScene scene_;
  contact::Contact contact_;
  Tool tool_;
};

TEST(MovedRelease, StoresNoMoreThanWasHeld) {
  RandomDrag drag(1);
  int releases = 0;
  for (int i = 0; i < 2000; ++i) {
    drag.press_and_drag();
    if (!drag.holds()) continue;
    ++releases;
    const double held_J = drag.stored_J();
    drag.let_go();
    EXPECT_LE(drag.stored_J(), held_J * (1.0 + 1e-6) + 1e-12) << "drag " << i;
  }
  EXPECT_GT(releases, 1500);
}

}  // namespace tact::model::scene::moved_release_test
