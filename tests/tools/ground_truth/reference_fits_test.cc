// SPDX-License-Identifier: Apache-2.0
#include "tools/ground_truth/reference_fits.h"

#include <gtest/gtest.h>

#include "tests/support/test_scene.h"

namespace tact::tools::ground_truth::reference_fits_test {

class ReferenceFits : public testing::Test {
 protected:
  ReferenceFits() {
    scene_.organ.position_m = {0.0, 0.0, 0.01};
    scene_.elastic = model::scene::ElasticSettings{.youngs_modulus_Pa = 5000.0,
                                                   .poisson_ratio = 0.45,
                                                   .fixed_min_m = {-1, -1, -1},
                                                   .fixed_max_m = {1, 1, -0.03}};
    reference_.body.youngs_modulus_Pa = 5000.0;
    reference_.body.poisson_ratio = 0.45;
    reference_.body.fixed_min_m = scene_.elastic->fixed_min_m;
    reference_.body.fixed_max_m = scene_.elastic->fixed_max_m;
    reference_.tool_radius_m = scene_.tool.spheres[0].radius_m;
    reference_.sites = {{.vertex = 3,
                         .point_m = scene_.organ_mesh.vertex_m[3] - scene_.organ.position_m,
                         .direction = {0, 0, -1},
                         .cases = {}}};
  }
  std::string said(ModulusOf modulus = ModulusOf::kSame) const {
    const auto error = check_reference_fits(reference_, scene_, modulus);
    return error ? error->message : "";
  }
  void expect(const std::string& words) const {
    EXPECT_NE(said().find(words), std::string::npos) << said();
    EXPECT_NE(said().find("--out FILE"), std::string::npos) << "the remedy";
  }

  model::scene::Scene scene_ = tests::make_plate_scene();
  ReferenceData reference_;
};

TEST_F(ReferenceFits, SceneOfTheReferenceIsAccepted) { EXPECT_EQ(said(), ""); }

TEST_F(ReferenceFits, AnotherTipIsRefused) {
  reference_.tool_radius_m *= 1.01;
  expect("radius");
}

TEST_F(ReferenceFits, AnotherOrganIsRefused) {
  reference_.sites[0].point_m.x += 1e-4;
  expect("vertex 3");
  reference_.sites[0].vertex = 1000000;
  expect("vertex 1000000");
}

TEST_F(ReferenceFits, AnotherTissueIsRefused) {
  scene_.elastic->poisson_ratio = 0.4;
  expect("poisson_ratio");
  scene_.elastic->poisson_ratio = 0.45;
  scene_.elastic->youngs_modulus_Pa = 4000.0;
  expect("youngs_modulus_Pa");
  EXPECT_EQ(said(ModulusOf::kAny), "") << "a fit looks for it";
  scene_.elastic.reset();
  EXPECT_EQ(said(), "") << "a scene that states no tissue cannot differ";
}

TEST_F(ReferenceFits, AnotherHeldBoxIsRefused) {
  scene_.elastic->fixed_max_m.z = -0.02;
  expect("held box");
}

}  // namespace tact::tools::ground_truth::reference_fits_test
