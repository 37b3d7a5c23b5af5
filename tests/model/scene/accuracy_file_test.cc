// SPDX-License-Identifier: Apache-2.0
// What tactd --check may say of a scene's force: what was measured, of what was measured alone.
#include "model/scene/accuracy_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model/indent/rhombus_patch.h"
#include "tests/support/measured_files.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::model::scene::accuracy_file_test {

using tests::accuracy_text;

class AccuracyFile : public testing::Test {
 protected:
  AccuracyFile() {
    scene.path = testing::TempDir() + "tact-accuracy-" +
                 testing::UnitTest::GetInstance()->current_test_info()->name() + ".toml";
    scene.elastic = ElasticSettings{.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45};
    scene.tolerance = ToleranceSettings{.force_error_ratio = 0.14};
  }
  ~AccuracyFile() override { std::filesystem::remove(accuracy_path(scene)); }

  Accuracy figure() const {
    return {.law = "rhombus",
            .law_hash = *hash_of_linear_forces(scene, scene.law),
            .reference = "linear finite elements",
            .date = "2026-11-24",
            .large_strain_off = false,
            .rms_ratio = 0.0126,
            .within_noticeable_ratio = 0.5,
            .depth_m = {0.001, 0.01},
            .own_worst_ratio = {-0.088, 0.139}};
  }
  void write(const std::string& text) const { std::ofstream(accuracy_path(scene)) << text; }
  std::string line() const { return accuracy_line(scene); }
  void expect_unknown(const std::string& why) const {
    EXPECT_NE(line().find("not known"), std::string::npos) << line();
    EXPECT_NE(line().find(why), std::string::npos) << line();
  }

  Scene scene = tests::make_plate_scene();
};

TEST_F(AccuracyFile, ComesBackAsItWasWritten) {
  write(accuracy_text({figure()}));
  const auto back = read_accuracy(scene);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->rms_ratio, 0.0126);
  EXPECT_EQ(back->own_worst_ratio, (std::vector<double>{-0.088, 0.139}));
  EXPECT_EQ(back->depth_m, (std::vector<double>{0.001, 0.01}));
  EXPECT_EQ(
      line(),
      "force of the whole tool: 1.3 % of the peak off (RMS), at the worst place 8.8 % at 1 mm, "
      "13.9 % at 10 mm of the force there; 50 % of all places and depths within the 7 % that "
      "people notice; against linear finite elements; measured 2026-11-24, hash " +
          figure().law_hash + "; it keeps its tolerance of 14 %, of the peak and of the own force");
}

TEST_F(AccuracyFile, SaysThatTheLargeStrainOfTheSceneWasOff) {
  Accuracy off = figure();
  off.large_strain_off = true;
  write(accuracy_text({off}));
  EXPECT_NE(line().find("against linear finite elements, with compliance.large_strain off, which "
                        "this scene has on; measured"),
            std::string::npos)
      << line();
}

TEST_F(AccuracyFile, ASmallRmsKeepsNoToleranceThatTheOwnForceMisses) {
  scene.tolerance->force_error_ratio = 0.05;  // the RMS is 1.3 %
  write(accuracy_text({figure()}));
  EXPECT_NE(
      line().find("it misses its tolerance of 5 %: 13.9 % of the own force at 10 mm, 1.3 % of "
                  "the peak (RMS)"),
      std::string::npos)
      << line();
  Accuracy light = figure();  // too soft, at light touch alone
  light.own_worst_ratio = {-0.088, 0.01};
  write(accuracy_text({light}));
  EXPECT_NE(line().find("it misses its tolerance of 5 %: 8.8 % of the own force at 1 mm"),
            std::string::npos)
      << line();
  light.own_worst_ratio = {-0.04, 0.01};
  light.rms_ratio = 0.06;
  write(accuracy_text({light}));
  EXPECT_NE(line().find("it misses its tolerance of 5 %"), std::string::npos) << line();
}

TEST_F(AccuracyFile, AnotherLawOrganOrToolHasNoFigure) {
  write(accuracy_text({figure()}));
  const Scene measured = scene;
  scene.laws.of<indent::RhombusParameters>().chain.growth = 1.9;
  expect_unknown("is of another law, organ or tool; tact-lab reference");
  scene = measured;
  scene.tool.spheres.push_back({{0, 0.008, 0}, 0.004});
  expect_unknown("is of another law, organ or tool");
  scene = measured;
  scene.hand.mass_kg = 1.0;
  scene.limits.force_N = 1.0;
  EXPECT_EQ(line().find("not known"), std::string::npos) << "a hand is no part of the force";
}

TEST_F(AccuracyFile, MissingOrDamagedDataIsReportedWithItsReason) {
  expect_unknown("it was never measured; tact-lab reference");
  write("[rhombus]\n");
  expect_unknown("is of another version of tact-lab chart; tact-lab reference");
  write("schema = \"tact-accuracy/2\"\n[hex_sheet]\n");
  expect_unknown("has no [rhombus]");
  write("[rhombus\n");
  expect_unknown(".accuracy:1: ");
  std::string text = accuracy_text({figure()});
  write(text.replace(text.find("0.0126"), 6, "\"none\""));
  expect_unknown("a number is missing");
  scene.elastic.reset();
  expect_unknown("has no [elastic]");
}

TEST(Shipped, TheFigureOfTheLiverIsOfTheLiverThatIsShipped) {
  for (const char* law : {"rhombus", "compliance", "hex_sheet", "disc_stack"}) {
    const auto scene = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml",
                                  {std::string("law=\"") + law + "\""});
    ASSERT_EQ(tests::message_of(scene), "");
    const auto tissue_law = make_tissue_law(*scene, scene->law);
    ASSERT_EQ(tests::message_of(tissue_law), "");
    const auto figure = read_accuracy(*scene);
    EXPECT_TRUE(figure) << (figure ? "" : figure.error().message);
  }
}

}  // namespace tact::model::scene::accuracy_file_test
