// SPDX-License-Identifier: Apache-2.0
// tact-lab new-scene as a person meets it: a mesh in, a scene out that tactd runs, or nothing.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "model/scene/compliance_file.h"
#include "model/scene/scene.h"
#include "tests/support/extent.h"
#include "tests/tools/new_scene/new_scene_fixture.h"

namespace tact::tools::new_scene::new_scene_test {

using nlohmann::json;

TEST_F(NewScene, AScanBecomesASceneWithForces) {
  const std::string organ = temp_.write("organ.stl", as_stl(ellipsoid_mm(3)));
  const Ran ran = run(organ + " --out " + out_ + " --youngs-modulus-Pa 8000");
  ASSERT_EQ(ran.status, 0) << ran.err << ran.out;
  EXPECT_EQ(made(), (std::vector<std::string>{"mine.compliance", "mine.obj", "mine.toml",
                                              "mine_tool.obj"}));
  for (const char* reported : {"unit             taken as mm: 100 mm across; --unit sets another\n",
                               "organ  ", "place  ", "condense  ", "check  ", "wrote  ", "law  "})
    EXPECT_NE(ran.out.find(reported), ran.out.npos) << reported << ran.out;

  const auto scene = model::scene::load_scene(out_, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->name, "mine");
  EXPECT_EQ(scene->law, "compliance");
  EXPECT_TRUE(scene->varies_by_place) << "the map is of this organ";
  EXPECT_EQ(scene->elastic->youngs_modulus_Pa, 8000.0);
  const auto sum = summarize(scene->organ_mesh);
  EXPECT_NEAR(sum.high_m.z, 0.0, 1e-6) << "its top is under the tool";
  EXPECT_NEAR(sum.high_m.z - sum.low_m.z, 0.06, 1e-3) << "millimetres";

  const tests::Outcome check = tests::run_program("tactd", out_ + " --check");
  EXPECT_EQ(check.status, 0) << check.output;
  const tests::Outcome run = tests::run_program(
      "tactd",
      out_ + " --free-run --seconds 5 --no-telemetry --no-black-box --json " + path("run"));
  ASSERT_EQ(run.status, 0) << run.output;
  const double rendered_N = json::parse(tests::read_text(path("run")))["force_max_N"];
  EXPECT_GT(rendered_N, 0.1);
  EXPECT_LT(rendered_N, 5.0);
}

TEST_F(NewScene, ASoundObjIsTakenAsItIsAndAnEarlierSceneIsKept) {
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(2)));
  const std::string arguments = organ + " --out " + out_;
  Ran ran = run(arguments);
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(made(), (std::vector<std::string>{"mine.compliance", "mine.toml", "mine_tool.obj"}));
  auto scene = model::scene::load_scene(out_, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->organ.mesh_path, fs::path(organ).lexically_normal().string());

  const std::string first = tests::read_text(out_);
  ran = run(arguments + " --poisson-ratio 0.3");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("mine.toml: exists already; choose another --out, or add --force"),
            ran.err.npos)
      << ran.err;
  EXPECT_EQ(tests::read_text(out_), first);
  ran = run(arguments + " --poisson-ratio 0.3 --force");
  ASSERT_EQ(ran.status, 0) << ran.err;
  scene = model::scene::load_scene(out_, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->elastic->poisson_ratio, 0.3);
  EXPECT_EQ(model::scene::read_compliance_map(path("mine.compliance"))->poisson_ratio, 0.3);
}

TEST_F(NewScene, AScanWithColoursKeepsThem) {
  std::string text;
  const SurfaceMesh ball = ellipsoid_mm(3);
  for (const Vec3& p : ball.vertex_m)
    text += fmt::format("v {} {} {} {} 0.5 0\n", p.x, p.y, p.z, p.z > 1310.0 ? 1 : 0);
  for (const auto& t : ball.triangle)
    text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  const Ran ran = run(temp_.write("scan.obj", text) + " --smooth --faces 600 --out " + out_);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto scene = model::scene::load_scene(out_, {});
  ASSERT_TRUE(scene) << scene.error().message;
  ASSERT_EQ(scene->look.vertex_color.size(), scene->organ_mesh.vertex_m.size());
  for (std::size_t v = 0; v < scene->look.vertex_color.size(); ++v) {
    const double above_m = scene->organ_mesh.vertex_m[v].z + 0.03;  // its top is at 0
    if (std::abs(above_m) < 0.008) continue;
    EXPECT_EQ(scene->look.vertex_color[v],
              (model::mesh::Rgb{static_cast<std::uint8_t>(above_m > 0 ? 255 : 0), 128, 0}));
  }
}

TEST_F(NewScene, TakesNamesWithSpacesAndPrintsCommandsThatCanBePasted) {
  const std::string organ = temp_.write("an organ.obj", as_obj(ellipsoid_mm(2)));
  const Ran ran = run("'" + organ + "' --out '" + path("mine, too.toml") + "'");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("  tactd '" + path("mine, too.toml") + "' --free-run"), ran.out.npos)
      << ran.out;
  EXPECT_EQ(tests::run_program("tactd", "'" + path("mine, too.toml") + "' --check").status, 0);
}

TEST_F(NewScene, RefusesBeforeTheWorkAndWritesNothing) {
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(1)));
  const std::string foreign = temp_.write("theirs.toml", "name = \"theirs\"\n");
  const std::string liver = TACT_SOURCE_DIR "/model/scenes/liver.toml";
  const std::string shipped = tests::read_text(liver);
  for (const auto& [arguments, words] : std::vector<std::pair<std::string, std::string>>{
           {organ + " --out " + path("mine.txt"), "a scene's name ends in .toml"},
           {organ + " --force --out " + foreign, "holds something else"},
           {organ + " --force --out " + liver, "holds something else"},
           {organ + " --out " + path("none/mine.toml"), "cannot be written"},
           {path("none.stl") + " --out " + out_, "no such file"},
           {organ + " --out " + out_ + " --poisson-ratio 0.5", "--poisson-ratio"},
           {organ + " --out " + out_ + " --unit m", "an organ is 0.005 to 2.5 m; name its --unit"},
           {organ, "--out is required"}}) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    EXPECT_NE(ran.err.find(words), ran.err.npos) << arguments << ": " << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
  EXPECT_EQ(made(), std::vector<std::string>{});
  EXPECT_EQ(tests::read_text(foreign), "name = \"theirs\"\n");
  EXPECT_EQ(tests::read_text(liver), shipped);
}

TEST_F(NewScene, CtrlCLeavesNothing) {
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(4)));
  const std::string log = path("log"), program = tests::program_path("tact-lab new-scene");
  const tests::Outcome ran = tests::run_command(
      "( " + program + " " + organ + " --out " + out_ + " >" + log + " 2>&1 & " +
      "for i in $(seq 600); do grep -qs condense " + log + " && break; sleep 0.05; done; " +
      "kill -INT $!; wait $!; status=$?; cat " + log + "; exit $status )");
  EXPECT_EQ(ran.status, 1) << ran.output;
  EXPECT_NE(ran.output.find("condense  "), ran.output.npos) << "in the midst of the work";
  EXPECT_NE(ran.output.find("interrupted; nothing was written"), ran.output.npos) << ran.output;
  EXPECT_EQ(made(), std::vector<std::string>{});
}

TEST_F(NewScene, TooStiffOrganIsNotWrittenAndTheLargestModulusIsNamed) {
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(2)));
  Ran ran = run(organ + " --out " + out_ + " --youngs-modulus-Pa 100000");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("mine.toml: law compliance is too stiff"), ran.err.npos) << ran.err;
  EXPECT_EQ(made(), std::vector<std::string>{});
  const std::string words = "write elastic.youngs_modulus_Pa = ";
  const std::size_t at = ran.err.find(words);
  ASSERT_NE(at, ran.err.npos) << ran.err;
  const double modulus_Pa = std::stod(ran.err.substr(at + words.size()));
  ran = run(organ + " --out " + out_ + fmt::format(" --youngs-modulus-Pa {}", modulus_Pa));
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_EQ(tests::run_program("tactd", out_ + fmt::format(" --check --set "
                                                           "elastic.youngs_modulus_Pa={}",
                                                           1.01 * modulus_Pa))
                .status,
            2)
      << "and no softer than needed";
  EXPECT_EQ(tests::run_program("tactd", out_ + " --free-run --seconds 1 --no-telemetry "
                                               "--no-black-box --set elastic.youngs_modulus_Pa=1e6 "
                                               "--set 'device.kind=\"sim-ideal\"'")
                .status,
            0)
      << "to look at, on the ideal one";
}

TEST_F(NewScene, PlansTheLawForThisPcWithReferencesThatAnotherCanUse) {
  if (!tests::extent_is("long"))
    GTEST_SKIP() << "two minutes of finite elements: with TACT_EXTENT=long, as tools/check --long";
  if (std::system("command -v ccx >/dev/null") != 0) GTEST_SKIP() << "no CalculiX here";
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(2)));
  const auto with_cache = [this](const char* program, const std::string& arguments) {
    return tests::run_command("XDG_CACHE_HOME=" + path("cache") + " " +
                              tests::program_path(program) + " " + arguments);
  };
  tests::Outcome ran = with_cache("tact-lab new-scene", organ + " --out " + out_ + " --plan");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_EQ(made(), (std::vector<std::string>{"mine.compliance", "mine.reference.json", "mine.toml",
                                              "mine_tool.obj", "mine_tool.reference.json"}));
  EXPECT_EQ(model::scene::load_scene(out_, {})->law, "auto");
  ran = with_cache("tactd", out_ + " --check");
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("law \"auto\" is --set law="), ran.output.npos) << ran.output;
  ran = with_cache("tact-lab plan", out_ + " --dry-run --reference " + path("mine.reference.json") +
                                        " --tool-reference " + path("mine_tool.reference.json"));
  EXPECT_EQ(ran.status, 0) << ran.output;
}

TEST_F(NewScene, WithoutCalculiXThereIsNoPlanAndTheSceneRuns) {
  const std::string organ = temp_.write("organ.obj", as_obj(ellipsoid_mm(2)));
  const std::string programs = path("programs");
  fs::create_directory(programs);
  fs::create_symlink("/usr/bin/gmsh", programs + "/gmsh");
  const tests::Outcome ran =
      tests::run_command("PATH=" + programs + " " + tests::program_path("tact-lab new-scene") +
                         " " + organ + " --out " + out_ + " --plan");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(
      ran.output.find("\nplan             none: tact-lab reference: ccx is not installed; apt "
                      "install calculix-ccx\ncheck"),
      ran.output.npos)
      << ran.output;
  EXPECT_EQ(ran.output.find("--plan --force"), ran.output.npos) << "it was asked for";
  EXPECT_EQ(made(), (std::vector<std::string>{"mine.compliance", "mine.toml", "mine_tool.obj"}));
  EXPECT_EQ(model::scene::load_scene(out_, {})->law, "compliance");
}

}  // namespace tact::tools::new_scene::new_scene_test
