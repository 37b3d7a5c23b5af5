// SPDX-License-Identifier: Apache-2.0
// Fits of an organ that differs from place to place.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "model/indent/hex_sheet.h"
#include "model/indent/rhombus_patch.h"
#include "model/scene/compliance_file.h"
#include "tests/support/compliance_map.h"
#include "tests/tools/fit/fit_fixture.h"
#include "tools/fit/fit_run.h"

namespace tact::tools::fit::fit_answer_test {

/// An elastic organ whose places give the more the higher their vertex; its map is a file.
class FitOfAnOrgan : public testing::Test {
 protected:
  FitOfAnOrgan() {
    truth_.elastic = {.youngs_modulus_Pa = 5000.0,
                      .poisson_ratio = 0.45,
                      .fixed_min_m = {-1, -1, -1},
                      .fixed_max_m = {1, -0.03, 1}};
    const std::size_t vertices = truth_.organ_mesh.vertex_m.size();
    model::tissue::ComplianceMap map{
        .poisson_ratio = 0.45,
        .patch_radius_m = 4_mm,
        .ring_pitch_m = 4_mm,
        .rings = 6,
        .fixed_min_m = truth_.elastic->fixed_min_m,
        .fixed_max_m = truth_.elastic->fixed_max_m,
        .mesh_hash = model::scene::surface_hash(truth_.organ_mesh.view())};
    for (std::size_t v = 0; v < vertices; ++v) {
      const float give = static_cast<float>(v) / static_cast<float>(vertices) * 30.0F;
      map.regular_times_E_per_m.push_back(give);
      map.sideways_times_E_per_m.push_back({0.0F, 0.0F, give, give});
      for (int k = 6; k > 0; --k)
        map.ring_times_E_per_m.push_back(give * static_cast<float>(k) / 7);
    }
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const auto folder = std::filesystem::temp_directory_path();
    truth_.compliance = {
        .map_path = (folder / fmt::format("tact_{}.compliance", test->name())).string(),
        .working_depth_m = 12_mm,
        .curves = 9,
        .large_strain = false};
    EXPECT_GT(tests::write_compliance_map(map, truth_.compliance.map_path), 0u);
    data_.sites = {make_contact_point(truth_, 60, 8_mm), make_contact_point(truth_, 200, 8_mm)};
    data_.sites[1].held_out = true;
  }
  ~FitOfAnOrgan() override { std::filesystem::remove(truth_.compliance.map_path); }

  Scene truth_ = make_scene();
  FitData data_;
};

TEST_F(FitOfAnOrgan, FindsTheModulus) {
  answer(truth_, "compliance", data_, true);
  Scene start = truth_;
  start.elastic->youngs_modulus_Pa = 900.0;
  const FittedLaw fitted = fit("compliance", start, data_);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 5000.0, 1.0);
  EXPECT_LT(fitted.checked.held_out.rms_ratio(), 1e-3);  // the map knows the other site
  // One stiffness for both places cannot be right, and says so.
  const FittedLaw chain = fit("disc_stack_linear", start, data_);
  EXPECT_FALSE(chain.checked.follows);
  EXPECT_GT(chain.checked.held_out.rms_ratio(), 2.0 * fitted.checked.held_out.rms_ratio());
}

TEST_F(FitOfAnOrgan, AReferenceIsFittedAtItsOwnStrainForAnyScene) {
  answer(truth_, "compliance", data_, true);
  data_.large_strain = false;
  Scene start = truth_;
  start.compliance.large_strain = true;
  const FittedLaw fitted = fit("compliance", start, data_);
  EXPECT_NEAR(value_of(fitted, "youngs_modulus_Pa"), 5000.0, 1.0);
  EXPECT_NE(fitted.title.find("small strain"), std::string::npos) << fitted.title;
}

TEST_F(FitOfAnOrgan, FindsALawInSeriesWithItsPlaces) {
  truth_.varies_by_place = true;
  truth_.pull = {.stiffness_N_per_m = 45.0, .limit_m = 8_mm};
  for (const char* name : {"rhombus", "hex_sheet"}) {
    answer(truth_, name, data_, false);
    Scene start = truth_;
    start.laws.of<model::indent::RhombusParameters>().chain.normal_stiffness_N_per_m *= 2.0;
    start.laws.of<model::indent::HexSheetParameters>().body_stiffness_N_per_m *= 2.0;
    FitLaw law = law_named(start, data_, name);
    keep_parameters(law, {"rod_length_m", "initial_angle_rad", "growth", "ring_pitch_m"});
    law.starts.resize(1);
    law.most_evaluations = 300;
    const auto fitted = fit_law(law, start, data_, {});
    ASSERT_TRUE(fitted) << fitted.error().message;
    EXPECT_LT(fitted->checked.fitted.rms_ratio(), 2e-3) << name;
    EXPECT_LT(fitted->checked.held_out.rms_ratio(), 2e-3) << name;
    EXPECT_NEAR(fitted->checked.sites[0].best_scale, 1.0, 2e-3) << name;
  }
}

TEST_F(FitOfAnOrgan, NeedsThePlacesOfTheSites) {
  answer(truth_, "compliance", data_, true);
  data_.sites[0].at.reset();
  const auto without_place =
      fit_law(law_named(truth_, data_, "compliance"), truth_, data_, FitOptions{});
  ASSERT_FALSE(without_place);
  EXPECT_NE(without_place.error().message.find("column site"), std::string::npos);
  truth_.varies_by_place = true;
  const auto chain = fit_law(law_named(truth_, data_, "rhombus"), truth_, data_, FitOptions{});
  ASSERT_FALSE(chain);
  EXPECT_NE(chain.error().message.find("varies_by_place=false"), std::string::npos);
}

}  // namespace tact::tools::fit::fit_answer_test
