// SPDX-License-Identifier: Apache-2.0
// Fewer faces of a rough surface: what VTK leaves open or folded then is repaired, or refused.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "tests/support/mesh_files.h"
#include "tests/tools/mesh/scanned_organ.h"

namespace tact::tests::mesh_decimate_test {

using nlohmann::json;

class MeshDecimate : public testing::Test {
 protected:
  Ran run(const std::string& arguments) const { return run_apart(temp_, "tact-mesh", arguments); }

  TempDirectory temp_;
};

/// A closed ball of 60 mm whose radius differs by up to `noise` from vertex to vertex.
Soup rough_ball(int rows, double noise) {
  Soup ball{.vertex = {{0.0, 0.0, 30.0}, {0.0, 0.0, -30.0}}, .triangle = {}};
  const int columns = 2 * rows;
  std::uint32_t chance = 1;
  const auto at = [&](int row, int column) {
    return static_cast<std::uint32_t>(2 + (row - 1) * columns + column % columns);
  };
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      chance = 1664525u * chance + 1013904223u;
      const double off = noise * (2.0 * (chance >> 8) / 16777216.0 - 1.0);
      const double down = row * std::numbers::pi / rows, around = column * std::numbers::pi / rows;
      const double r = 30.0 * (1.0 + off);
      ball.vertex.push_back({r * std::sin(down) * std::cos(around),
                             r * std::sin(down) * std::sin(around), r * std::cos(down)});
    }
  for (int column = 0; column < columns; ++column) {
    ball.triangle.push_back({0, at(1, column), at(1, column + 1)});
    ball.triangle.push_back({1, at(rows - 1, column + 1), at(rows - 1, column)});
    for (int row = 1; row + 1 < rows; ++row) {
      ball.triangle.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
      ball.triangle.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
    }
  }
  return ball;
}

struct Rough {
  int rows;
  double noise;
  int faces;
};

// VTK's decimation leaves a hole in each of these.
constexpr Rough kRough[] = {{50, 0.005, 980},  {50, 0.01, 2940}, {50, 0.03, 3920},
                            {60, 0.005, 5664}, {60, 0.02, 4248}, {60, 0.03, 2832}};

TEST_F(MeshDecimate, AClosedScanStaysClosed) {
  for (const Rough& rough : kRough) {
    const std::string path = temp_.write("rough.stl", as_stl(rough_ball(rough.rows, rough.noise)));
    const Ran ran = run(fmt::format("--json {} --weld --decimate {}", path, rough.faces));
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json fewer = json::parse(ran.out);
    EXPECT_EQ(fewer["closed"], true) << rough.rows << " " << rough.noise;
    EXPECT_GT(fewer["triangles"].get<int>(), 0.95 * rough.faces);
    EXPECT_NEAR(fewer["volume_m3"].get<double>(), 1.131e-4, 0.02e-4);
  }
}

TEST_F(MeshDecimate, ASurfaceThatIsTooRoughForSoFewFacesIsRefused) {
  const std::string path = temp_.write("rougher.stl", as_stl(rough_ball(60, 0.2)));
  const Ran ran = run(path + " --weld --decimate 3000 --out " + temp_.path() + "/out.obj");
  EXPECT_EQ(ran.status, 2) << ran.out;
  EXPECT_NE(ran.err.find("too rough for 3000 faces"), std::string::npos) << ran.err;
  EXPECT_FALSE(std::filesystem::exists(temp_.path() + "/out.obj"));
}

}  // namespace tact::tests::mesh_decimate_test
