// SPDX-License-Identifier: Apache-2.0
// How stiff the liver is along its surface, by its law and by finite elements.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "model/contact/contact.h"
#include "model/contact/contact_law.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "tests/support/message.h"

namespace tact::model::scene::sideways_test {

const std::vector<std::string> kAtRest{"compliance.large_strain=false"};

contact::SurfacePoint place_of(const mesh::SurfaceMesh& mesh, std::uint32_t vertex) {
  for (std::uint32_t t = 0; t < mesh.triangle.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i)
      if (mesh.triangle[t][i] == vertex) {
        contact::SurfacePoint place{.triangle = t, .weight = {}};
        place.weight[i] = 1.0;
        return place;
      }
  ADD_FAILURE() << "no vertex " << vertex;
  return {};
}

// Of a surface at rest, small strain. Three places, two directions each, touching and held.
TEST(Sideways, StiffnessMatchesFiniteElementsBothWaysWithin15Percent) {
  std::ifstream file(TACT_SOURCE_DIR "/tests/data/reference/liver_sideways.json");
  const auto reference = nlohmann::json::parse(file);
  const auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", kAtRest);
  ASSERT_EQ(tests::message_of(scene), "");
  const auto tissue = make_tissue(*scene);
  ASSERT_EQ(tests::message_of(tissue), "");
  ASSERT_EQ(reference.at("cases").size(), 18U);
  double worst = 0.0;
  for (const auto& one : reference.at("cases")) {
    const std::uint32_t vertex = one.at("vertex");
    const std::array<double, 3> v = one.at("along");
    const contact::Axes axes = contact::axes_of(scene->organ_mesh.vertex_normal[vertex],
                                                {{Vec3{v[0], v[1], v[2]}, Vec3{}}});
    const contact::Tensor2 compliance_m_per_N =
        (*tissue)
            ->law()
            .contact_law()
            .tangent_compliance(place_of(scene->organ_mesh, vertex), one.at("held"), axes)
            .at(one.at("contact_radius_m"));
    const double ratio = 1.0 / compliance_m_per_N.xx / one.at("stiffness_N_per_m").get<double>();
    EXPECT_NEAR(ratio, 1.0, 0.15) << one;
    worst = std::max(worst, std::abs(ratio - 1.0));
  }
  RecordProperty("worst", std::to_string(worst));
}

std::uint32_t vertex_near(const mesh::SurfaceMesh& mesh, const Vec3& p_m) {
  const auto nearest = std::ranges::min_element(
      mesh.vertex_m, {}, [&p_m](const Vec3& vertex_m) { return norm(vertex_m - p_m); });
  return static_cast<std::uint32_t>(nearest - mesh.vertex_m.begin());
}

// No shipped scene sets it by hand: a disc of the tip's radius on a half-space of [elastic],
// 8 G R / (2 - nu), in series with the compliance of the place along the surface.
TEST(Sideways, AtRestEveryShippedSceneTakesItsStiffnessFromItsTissue) {
  struct Want {
    const char* scene;
    double held_N_per_m;
  };
  for (const Want& want :
       {Want{"heart", 84.9}, {"skin", 22.0}, {"gum", 52.8}, {"maintenance", 19.5}}) {
    const auto scene =
        load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(want.scene) + ".toml", kAtRest);
    ASSERT_EQ(tests::message_of(scene), "");
    EXPECT_EQ(scene->contact.sliding_stiffness_N_per_m, 0.0) << want.scene;
    const auto tissue = make_tissue(*scene);
    ASSERT_EQ(tests::message_of(tissue), "");
    const std::uint32_t vertex = vertex_near(scene->organ_mesh, scene->hand_site_m);
    const double compliance_m_per_N =
        (*tissue)
            ->law()
            .contact_law()
            .tangent_compliance(place_of(scene->organ_mesh, vertex), true,
                                contact::axes_of(scene->organ_mesh.vertex_normal[vertex]))
            .at(scene->tool.spheres[0].radius_m)
            .xx;
    EXPECT_NEAR(1.0 / compliance_m_per_N, want.held_N_per_m, 0.5) << want.scene;
  }
}

// Friction and a hold need a spring along the surface, and a scene need not give its stiffness.
TEST(Sideways, ASpringPatchHasAStiffnessOfItsOwn) {
  const auto scene =
      load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {"law=\"spring_patch\""});
  ASSERT_EQ(tests::message_of(scene), "");
  const auto tissue = make_tissue(*scene);
  ASSERT_EQ(tests::message_of(tissue), "");
  contact::Contact contact((*tissue)->contact_scene());
  const auto dragged_N = [&](double grip_ratio) {
    contact.reset();
    Wrench w;
    for (int i = 0; i <= 600; ++i) {  // down by 3 mm, then 6 mm along y
      const Tool tool{
          .position_m = {0, 0.02e-3 * std::max(i - 300, 0), 1e-3 - 0.0133e-3 * std::min(i, 300)},
          .grip_ratio = i < 300 ? 0.0 : grip_ratio};
      contact.detect_contact(tool);
      w = contact.render_force(tool, false).wrench;
    }
    return -w.force_N.y;
  };
  const double touching_N = dragged_N(0.0), held_N = dragged_N(1.0);
  EXPECT_GT(touching_N, 0.0);
  EXPECT_GT(held_N, touching_N);
  RecordProperty("dragged", std::to_string(touching_N) + " " + std::to_string(held_N));
}

}  // namespace tact::model::scene::sideways_test
