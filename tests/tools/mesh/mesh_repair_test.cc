// SPDX-License-Identifier: Apache-2.0
// tact-mesh makes a sound organ of what a scanner gives, and each step says what it did.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "model/mesh/obj.h"
#include "tests/support/mesh_files.h"
#include "tests/tools/mesh/scanned_organ.h"

namespace tact::tests::mesh_repair_test {

using model::Vec3;
using model::mesh::SurfaceMesh;
using nlohmann::json;

const std::string kAll = " --weld --drop-degenerate --largest --close-holes --smooth";

class MeshRepair : public testing::Test {
 protected:
  Ran run(const std::string& arguments) const { return run_apart(temp_, "tact-mesh", arguments); }
  json reported(const std::string& arguments) const {
    const Ran ran = run("--json --unit mm " + arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return ran.status == 0 ? json::parse(ran.out) : json();
  }
  static std::int64_t count(const json& reported, const std::string& step) {
    for (const json& s : reported["steps"])
      if (s["step"] == step) return s["count"];
    ADD_FAILURE() << "no step " << step << " in " << reported.dump();
    return -1;
  }

  TempDirectory temp_;
  const std::string cube_ = temp_.write("cube.obj", kCubeVertices + kCubeFaces);
};

double sharpest_fold(const SurfaceMesh& mesh) {
  double least = 1.0;
  for (std::size_t t = 0; t < mesh.triangle.size(); ++t)
    for (const std::uint32_t next : mesh.neighbour[t])
      if (next != model::contact::kNoTriangle)
        least = std::min(least, dot(mesh.face_normal[t], mesh.face_normal[next]));
  return least;
}

bool pierces(const Vec3& from, const Vec3& to, const std::array<Vec3, 3>& t) {
  const Vec3 d = to - from, e1 = t[1] - t[0], e2 = t[2] - t[0], h = cross(d, e2);
  const double det = dot(e1, h);
  if (det == 0.0) return false;
  const Vec3 s = from - t[0], q = cross(s, e1);
  const double u = dot(s, h) / det, v = dot(d, q) / det, w = dot(e2, q) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && w >= 0.0 && w <= 1.0;
}

/// Pairs of triangles without a common corner that cross each other.
std::size_t crossings(const SurfaceMesh& mesh) {
  const auto& triangle = mesh.triangle;
  std::vector<std::array<Vec3, 3>> place(triangle.size());
  for (std::size_t t = 0; t < triangle.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) place[t][c] = mesh.vertex_m[triangle[t][c]];
  const auto low = [&](std::size_t t) {
    return std::min({place[t][0].x, place[t][1].x, place[t][2].x});
  };
  const auto high = [&](std::size_t t) {
    return std::max({place[t][0].x, place[t][1].x, place[t][2].x});
  };
  std::vector<std::size_t> order(triangle.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return low(a) < low(b); });
  std::size_t crossing = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t a = order[i];
    const double end = high(a);
    for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= end; ++j) {
      const std::size_t b = order[j];
      const auto shared = [&](std::uint32_t v) {
        return std::find(triangle[b].begin(), triangle[b].end(), v) != triangle[b].end();
      };
      if (std::any_of(triangle[a].begin(), triangle[a].end(), shared)) continue;
      bool cross = false;
      for (std::size_t c = 0; c < 3; ++c)
        cross = cross || pierces(place[a][c], place[a][(c + 1) % 3], place[b]) ||
                pierces(place[b][c], place[b][(c + 1) % 3], place[a]);
      crossing += cross;
    }
  }
  return crossing;
}

TEST_F(MeshRepair, AScannedOrganBecomesSoundInOneCommand) {
  ScannedOrgan organ(108);
  const double whole_mm3 = [&] {
    const auto sum = [](const Soup& s) {
      double volume_mm3 = 0.0;
      for (const auto& t : s.triangle)
        volume_mm3 +=
            dot(s.vertex[t[0]] - kScannerOffset_mm,
                cross(s.vertex[t[1]] - kScannerOffset_mm, s.vertex[t[2]] - kScannerOffset_mm)) /
            6.0;
      return volume_mm3;
    };
    return sum(ScannedOrgan(organ).surface());  // the open end lies in a plane through the origin
  }();
  organ.add_islands(248);
  Soup soup = organ.surface();
  spoil(soup, 40);
  EXPECT_GT(soup.triangle.size(), 170'000u);
  EXPECT_LT(soup.triangle.size(), 230'000u);
  const std::string scan = temp_.write("scan.stl", as_stl(soup)), out = temp_.path() + "/organ.obj";
  EXPECT_EQ(run(temp_.write("scan.obj", as_obj(soup))).status, 2) << "as it is it is no surface";

  const json report = reported(scan + " --out " + out + kAll + " --decimate 6000");
  EXPECT_EQ(count(report, "read"), static_cast<std::int64_t>(soup.triangle.size()) - 40)
      << "VTK reads no triangle with a corner twice";
  EXPECT_GE(count(report, "part"), 40);
  EXPECT_GE(count(report, "largest"), 248 + 40);
  EXPECT_GE(count(report, "close-holes"), 1);
  EXPECT_EQ(report["closed"], true);
  EXPECT_EQ(report["out"], out);

  const auto loaded = model::mesh::load_obj(out, 0.001);
  ASSERT_TRUE(loaded) << loaded.error().message;
  const auto sum = model::mesh::summarize(loaded->mesh);
  EXPECT_EQ(sum.boundary_edges, 0u);
  EXPECT_GT(sum.triangles, 5900u);
  EXPECT_LE(sum.triangles, 6000u);
  EXPECT_EQ(model::mesh::count_parts(loaded->mesh), 1u);
  EXPECT_NEAR(1e9 * sum.volume_m3 / whole_mm3, 1.0, 0.02);
  EXPECT_NEAR(1e3 * sum.low_m.z, kScannerOffset_mm.z, 0.5) << "stays where the scanner saw it";
  EXPECT_GT(sharpest_fold(loaded->mesh), -0.9);
  EXPECT_EQ(crossings(loaded->mesh), 0u);
  EXPECT_FALSE(loaded->flipped);
  std::uint32_t widest = 0;
  const auto& fans = loaded->mesh.fan_start;
  for (std::size_t v = 0; v + 1 < fans.size(); ++v)
    widest = std::max(widest, fans[v + 1] - fans[v]);
  EXPECT_LE(widest, model::contact::kMaxFan) << "more triangles around a vertex than contact takes";
  EXPECT_EQ(run(out).status, 0);
}

TEST_F(MeshRepair, ACrossingIsSeenByThisTest) {
  const std::string two = temp_.write(
      "two.obj",
      kCubeVertices + kCubeFaces +
          "v 5 5 5\nv 15 6 6\nv 6 15 7\nv 7 6 15\nf 9 11 10\nf 9 10 12\nf 10 11 12\nf 11 9 12\n");
  const auto loaded = model::mesh::load_obj(two, 0.001);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_GT(crossings(loaded->mesh), 0u);
}

TEST_F(MeshRepair, WeldJoinsWhatIsNearAndNotOnlyWhatIsEqual) {
  Soup soup;
  const auto cube = model::mesh::load_obj(cube_, 1.0);
  ASSERT_TRUE(cube);
  for (const auto& t : cube->mesh.triangle) {
    for (const std::uint32_t v : t) {
      const double aside = 1e-5 * static_cast<double>(soup.vertex.size() % 3);
      soup.vertex.push_back(cube->mesh.vertex_m[v] + Vec3{aside, 0.0, 0.0});
    }
    const auto n = static_cast<std::uint32_t>(soup.vertex.size());
    soup.triangle.push_back({n - 3, n - 2, n - 1});
  }
  const std::string path = temp_.write("near.stl", as_stl(soup));
  const json apart = reported(path), welded = reported(path + " --weld");
  EXPECT_EQ(apart["closed"], false);
  EXPECT_EQ(welded["closed"], true);
  EXPECT_EQ(welded["vertices"], 8);
  EXPECT_GE(count(welded, "weld"), 8);
}

TEST_F(MeshRepair, DropDegenerateDropsFacesWithoutAreaAndDoubledOnes) {
  // One without area, one twice, and a wall of two that face each other.
  const std::string path = temp_.write(
      "bad.obj", kCubeVertices + "v 5 0 0\n" + kCubeFaces + "f 1 9 2\nf 1 4 3\nf 1 2 7\nf 7 2 1\n");
  EXPECT_EQ(run(path).status, 2);
  const json report = reported(path + " --drop-degenerate");
  EXPECT_EQ(count(report, "drop-degenerate"), 4);
  EXPECT_EQ(report["triangles"], 12);
  EXPECT_EQ(report["closed"], true);
}

TEST_F(MeshRepair, ResultWithoutAreaOrVolumeIsRefusedWithTheRemedy) {
  const std::string needle =
      temp_.write("needle.obj", kCubeVertices + "v 5 0 0\n" + kCubeFaces + "f 1 9 2\n");
  const std::string out = temp_.path() + "/out.obj";
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Ran ran = run(arguments + " --out " + out);
    EXPECT_EQ(ran.status, 2) << ran.out;
    EXPECT_NE(ran.err.find(words), std::string::npos) << ran.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  refused(needle + " --weld", "after these steps the face has zero area; add --drop-degenerate\n");
  const std::string line = temp_.write("line.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n");
  refused(line + " --drop-degenerate", "no face is left after drop-degenerate");
  const std::string flat =
      temp_.write("flat.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 9 9 0\nf 1 2 3\nf 2 4 3\n");
  EXPECT_EQ(reported(flat + " --weld")["closed"], false) << "one sheet is a surface";
  refused(flat + " --close-holes", "closed, of 4 faces, and without a volume");
}

TEST_F(MeshRepair, FacesAreTurnedAsTheirNeighboursAndOutwards) {
  std::string faces = kCubeFaces;
  faces.replace(faces.find("f 2 3 7"), 7, "f 7 3 2");
  const std::string path = temp_.write("turned.obj", kCubeVertices + faces);
  EXPECT_EQ(run(path).status, 2);
  const json report = reported(path + " --close-holes");
  EXPECT_EQ(count(report, "turn"), 1);
  EXPECT_EQ(report["closed"], true);
  EXPECT_NEAR(report["volume_m3"].get<double>(), 1e-6, 1e-12);
}

TEST_F(MeshRepair, SolidsThatShareAnEdgeAreSeparatedInPlace) {
  // A second cube on the edge from 7 to 3.
  const std::string path = temp_.write(
      "edge.obj", kCubeVertices +
                      "v 20 10 0\nv 20 20 0\nv 10 20 0\nv 20 10 10\nv 20 20 10\nv 10 20 10\n" +
                      kCubeFaces +
                      "f 3 11 10\nf 3 10 9\nf 7 12 13\nf 7 13 14\nf 3 9 12\nf 3 12 7\n"
                      "f 9 10 13\nf 9 13 12\nf 10 11 14\nf 10 14 13\nf 11 3 7\nf 11 7 14\n");
  EXPECT_EQ(run(path).status, 2) << "one edge with four triangles";
  const json report = reported(path + " --largest --close-holes");
  EXPECT_EQ(count(report, "part"), 1);
  EXPECT_EQ(count(report, "largest"), 1);
  EXPECT_EQ(report["triangles"], 12);
  const json both = reported(path + " --close-holes");
  EXPECT_EQ(both["steps"][3]["text"], "1 edges with more than two faces, 0 faces dropped there");
  EXPECT_EQ(both["triangles"], 24);
  EXPECT_EQ(both["closed"], true);
  EXPECT_NEAR(both["volume_m3"].get<double>(), 2e-6, 0.03e-6);
}

TEST_F(MeshRepair, CloseHolesClosesWhatIsOpenAndNothingElse) {
  const std::string open = temp_.write("open.obj", kCubeVertices + kCubeFaces.substr(16));
  const json left = reported(open + " --drop-degenerate"),
             closed = reported(open + " --close-holes");
  EXPECT_EQ(left["closed"], false);
  EXPECT_EQ(count(closed, "close-holes"), 1);
  EXPECT_EQ(closed["triangles"], 12);
  EXPECT_NEAR(closed["volume_m3"].get<double>(), 1e-6, 1e-12);
}

TEST_F(MeshRepair, SmoothAndDecimateKeepTheSizeAndAnOpening) {
  const std::string path = temp_.write("small.stl", as_stl(ScannedOrgan(40).surface()));
  const json before = reported(path), smooth = reported(path + " --smooth");
  EXPECT_EQ(smooth["triangles"], before["triangles"]);
  EXPECT_LT(smooth["area_m2"].get<double>(), before["area_m2"].get<double>());
  EXPECT_NEAR(smooth["low_m"][2].get<double>(), before["low_m"][2].get<double>(), 1e-4);
  for (const int faces : {300, 1000, 3000, 6000}) {
    const json fewer = reported(fmt::format("{} --decimate {}", path, faces));
    EXPECT_LE(fewer["triangles"].get<int>(), faces);
    EXPECT_GT(fewer["triangles"].get<int>(), 0.95 * faces);
    EXPECT_EQ(fewer["closed"], false) << "an opening that was not to be closed";
    EXPECT_NEAR(fewer["area_m2"].get<double>() / before["area_m2"].get<double>(), 1.0, 0.1);
  }
}

TEST_F(MeshRepair, AKillLeavesNoFileAndNoProgramBehind) {
  const std::string path = temp_.write("scan.obj", as_obj(ScannedOrgan(80).surface()));
  const std::string folder = temp_.path() + "/tmp", log = temp_.path() + "/log";
  std::filesystem::create_directory(folder);
  const Outcome ran = run_command(
      "( export TMPDIR=" + folder + "; " + program_path("tact-mesh") + " " + path + kAll + " >" +
      log + " 2>&1 & mesh=$!; for i in $(seq 600); do grep -qs '^weld' " + log +
      " && break; sleep 0.05; done; repair=$(cat /proc/$mesh/task/$mesh/children); " +
      // Stopped, it cannot end by itself.
      "kill -STOP $repair && echo works; kill -9 $mesh; " +
      "for i in $(seq 200); do kill -0 $repair 2>/dev/null || break; sleep 0.05; done; " +
      "kill -9 $repair 2>/dev/null || echo gone; ls -A " + folder + " )");
  EXPECT_EQ(ran.output, "works\ngone\n");
}

TEST_F(MeshRepair, SaysEachStepToAPersonAndWritesOverNoSource) {
  const std::string out = temp_.path() + "/out.obj";
  const Ran ran = run(cube_ + " --out " + out + " --weld --largest");
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const char* line :
       {"read             12 faces, 8 vertices\n", "weld             0 vertices joined",
        "largest          0 of 1 parts dropped, 0 faces\n", "wrote            ",
        "surface    closed\n"})
    EXPECT_NE(ran.out.find(line), std::string::npos) << ran.out;
  EXPECT_EQ(run(cube_ + " --out " + out).status, 0) << "its own result may be replaced";
  for (const std::string& kept : {cube_, temp_.write("scene.toml", "name = \"mine\"\n")}) {
    const std::string text = read_text(kept);
    const Ran refused = run(cube_ + " --smooth --out " + kept);
    EXPECT_EQ(refused.status, 2) << refused.out;
    EXPECT_EQ(refused.out, "");
    EXPECT_EQ(read_text(kept), text);
  }
}

}  // namespace tact::tests::mesh_repair_test
