// SPDX-License-Identifier: Apache-2.0
#include "model/mesh/obj.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/comma_locale.h"
#include "tests/support/mesh_files.h"

namespace tact::model::mesh::obj_test {

using tests::kCubeFaces;
using tests::kCubeVertices;
using tests::TempDirectory;

constexpr double kMillimetre_m = 0.001;

class Obj : public testing::Test {
 protected:
  Result<ObjMesh> load(const std::string& text, double unit_m = kMillimetre_m) const {
    return load_obj(temp_.write("m.obj", text), unit_m);
  }
  ObjMesh load_good(const std::string& text) const {
    const auto obj = load(text);
    EXPECT_TRUE(obj.has_value()) << (obj ? "" : obj.error().message);
    return obj ? obj.value() : ObjMesh{};
  }
  void expect_cube(const std::string& text) const {
    const MeshSummary sum = summarize(load_good(text).mesh);
    EXPECT_EQ(sum.vertices, 8u) << text;
    EXPECT_EQ(sum.triangles, 12u);
    EXPECT_EQ(sum.boundary_edges, 0u);
    EXPECT_NEAR(sum.volume_m3, 1e-6, 1e-18);
  }
  // One line, "file:line: what; remedy".
  static void expect_line(const Error& error, const std::string& path, std::size_t line) {
    const std::string start = path + ":" + std::to_string(line) + ": ";
    EXPECT_EQ(error.message.substr(0, start.size()), start) << error.message;
    EXPECT_NE(error.message.find("; "), std::string::npos) << error.message;
    EXPECT_TRUE(std::all_of(error.message.begin(), error.message.end(),
                            [](char c) { return c >= ' ' && c <= '~'; }));
    EXPECT_LT(error.message.size(), path.size() + 200);
  }
  void expect_error(const std::string& text, std::size_t line, const std::string& part) const {
    const auto obj = load(text);
    ASSERT_FALSE(obj.has_value()) << text;
    expect_line(obj.error(), temp_.path() + "/m.obj", line);
    EXPECT_NE(obj.error().message.find(part), std::string::npos) << obj.error().message;
  }

  TempDirectory temp_;
};

TEST_F(Obj, EveryLineOfTheManifestOfBadFilesHolds) {
  const std::map<std::string, std::size_t> line_of{
      {"p01", 6}, {"p02", 7}, {"p03", 21}, {"p04", 21}, {"p09", 20001}, {"p11", 8}, {"p12", 21},
      {"p13", 8}, {"p14", 1}, {"p15", 1},  {"p17", 2},  {"p19", 15},    {"p20", 7}};
  int refused = 0;
  for (const tests::BadFile& file : tests::bad_files(temp_)) {
    SCOPED_TRACE(file.name);
    const auto obj = load_obj(file.path, kMillimetre_m);
    if (file.expect == "ok") {
      ASSERT_TRUE(obj.has_value()) << obj.error().message;
      EXPECT_EQ(obj->file_vertices, file.vertices);
      EXPECT_EQ(obj->mesh.triangle.size(), file.triangles);
      EXPECT_EQ(summarize(obj->mesh).boundary_edges, 0u);
      EXPECT_GT(summarize(obj->mesh).volume_m3, 0.0);
      continue;
    }
    // "either" allows both; tact refuses all of these, because none is a surface.
    ASSERT_FALSE(obj.has_value());
    expect_line(obj.error(), file.path, line_of.at(file.name.substr(0, 3)));
    ++refused;
  }
  EXPECT_EQ(refused, 13);
}

TEST_F(Obj, WeldsVerticesAtTheSamePlace) {
  const auto obj = load_obj(tests::bad_directory() + "p10_duplicate_vertices.obj", kMillimetre_m);
  ASSERT_TRUE(obj.has_value());
  EXPECT_EQ(obj->file_vertices, 24u);
  EXPECT_EQ(obj->welded_vertices, 16u);
  EXPECT_EQ(obj->unused_vertices, 0u);
  EXPECT_EQ(obj->mesh.vertex_m.size(), 8u);
  EXPECT_EQ(summarize(obj->mesh).boundary_edges, 0u);
}

TEST_F(Obj, WeldsMinusZeroToZeroButNotTheNextNumber) {
  const std::string two =
      "v 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 -0.0\nv 0 -1 0\nv -0 0 0\nf 1 2 3\nf 4 6 5\n";
  EXPECT_EQ(load_good(two).welded_vertices, 2u);
  EXPECT_EQ(load_good("v 1 0 0\nv 0 1 0\nv 0 0 0\nv 1e-300 0 0\nf 1 2 3\n").welded_vertices, 0u);
}

TEST_F(Obj, DropsVerticesThatNoFaceUses) {
  const ObjMesh obj = load_good("v 7 7 7\nv 0 0 0\nv 9 9 9\nv 1 0 0\nv 0 1 0\nf 2 4 5\n");
  EXPECT_EQ(obj.unused_vertices, 2u);
  EXPECT_EQ(obj.welded_vertices, 0u);
  ASSERT_EQ(obj.mesh.vertex_m.size(), 3u);
  EXPECT_EQ(obj.mesh.vertex_m[1], (Vec3{0.001, 0, 0}));
}

TEST_F(Obj, ScalesFileUnitsToMetres) {
  for (const double unit_m : {0.001, 0.01, 1.0}) {
    const auto obj = load(kCubeVertices + kCubeFaces, unit_m);
    ASSERT_TRUE(obj.has_value());
    EXPECT_NEAR(summarize(obj->mesh).volume_m3 / (1e3 * unit_m * unit_m * unit_m), 1.0, 1e-12);
    EXPECT_DOUBLE_EQ(summarize(obj->mesh).high_m.x, 10.0 * unit_m);
  }
}

TEST_F(Obj, RefusesAUnitThatIsNoLength) {
  for (const double unit_m : {0.0, -0.001, 1e9, 1e-300, std::nan(""), HUGE_VAL})
    EXPECT_FALSE(load(kCubeVertices + kCubeFaces, unit_m).has_value());
}

TEST_F(Obj, TurnsAClosedSurfaceWithInwardNormalsInsideOut) {
  EXPECT_FALSE(load_good(kCubeVertices + kCubeFaces).flipped);
  // A mirrored cube is wound the other way round.
  std::string mirrored = kCubeVertices;
  for (std::size_t at = 0; (at = mirrored.find("v 10", at)) != std::string::npos; ++at)
    mirrored.replace(at, 4, "v -10");
  const ObjMesh obj = load_good(mirrored + kCubeFaces);
  EXPECT_TRUE(obj.flipped);
  EXPECT_NEAR(summarize(obj.mesh).volume_m3, 1e-6, 1e-18);
  const Vec3 middle_m{-0.005, 0.005, 0.005};
  const SurfaceMesh remade = *make_surface_mesh(obj.mesh.vertex_m, obj.mesh.triangle);
  EXPECT_EQ(obj.mesh.neighbour, remade.neighbour);
  EXPECT_EQ(obj.mesh.fan, remade.fan);
  for (std::size_t t = 0; t < 12; ++t) {
    EXPECT_NEAR(norm(obj.mesh.face_normal[t] - remade.face_normal[t]), 0.0, 1e-12);
    const Vec3& corner_m = obj.mesh.vertex_m[obj.mesh.triangle[t][0]];
    EXPECT_GT(dot(obj.mesh.face_normal[t], corner_m - middle_m), 0.0);
  }
  for (std::size_t v = 0; v < 8; ++v)
    EXPECT_NEAR(norm(obj.mesh.vertex_normal[v] - remade.vertex_normal[v]), 0.0, 1e-12);
}

TEST_F(Obj, LeavesAnOpenSurfaceAsItIsWound) {
  const ObjMesh obj = load_good("v 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\n");
  EXPECT_FALSE(obj.flipped);
  EXPECT_EQ(obj.mesh.face_normal[0], (Vec3{0, 0, -1}));
  EXPECT_EQ(summarize(obj.mesh).boundary_edges, 3u);
}

TEST_F(Obj, ReadsWhatExportersWrite) {
  expect_cube(kCubeVertices + kCubeFaces);
  expect_cube("\xEF\xBB\xBF# byte order mark, tabs, blank and indented lines\n\n \t\n" +
              kCubeVertices + "  \t f\t1  4 3 \t\n" + kCubeFaces.substr(8));
  expect_cube(kCubeVertices + kCubeFaces.substr(0, kCubeFaces.size() - 1));  // no last line end
  expect_cube(kCubeVertices + "f 1 4 3 # why not\nfo 1 3 2\n" + kCubeFaces.substr(16));
  expect_cube(kCubeVertices + "f \\\n1 4 \\\r\n 3\n" + kCubeFaces.substr(8));  // continued
  expect_cube("mtllib C:\\my meshes\\\nusemtl caf\xE9 #1\ng\ng a b\ns 1\n# ends in \\\n" +
              kCubeVertices + "curv 0 1 \\\n 2 3\nl 1 2\nvp 0 1\nvt 0.5 0,5\nvn 0 0 1\n" +
              kCubeFaces);
  expect_cube(kCubeFaces + kCubeVertices);  // faces above their vertices
}

TEST_F(Obj, ReadsOldLineEnds) {
  std::string text = kCubeVertices + kCubeFaces;
  std::replace(text.begin(), text.end(), '\n', '\r');
  expect_cube(text);
}

TEST_F(Obj, ToleratesWeightsAndColours) {
  for (const std::string extra : {" 1.0", " 0.5 0.5 0.5", " 1 0.1 0.2 0.3", " 255 0 0 255"}) {
    std::string text;
    for (const char c : kCubeVertices) text += c == '\n' ? extra + "\n" : std::string(1, c);
    expect_cube(text + kCubeFaces);
  }
}

TEST_F(Obj, CutsQuadsAndConcavePolygons) {
  expect_cube(kCubeVertices + "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  // An L of area 7: a fan from its first corner would overlap itself.
  const ObjMesh ell =
      load_good("v 4 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\nv 0 0 0\nv 4 0 0\nf 1 2 3 4 5 6\n");
  EXPECT_EQ(ell.mesh.triangle.size(), 4u);
  EXPECT_NEAR(summarize(ell.mesh).area_m2, 7e-6, 1e-18);
}

TEST_F(Obj, AcceptsAQuadThatWeldingMakesATriangle) {
  // The pole of a globe made of quads: corners 1 and 2 are at one place.
  const ObjMesh obj = load_good("v 0 0 1\nv 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 2 4 3\n");
  EXPECT_EQ(obj.mesh.triangle.size(), 1u);
  expect_error("v 0 0 1\nv 1 0 0\nv 0 1 0\nf 1 1 2 3\n", 4, "same corner twice");  // not by welding
}

TEST_F(Obj, NamesBothFacesOfABrokenEdge) {
  const auto obj = load_obj(tests::bad_directory() + "p11_nonmanifold_edge.obj", kMillimetre_m);
  ASSERT_FALSE(obj.has_value());
  EXPECT_NE(obj.error().message.find("edge 1-2, see line 6"), std::string::npos);
  std::string faces = kCubeFaces;
  std::swap(faces[2], faces[4]);  // f 4 1 3
  expect_error(kCubeVertices + faces, 10, "faces the other way");
}

TEST_F(Obj, NamesTheLineOfAPolygonWhoseTriangleIsBad) {
  expect_error(kCubeVertices + "f 5 6 7 8\nv 20 0 0\nv 30 0 0\nv 40 0 0\nf 1 2 9 10 11\n", 13,
               "zero area");
  expect_error(kCubeVertices + "f 1 2 3 4\nf 5 6 7 8\nf 4 3 2 1\nf 1 2 3 4\n", 12, "one too many");
}

TEST_F(Obj, SpeaksOfVerticesAsTheFileCountsThem) {
  // Four unused or welded vertices stand before those of the edge.
  const std::string text = "v 9 9 9\nv 0 0 0\nv 0 0 0\nv 8 8 8\nv 1 0 0\nv 0 1 0\nv 0 -1 0\n";
  expect_error(text + "f 3 5 6\nf 2 5 7\n", 9, "edge 2-5, see line 8");
}

TEST_F(Obj, MissingIrregularOrLockedFileIsRefused) {
  const auto message = [](const std::string& path) {
    const auto obj = load_obj(path, kMillimetre_m);
    return obj ? "loaded" : obj.error().message;
  };
  EXPECT_EQ(message(temp_.path() + "/none.obj"),
            temp_.path() + "/none.obj: no such file; name an OBJ file of at most 2 GB");
  EXPECT_EQ(message(temp_.path()),
            temp_.path() + ": this is a directory; name an OBJ file of at most 2 GB");
  EXPECT_NE(message("/dev/zero").find("not a regular file"), std::string::npos);
  EXPECT_NE(message(temp_.write("a.obj", "") + "/b.obj").find("Not a directory"),
            std::string::npos);
  EXPECT_NE(message(std::string(300, 'x')).find("File name too long"), std::string::npos);
  const std::string locked = temp_.write("locked.obj", kCubeVertices);
  std::filesystem::permissions(locked, std::filesystem::perms::none);
  constexpr uid_t kOther = 65534;
  const bool root = geteuid() == 0;  // may read everything, so it becomes another user
  if (root) ASSERT_EQ(seteuid(kOther), 0);
  EXPECT_TRUE(message(locked).find("cannot be opened") != std::string::npos ||
              message(locked).find("Permission denied") != std::string::npos)
      << message(locked);
  if (root) ASSERT_EQ(seteuid(0), 0);
}

TEST_F(Obj, RefusesAHugeFileBeforeReadingIt) {
  const std::string path = temp_.write("huge.obj", kCubeVertices);
  std::filesystem::resize_file(path, kMaxObjBytes + 1);  // sparse: takes no room
  const auto obj = load_obj(path, kMillimetre_m);
  ASSERT_FALSE(obj.has_value());
  EXPECT_EQ(obj.error().message,
            path + ": larger than 2000000000 bytes; name an OBJ file of at most 2 GB");
}

TEST_F(Obj, DoesNotListenToTheLocale) {
  const tests::CommaLocale comma(temp_.path());
  expect_cube(
      "v 0.0 0 0\nv 10.0 0 0\nv 10 10 0\nv 0 10 0\nv 0 0 10\nv 10 0 10\nv 10 10 10\n"
      "v 0 10 10\n" +
      kCubeFaces);
  expect_error("v 0,5 0 0\n", 1, "'0,5' has a decimal comma; export with decimal points");
}

TEST_F(Obj, AFileCutAnywhereLoadsOrGivesOneLine) {
  const std::string text =
      "# cube\r\nv 0 0 0\nv 10 0 0 1\nv 1e1 10. 0\nv 0 +10 0\nv 0 0 10\n"
      "v 10 0 10\nv 10 10 10\nv 0 10 10\ng x\ns off\n"
      "f 1/1/1 4//1 -6/3\nf 1 3 2\nf 5 6 7 8\nf 1 2 6 \\\n 5\n" +
      kCubeFaces.substr(48);
  int loaded = 0;
  for (std::size_t length = 0; length <= text.size(); ++length) {
    const auto obj = load(text.substr(0, length));
    if (obj) {
      ++loaded;
      EXPECT_GE(obj->mesh.triangle.size(), 1u);
    } else {
      EXPECT_EQ(obj.error().message.find('\n'), std::string::npos);
      EXPECT_EQ(obj.error().message.find(temp_.path() + "/m.obj:"), 0u);
    }
  }
  EXPECT_GT(loaded, 10);
}

TEST_F(Obj, AColourStaysWithItsVertexWhereOthersAreWeldedOrUnused) {
  // The second lies at the first, no face names the third.
  const auto obj =
      load("v 0 0 0 1 0 0\nv 0 0 0 0 0 0\nv 9 9 9 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 2 4 5\n");
  ASSERT_TRUE(obj);
  EXPECT_EQ(obj->vertex_color, (std::vector<Rgb>{{255, 0, 0}, {0, 255, 0}, {0, 0, 255}}));
  EXPECT_TRUE(load(kCubeVertices + kCubeFaces)->vertex_color.empty());
}

TEST_F(Obj, AFileWithOneByteChangedLoadsOrGivesOneLine) {
  const std::string text = kCubeVertices + kCubeFaces;
  for (std::size_t at = 0; at < text.size(); at += 3) {
    for (const char c : {'\0', '\n', ' ', '-', '/', '\\', '9', '#', 'v', '\xFF'}) {
      std::string changed = text;
      changed[at] = c;
      const auto parsed = load(changed);
      if (!parsed) EXPECT_EQ(parsed.error().message.find('\n'), std::string::npos);
    }
  }
}

}  // namespace tact::model::mesh::obj_test
