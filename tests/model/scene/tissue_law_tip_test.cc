// SPDX-License-Identifier: Apache-2.0
// The elastic tip of a tissue law: how far it is pulled, and an organ of another law below it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "model/law/law_bounds.h"
#include "model/scene/tissue.h"
#include "model/scene/tissue_map.h"
#include "tests/model/scene/shipped_law.h"

namespace tact::model::scene::tissue_law_tip_test {

using shipped_law::kLinear;
using shipped_law::made;
using shipped_law::Overrides;
using shipped_law::refusal;
using shipped_law::shipped;

// The pull of a small tip is so soft that it would saturate below the force that tears.
TEST(TissueLawTip, ComplianceTearsInEveryShippedOrganThatBends) {
  for (const char* name : {"grasper", "heart", "liver", "liver_twist", "skin"}) {
    const Scene scene = shipped(name, {"law=compliance"});
    const auto tissue = make_tissue(scene);
    ASSERT_TRUE(tissue) << tissue.error().message;
    const auto law = made(scene);
    const law::Law& tip = *law->curve();
    const double pull_m = law::tear_depth_m(tip, scene.contact.tear_force_N);
    EXPECT_GT(pull_m, tip.range().pull_m) << name;
    EXPECT_NEAR(-tip.respond(pull_m).force_N, scene.contact.tear_force_N, 1e-6) << name;
  }
}

// Any law may be the organ below the tip: a linear stack as soft as a place is that place.
TEST(TissueLawTip, AnExactTipIsInSeriesWithTheOrgan) {
  const Overrides tip{"exact_tip=true", "varies_by_place=false", kLinear};
  const auto family = read_scene_family(shipped("liver", {kLinear}));
  const indent::ComplianceCurve& place = family->curve.at(9);
  ASSERT_GT(place.regular_m_per_N(), 0.0);
  const double own_N_per_m = made(shipped("liver", {"varies_by_place=false"}), "disc_stack")
                                 ->curve()
                                 ->respond(1e-3)
                                 .stiffness_N_per_m;
  Overrides soft = tip;
  soft.push_back(fmt::format("disc_stack.youngs_modulus_Pa={:.17g}",
                             11005.0 / place.regular_m_per_N() / own_N_per_m));
  const auto law = made(shipped("liver", soft), "disc_stack");
  for (const double depth_m : {0.0005, 0.001, 0.003, 0.006})
    EXPECT_NEAR(law->curve()->respond(depth_m).force_N / place.respond(depth_m).force_N, 1.0, 2e-3)
        << depth_m;
  EXPECT_NE(law->title().find("under an exact tip"), std::string::npos) << law->title();
  for (const char* kind : {"compliance", "spring_patch"})
    EXPECT_NE(refusal(shipped("liver", tip), kind).find("leave exact_tip out"), std::string::npos);
  Overrides measured = tip;
  measured.emplace_back("table.data=\"press.csv\"");
  EXPECT_NE(refusal(shipped("liver", measured), "table").find("has its tip"), std::string::npos);
}

// The pad of skin is 30 mm of tissue on a support: far from its sides a closed form gives what
// finite elements gave.
TEST(TissueLawTip, AWideLayerNeedsNoMap) {
  const Scene map = shipped("skin", {kLinear}),
              layer = shipped(
                  "skin", {kLinear, "compliance.map=\"\"", "compliance.layer_thickness_m=0.0298"});
  EXPECT_TRUE(layer.varies_by_place);
  const contact::SurfaceView surface = map.organ_mesh.view();
  for (const char* kind : {"compliance", "rhombus"}) {
    const auto by_map = made(map, kind), closed = made(layer, kind);
    std::size_t seen = 0;
    for (std::uint32_t t = 0; t < surface.triangle.size(); ++t) {
      const Vec3 corner_m = surface.vertex_m[surface.triangle[t][0]];
      const bool is_inside = std::abs(corner_m.x) < 0.015 && std::abs(corner_m.y) < 0.03;
      if (!is_inside || corner_m.z < -0.001 || ++seen > 20) continue;
      for (const double depth_m : {0.001, 0.004, 0.006}) {
        const contact::Indentation in{.surface_point = {t, {1, 0, 0}}, .indentation_m = depth_m};
        const auto force_N = [&](TissueLaw& law) {
          return law.contact_law().respond(in).law.force_N;
        };
        EXPECT_NEAR(force_N(*closed) / force_N(*by_map), 1.0, 0.03) << kind << " at " << t;
      }
    }
    EXPECT_GT(seen, 10U);
  }
}

TEST(TissueLawTip, ANetOfSpringsOnALayerHasTheForceOfTheLayer) {
  const Scene layer =
      shipped("liver", {kLinear, "compliance.map=\"\"", "compliance.layer_thickness_m=0.03"});
  const auto net = made(layer, "spring_patch"), organ = made(layer, "compliance");
  const contact::Indentation in{.surface_point = {7, {1, 0, 0}}, .indentation_m = 0.003};
  const double force_N = net->contact_law().respond(in).law.force_N;
  EXPECT_GT(force_N, 0.01);
  EXPECT_EQ(force_N, organ->contact_law().respond(in).law.force_N);
}

TEST(TissueLawTip, EitherAMapOrALayerIsWritten) {
  for (const char* set : {"compliance.layer_thickness_m=0.03", "compliance.map=\"\""}) {
    const auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {set});
    ASSERT_FALSE(scene) << set;
    EXPECT_NE(scene.error().message.find("one of both"), std::string::npos);
  }
}

}  // namespace tact::model::scene::tissue_law_tip_test
