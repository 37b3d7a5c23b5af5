// SPDX-License-Identifier: Apache-2.0
// tact-mesh as a user runs it: exit status, output, and one-line errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/mesh_files.h"

namespace tact::tests::mesh_tool_test {

class MeshTool : public testing::Test {
 protected:
  Ran run(const std::string& arguments) const { return run_apart(temp_, "tact-mesh", arguments); }
  static void expect_one_line_error(const Ran& ran, const std::string& start) {
    EXPECT_EQ(ran.status, 2);
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(ran.err.substr(0, start.size()), start);
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
    EXPECT_EQ(ran.err.back(), '\n');
  }

  TempDirectory temp_;
  const std::string cube_ = temp_.write("cube.obj", kCubeVertices + kCubeFaces);
};

TEST_F(MeshTool, PrintsSizeAreaAndVolumeOfACube) {
  const Ran ran = run(cube_ + " --unit mm");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  EXPECT_EQ(ran.out,
            "unit       mm, as named\n"
            "vertices   8\n"
            "           8 in the file, 0 welded, 0 unused\n"
            "triangles  12\n"
            "surface    closed\n"
            "area       6 cm2\n"
            "volume     1 cm3\n"
            "x          0 to 10 mm (10 mm)\n"
            "y          0 to 10 mm (10 mm)\n"
            "z          0 to 10 mm (10 mm)\n");
}

TEST_F(MeshTool, PrintsJsonInSiUnits) {
  const Ran ran = run("--json --unit-m 0.01 " + cube_);
  ASSERT_EQ(ran.status, 0);
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["vertices"], 8);
  EXPECT_EQ(json["triangles"], 12);
  EXPECT_EQ(json["closed"], true);
  EXPECT_EQ(json["boundary_edges"], 0);
  EXPECT_EQ(json["welded_vertices"], 0);
  EXPECT_EQ(json["flipped"], false);
  EXPECT_NEAR(json["area_m2"].get<double>(), 0.06, 1e-12);
  EXPECT_NEAR(json["volume_m3"].get<double>(), 1e-3, 1e-12);
  EXPECT_NEAR(json["high_m"][2].get<double>(), 0.1, 1e-12);
}

TEST_F(MeshTool, SaysWhichUnitItTookAndWhyAndHowToSetIt) {
  const auto reported = [this](const std::string& arguments, const std::string& line,
                               const std::string& from, double unit_m) {
    SCOPED_TRACE(arguments);
    EXPECT_EQ(run(arguments).out.substr(0, line.size() + 1), line + "\n");
    const auto json = nlohmann::json::parse(run("--json " + arguments).out);
    EXPECT_EQ(json["unit_from"], from);
    EXPECT_EQ(json["unit_m"], unit_m);
    EXPECT_NEAR(json["volume_m3"].get<double>() / std::pow(json["high_m"][0].get<double>(), 3), 1.0,
                1e-12)
        << "all lengths in the same unit";
  };
  reported(cube_, "unit       taken as cm: 100 mm across; --unit sets another", "size", 0.01);
  const auto cube = [this](const std::string& name, const std::string& ten) {
    std::string text = kCubeVertices;
    for (std::size_t at = 0; (at = text.find("10", at)) != text.npos; at += ten.size())
      text.replace(at, 2, ten);
    return temp_.write(name, text + kCubeFaces);
  };
  reported(cube("scan.obj", "210"), "unit       taken as mm: 210 mm across; --unit sets another",
           "size", 0.001);
  reported(cube("metres.obj", "0.21"), "unit       taken as m: 210 mm across; --unit sets another",
           "size", 1.0);
  reported(cube_ + " --unit in", "unit       in, as named", "named", 0.0254);
  reported(cube_ + " --unit-m 0.02", "unit       0.02 m, as named", "named", 0.02);
}

TEST_F(MeshTool, SaysThatThereIsMoreThanOnePart) {
  EXPECT_EQ(run(temp_.write("one.obj", kCubeVertices + kCubeFaces)).out.find("parts"),
            std::string::npos);
  std::string two = kCubeVertices + kCubeFaces;
  two += "v 50 0 0\nv 51 0 0\nv 50 1 0\nv 50 0 1\nf 9 11 10\nf 9 10 12\nf 9 12 11\nf 10 11 12\n";
  const std::string path = temp_.write("two.obj", two);
  EXPECT_NE(run(path).out.find("2 parts that share no edge"), std::string::npos) << run(path).out;
  EXPECT_EQ(nlohmann::json::parse(run("--json " + path).out)["parts"], 2);
}

TEST_F(MeshTool, SaysWhatAnOpenSurfaceLacks) {
  const std::string path = temp_.write("open.obj", kCubeVertices + kCubeFaces.substr(16));
  const Ran ran = run(path);
  EXPECT_EQ(ran.status, 0);
  EXPECT_NE(ran.out.find("surface    open, 4 boundary edges\n"), std::string::npos);
  EXPECT_NE(ran.out.find("volume     none, the surface is open\n"), std::string::npos);
  const auto json = nlohmann::json::parse(run("--json " + path).out);
  EXPECT_TRUE(json["volume_m3"].is_null());
}

TEST_F(MeshTool, AClosedSurfaceWithoutVolumeIsAnError) {
  const std::string path =
      temp_.write("flat.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\nf 1 3 2\n");
  expect_one_line_error(run(path),
                        "tact-mesh: " + path +
                            ": closed, of 2 faces, and without a volume: two sheets that "
                            "lie on each other; take one sheet, or a solid");
  expect_one_line_error(run(path + " --json"), "tact-mesh: ");
  // A leaf of 1/1000 of its size is thin, and a solid.
  std::string thin = kCubeVertices;
  for (std::size_t at = 0; (at = thin.find(" 10\n", at)) != thin.npos;)
    thin.replace(at, 3, " 0.01");
  EXPECT_EQ(run(temp_.write("thin.obj", thin + kCubeFaces)).status, 0);
}

TEST_F(MeshTool, TheRemedyOfAFaceWithoutAreaIsACommand) {
  const std::string flat = kCubeVertices + "v 5 0 0\n" + kCubeFaces + "f 1 9 2\n";
  const Ran ran = run(temp_.write("bad.obj", flat));
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("tact-mesh FILE --weld --drop-degenerate --out NEW.obj"), ran.err.npos)
      << ran.err;
}

TEST_F(MeshTool, EveryLineOfTheManifestOfBadFilesHolds) {
  for (const BadFile& file : bad_files(temp_)) {
    SCOPED_TRACE(file.name);
    const Ran ran = run(file.path);
    if (file.expect == "ok") {
      EXPECT_EQ(ran.status, 0);
      EXPECT_NE(ran.out.find(std::to_string(file.vertices) + " in the file"), std::string::npos);
      EXPECT_NE(ran.out.find("triangles  " + std::to_string(file.triangles)), std::string::npos);
    } else {
      expect_one_line_error(ran, "tact-mesh: " + file.path + ":");
    }
  }
}

TEST_F(MeshTool, RefusesBadUsageInOneLine) {
  expect_one_line_error(run(""), "tact-mesh: FILE is required");
  expect_one_line_error(run(cube_ + " more.obj"), "tact-mesh: ");
  expect_one_line_error(run("--unit-m inch " + cube_), "tact-mesh: ");
  expect_one_line_error(run("--unit-m 0 " + cube_),
                        "tact-mesh: --unit-m: 0 is not in [1e-09 - 1000000]");
  expect_one_line_error(run("--unit-m nan " + cube_), "tact-mesh: ");
  expect_one_line_error(run("--frobnicate " + cube_), "tact-mesh: ");
  expect_one_line_error(run(temp_.path() + "/none.obj"), "tact-mesh: ");
  expect_one_line_error(run(temp_.path()), "tact-mesh: ");
}

TEST_F(MeshTool, HelpNamesEveryOptionWithItsUnit) {
  const Ran ran = run("--help");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.err, "");
  for (const std::string word :
       {"FILE", "--unit-m", "one file unit, m", "--json", "SI units", "Exit status"}) {
    EXPECT_NE(ran.out.find(word), std::string::npos) << word;
  }
}

}  // namespace tact::tests::mesh_tool_test
