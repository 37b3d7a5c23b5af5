// SPDX-License-Identifier: Apache-2.0
// The program tact-lab fit: exit status, what it prints, what it writes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "model/indent/disc_stack.h"
#include "model/scene/scene.h"
#include "tests/support/program.h"

namespace tact::tests::fit_tool_test {

namespace fs = std::filesystem;

const std::string kScene = std::string(TACT_SOURCE_DIR) + "/model/scenes/liver.toml";
const std::string kOnePlace = kScene + " --set varies_by_place=false";

class FitTool : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// F = 0.5 N (d / 10 mm)^power.
  std::string press(double power) const {
    std::ofstream out(file("press.csv"));
    out << "compression_mm,load_N\n";
    for (int i = 1; i <= 10; ++i) out << i << "," << 0.5 * std::pow(0.1 * i, power) << "\n";
    return file("press.csv") +
           " --depth-column compression_mm --depth-unit-m 0.001 --force-column load_N";
  }

  fs::path folder_ =
      fs::temp_directory_path() /
      (std::string("tact_fit_") + testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(FitTool, WritesKeysThatTheSceneTakes) {
  const auto run = run_program("tact-lab fit", kOnePlace + " --law disc_stack_linear --data " +
                                                   press(1.0) + " --out " + file("fit.toml"));
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("[disc_stack]\nform = \"linear\"\nyoungs_modulus_Pa = "),
            std::string::npos)
      << run.output;
  std::ifstream in(file("fit.toml"));
  const std::string toml{std::istreambuf_iterator<char>(in), {}};
  const std::string key = "youngs_modulus_Pa = ";
  const std::string value = toml.substr(toml.find(key) + key.size());
  const auto scene = model::scene::load_scene(
      kScene, {"disc_stack.form=\"linear\"",
               "disc_stack.youngs_modulus_Pa=" + value.substr(0, value.find('\n'))});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto stack = make_disc_stack(scene->laws.of<model::indent::DiscStackParameters>());
  ASSERT_TRUE(stack);
  EXPECT_NEAR(stack->respond(0.01).force_N, 0.5, 0.001);
}

TEST_F(FitTool, SaysThatALawCannotFollow) {
  const auto run = run_program("tact-lab fit",
                               kOnePlace + " --json --law disc_stack_linear --data " + press(2.0));
  EXPECT_EQ(run.status, 1) << run.output;
  const auto json = nlohmann::json::parse(run.output);
  EXPECT_EQ(json["follows"], false);
  EXPECT_GT(json["laws"][0]["fitted"]["rms_ratio"], 0.07);
  const std::string reason = json["laws"][0]["reasons"][0];
  EXPECT_NE(reason.find("is linear in press while the data hardens"), std::string::npos) << reason;
}

TEST_F(FitTool, FitsRelaxation) {
  {
    std::ofstream out(file("hold.csv"));
    out << "time_s,force_N\n";
    for (int i = 0; i <= 100; ++i)
      out << 0.1 * i << "," << 0.7 + 0.3 * std::exp(-0.1 * i / 1.5) << "\n";
  }
  const auto run = run_program("tact-lab fit", kScene + " --relaxation " + file("hold.csv"));
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_NE(run.output.find("[[relaxation]]\nshare_ratio = 0.3\ntime_s = 1.5\n"), std::string::npos)
      << run.output;
}

TEST_F(FitTool, RefusesBadInputWithOneMessage) {
  std::ofstream(file("bad.csv")) << "depth_m,force_N\n0.001,0.1\n0.002,x\n";
  const auto refused = [](const std::string& arguments, const std::string& words) {
    const auto run = run_program("tact-lab fit", arguments);
    EXPECT_EQ(run.status, 2) << run.output;
    EXPECT_NE(run.output.find(words), std::string::npos) << run.output;
  };
  refused(kScene, "nothing to fit to");
  refused(kScene + " --data " + file("bad.csv"), "bad.csv:3: force_N: \"x\" is no number");
  refused(kScene + " --law jelly --data " + press(1.0), "describes no law \"jelly\"");
  refused(kScene + " --law rhombus,jelly --data " + press(1.0), "describes no law \"jelly\"");
  refused(kScene + " --law rhombus --keep jelly --data " + press(1.0), "--keep jelly");
  refused(kScene + " --law disc_stack_linear --keep youngs_modulus_Pa --data " + press(1.0),
          "leaves nothing of disc_stack_linear");
  refused(kScene + " --reference " + file("none.json"), "none.json: no such file");
  refused("none.toml --data " + file("bad.csv"), "none.toml");
}

TEST_F(FitTool, NeverWritesOverWhatWasMeasured) {
  const std::string data = press(1.0), csv = file("press.csv");  // and its columns
  const auto before = std::filesystem::file_size(csv);
  const auto same = run_program(
      "tact-lab fit", kOnePlace + " --law disc_stack_linear --data " + data + " --out " + csv);
  EXPECT_EQ(same.status, 2) << same.output;
  EXPECT_NE(same.output.find("would be overwritten"), std::string::npos) << same.output;
  const std::string plot = std::filesystem::path(csv).replace_extension(".svg").string();
  const auto drawn = run_program(
      "tact-lab fit", kOnePlace + " --law disc_stack_linear --data " + data + " --picture " + plot);
  EXPECT_TRUE(std::filesystem::exists(plot)) << drawn.output;
  EXPECT_EQ(std::filesystem::file_size(csv), before);
}

}  // namespace tact::tests::fit_tool_test
