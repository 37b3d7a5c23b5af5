// SPDX-License-Identifier: Apache-2.0
// The shipped forceps in the shipped liver: both jaws press one tissue.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/scene/scene.h"
#include "model/scene/scene_strokes.h"
#include "model/scene/tissue.h"
#include "tests/support/message.h"

namespace tact::model::scene::whole_tool_test {

nlohmann::json reference(const char* name) {
  std::ifstream file(TACT_SOURCE_DIR "/tests/data/reference/" + std::string(name));
  return nlohmann::json::parse(file);
}

Vec3 vec3(const nlohmann::json& v) { return {v[0], v[1], v[2]}; }

class WholeTool : public ::testing::Test {
 protected:
  WholeTool() { use("law=\"compliance\""); }

  /// As the references are: linear, without friction.
  void use(const char* law) {
    auto loaded = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml",
                             {law, "compliance.large_strain=false", "contact.friction_ratio=0"});
    EXPECT_EQ(tests::message_of(loaded), "");
    scene_ = std::move(*loaded);
    auto tissue = make_tissue(scene_);
    EXPECT_EQ(tests::message_of(tissue), "");
    tissue_ = std::move(*tissue);
  }

  /// The tool comes down until its lowest points are `to_m` below z = 0 of W, its grip as said.
  static Wrench render_force(contact::Contact& contact, double from_m, double to_m,
                             double grip_ratio) {
    Wrench w;
    for (int i = 0; i <= 200; ++i) {
      const Tool tool{.position_m = {0, 0, -(from_m + (to_m - from_m) * i / 200.0)},
                      .grip_ratio = grip_ratio};
      contact.detect_contact(tool);
      w = contact.render_force(tool, false).wrench;
    }
    return w;
  }
  double pressed_N(double depth_m) {
    contact::Contact contact(tissue_->contact_scene());
    return render_force(contact, -0.010, depth_m, 0.0).force_N.z;
  }
  /// Against the finite or boundary elements of two_jaws_liver.json.
  void expect_pressed_within(double ratio) {
    const nlohmann::json jaws = reference("two_jaws_liver.json");
    for (const char* solver : {"fe", "boundary_elements"}) {
      const nlohmann::json& truth = jaws[solver];
      for (std::size_t i = 0; i < truth["depth_m"].size(); ++i) {
        const double want_N = truth["pair_N"][i];
        EXPECT_NEAR(pressed_N(truth["depth_m"][i]), want_N, ratio * want_N)
            << solver << ", " << truth["depth_m"][i] << " m";
      }
    }
  }
  /// Against the way, at a place of liver_tool.json: down to each depth, 20 um a tick.
  std::vector<double> rendered_down_the_way_N(const nlohmann::json& place) {
    contact::Contact contact(tissue_->contact_scene());
    const Vec3 along = vec3(place["direction"]), at_m = vec3(place["point_m"]);
    const auto& q = place["orientation_wxyz"];
    const double reach = reach_m(scene_.tool.spheres, scene_.hand_inward);
    std::vector<double> out;
    double at_depth_m = -0.003;
    for (const auto& one : place["cases"]) {
      double rendered_N = 0.0;
      for (const double to_m = one["depth_m"]; at_depth_m < to_m;) {
        at_depth_m = std::min(at_depth_m + 2e-5, to_m);
        const Tool tool{.position_m = at_m + scene_.organ.position_m - (reach - at_depth_m) * along,
                        .orientation = {q[0], q[1], q[2], q[3]}};
        contact.detect_contact(tool);
        rendered_N = -dot(contact.render_force(tool, false).wrench.force_N, along);
      }
      out.push_back(rendered_N);
    }
    return out;
  }
  /// Pull stiffness of the jaws that are there.
  double pulled_N_per_m(std::span<const contact::ProbeSphere> jaws) {
    contact::ContactScene scene = tissue_->contact_scene();
    scene.spheres = jaws;
    contact::Contact contact(scene);
    render_force(contact, -0.010, 0.001, 0.0);
    const double near_N = render_force(contact, 0.001, -0.002, 1.0).force_N.z;
    const double far_N = render_force(contact, -0.002, -0.004, 1.0).force_N.z;
    return (near_N - far_N) / 0.002;
  }

  /// How far the held jaws are dragged until they tear.
  double torn_after_m(const Vec3& along) {
    contact::Contact contact(tissue_->contact_scene());
    render_force(contact, -0.010, 0.003, 0.0);
    for (double way_m = 0.0;; way_m += 2e-5) {
      const Tool tool{.position_m = Vec3{0, 0, -0.003} + way_m * along, .grip_ratio = 1.0};
      contact.detect_contact(tool);
      contact.render_force(tool, false);
      if (contact.contacts()[0].state != ContactState::kHeld || way_m > 0.1) return way_m;
    }
  }

  Scene scene_;
  std::unique_ptr<Tissue> tissue_;
};

TEST_F(WholeTool, PressesTheLiverAsFiniteElementsDo) { expect_pressed_within(0.03); }

TEST_F(WholeTool, PressesTheLiverByItsChainsWithinATenth) {
  use("law=\"rhombus\"");
  expect_pressed_within(0.10);
}

// Two of the 36 miss the goal of 7 %, both at rims: known errors, which shall not grow.
TEST_F(WholeTool, PressesEveryPlaceOfTheReferenceAsFiniteElementsDo) {
  const nlohmann::json truth = reference("liver_tool.json");
  ASSERT_EQ(truth["places"].size(), 9U);
  for (const nlohmann::json& place : truth["places"]) {
    const std::vector<double> rendered_N = rendered_down_the_way_N(place);
    ASSERT_EQ(rendered_N.size(), 4U);
    for (std::size_t i = 0; i < rendered_N.size(); ++i) {
      const auto& one = place["cases"][i];
      const double want_N = one["force_N"], depth_m = one["depth_m"];
      const bool is_known_error = (place["vertex"] == 2482 && depth_m == 0.001) ||
                                  (place["vertex"] == 1586 && depth_m == 0.010);
      const double ratio = is_known_error ? 0.09 : 0.07;
      EXPECT_NEAR(rendered_N[i], want_N, ratio * want_N)
          << place["vertex"] << ", " << depth_m << " m";
    }
  }
}

TEST_F(WholeTool, HeldJawsTearAfterTwoCentimetresSideways) {
  // 0.4 N a jaw; with 100 N/m it was 4 mm. One stiffness for all directions gave 21 mm.
  EXPECT_NEAR(torn_after_m({0, 1, 0}), 0.0166, 0.002);
  EXPECT_NEAR(torn_after_m({1, 0, 0}), 0.0188, 0.002);
}

TEST_F(WholeTool, HeldJawsPullLessThanTheSumOfEach) {
  const nlohmann::json truth = reference("two_jaws_liver.json")["gripped_pull"];
  const std::span<const contact::ProbeSphere> jaws = scene_.tool.spheres;
  const double pair = pulled_N_per_m(jaws);
  const double sum = pulled_N_per_m(jaws.first(1)) + pulled_N_per_m(jaws.last(1));
  EXPECT_NEAR(pair / sum, truth["ratio"], 0.03);
  EXPECT_NEAR(pair, truth["pair_N_per_m"], 0.06 * double(truth["pair_N_per_m"]));
}

}  // namespace tact::model::scene::whole_tool_test
