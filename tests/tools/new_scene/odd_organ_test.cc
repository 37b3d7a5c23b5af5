// SPDX-License-Identifier: Apache-2.0
// tact-lab new-scene with an organ that is thin or hollow.
#include <gtest/gtest.h>

#include "tests/tools/new_scene/new_scene_fixture.h"

namespace tact::tools::new_scene::new_scene_test {

TEST_F(NewScene, AThinOrganEndsInASceneWithATearThatItsTissueReaches) {
  for (const double thick_mm : {8.0, 4.0}) {
    SurfaceMesh plate = tests::make_ball(1.0, 3);
    // A flat lens, 100 x 80 mm.
    for (Vec3& p : plate.vertex_m) p = {50.0 * p.x, 40.0 * p.y, thick_mm / 2.0 * p.z};
    const Ran ran = run(temp_.write("flap.obj", as_obj(plate)) + " --force --out " + out_);
    ASSERT_EQ(ran.status, 0) << thick_mm << ": " << ran.err;
    EXPECT_EQ(tests::run_program("tactd", out_ + " --check").status, 0);
  }
}

TEST_F(NewScene, CavityInsideAnOrganIsRefusedUntilItIsFilled) {
  // An ellipsoid with a cavity of half its size, turned inwards.
  SurfaceMesh shell = ellipsoid_mm(3);
  const auto first = static_cast<std::uint32_t>(shell.vertex_m.size());
  const Vec3 middle{12.0, -205.0, 1310.0};
  const SurfaceMesh outer = shell;
  for (const Vec3& p : outer.vertex_m) shell.vertex_m.push_back(middle + 0.5 * (p - middle));
  for (const auto& t : outer.triangle)
    shell.triangle.push_back({t[0] + first, t[2] + first, t[1] + first});
  const std::string organ = temp_.write("bladder.obj", as_obj(shell));
  Ran ran = run(organ + " --out " + out_);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("inside of the largest part lies one of 12% of its volume: a cavity"),
            ran.err.npos)
      << ran.err;
  EXPECT_EQ(made(), std::vector<std::string>{});
  // What it says to do works.
  const std::string full = path("full.obj");
  const tests::Outcome filled =
      tests::run_program("tact-mesh", organ + " --weld --largest --out " + full);
  ASSERT_EQ(filled.status, 0) << filled.output;
  EXPECT_NE(filled.output.find("inside of it 12%, now filled"), filled.output.npos);
  ran = run(full + " --out " + out_ + " --without-map");
  EXPECT_EQ(ran.status, 0) << ran.err;
}

}  // namespace tact::tools::new_scene::new_scene_test
