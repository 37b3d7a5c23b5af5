// SPDX-License-Identifier: Apache-2.0
// Overrides are part of the scene: read as strictly, and reported by what was typed.
#include "model/reader/scene_document.h"

#include <gtest/gtest.h>

#include "hal/registry/open_device.h"
#include "model/scene/scene.h"

namespace tact::model::reader::scene_document_test {

const std::string kPlain = TACT_SOURCE_DIR "/tests/data/scenes/plain.toml";

std::string complaint(const std::vector<std::string>& overrides) {
  const Result<scene::Scene> scene = scene::load_scene(kPlain, overrides);
  if (scene) return "";
  EXPECT_EQ(scene.error().message.find('\n'), std::string::npos) << scene.error().message;
  return scene.error().message;
}

TEST(Override, SetsNumbersTextFlagsAndArrays) {
  const Result<scene::Scene> scene =
      hal::registry::load_scene(kPlain, {"rate_Hz=2000", "name=a word", "name=\"two words\"",
                                         "hand.repeat=true", "organ.position_m=[0.01, 0, -2e-2]",
                                         "table_knots=129", "device.kind=none/of-this.world"});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->rate_Hz, 2000.0);
  EXPECT_EQ(scene->name, "two words") << "the last one counts";
  EXPECT_TRUE(scene->hand.repeat);
  EXPECT_EQ(scene->organ.position_m, (Vec3{0.01, 0.0, -0.02}));
  EXPECT_EQ(scene->table_knots, 129u) << "a key the file leaves to its default";
  EXPECT_EQ(scene->device.kind, "none/of-this.world") << "a bare word is text";
}

TEST(Override, CountsByItsMeaningNotByItsSpelling) {
  const auto hash = [](const std::string& text) {
    const Result<SceneDocument> document = load_scene_document(kPlain, {text});
    return document ? document->hash : document.error().message;
  };
  EXPECT_EQ(hash("law=auto"), hash("law=\"auto\""));
  EXPECT_EQ(hash("rate_Hz=2000"), hash("rate_Hz= 2000"));
  EXPECT_NE(hash("law=auto"), hash("law=rhombus"));
  EXPECT_NE(hash("limits.force_N=2"), hash("device.force_N=2"));
}

TEST(Override, ReachesOneEntryOfAnArrayOfSections) {
  const Result<scene::Scene> plain = scene::load_scene(kPlain, {});
  const Result<scene::Scene> scene =
      scene::load_scene(kPlain, {"hand.stroke.1.duration_s=7", "tool.sphere.0.radius_m=0.003"});
  ASSERT_TRUE(plain && scene) << scene.error().message;
  EXPECT_EQ(scene->tool.spheres[0].radius_m, 0.003);
  EXPECT_NEAR(scene->hand.path.back().time_s - plain->hand.path.back().time_s, 5.0, 1e-12);
}

TEST(Override, ReplacesAWholeSectionOrArray) {
  const Result<scene::Scene> scene = scene::load_scene(
      kPlain,
      {"telemetry={frame_rate_Hz=30}", "hand.stroke=[]",
       "tool.sphere=[{offset_m=[0,0,0], radius_m=0.001}, {offset_m=[0,0,0], radius_m=0.002}]"});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->frame_rate_Hz, 30.0);
  EXPECT_EQ(scene->hand.path.size(), 1u) << "only home";
  EXPECT_EQ(scene->tool.spheres.size(), 2u);
}

struct Case {
  std::string text, said;
};

TEST(Override, MalformedOverrideIsQuotedAsTyped) {
  const std::string shape = "; write key.path=value, for example rhombus.units=8 or law=rhombus";
  const std::string values =
      "the value is not TOML; write a number, true, false, \"text\" or [1, 2, 3]";
  const Case cases[] = {
      {"rate_Hz", "there is no '='" + shape},
      {"=5", "the key is no key path" + shape},
      {".rate_Hz=5", "the key is no key path" + shape},
      {"a..b=5", "the key is no key path" + shape},
      {"rate Hz=5", "the key is no key path" + shape},
      {"rate_Hz=", values},
      {"rate_Hz=1 000", values},
      {"rate_Hz=10kHz", values},
      {"rate_Hz=1000 # fast", ""},
      {"rate_Hz=5", "rate_Hz = 5 is out of range; allowed: 100 .. 10000 Hz"},
      {"rate_Hz=nan", "rate_Hz = nan is not finite; allowed: 100 .. 10000 Hz"},
      {"rate_Hz=fast", "rate_Hz is text, not a number; allowed: 100 .. 10000 Hz"},
      {"rhombus.unit=5",
       "rhombus.unit is no key here; did you mean units? allowed: 1 .. 64, whole"},
      {"hand.stroke.0.depth_mm=9",
       "hand.stroke.0.depth_mm has the wrong unit; write depth_m, allowed: 0 .. 0.05 "
       "m"},
      {"hnad.mass_kg=1", "hnad is no key here; did you mean hand? allowed: a section [hand]"},
      {"organ=5", "organ is a number, not a section; allowed: a section [organ]"},
      {"organ.mesh.x=5", "mesh is a value, not a section; set it without a dot"},
      {"hand.stroke.7.depth_m=0", "no entry 7 here; the scene has 7, counted from 0"},
      {"hand.stroke.-1.depth_m=0", "no entry -1 here; the scene has 7, counted from 0"},
      {"hand.stroke.first.depth_m=0", "no entry first here; the scene has 7, counted from 0"},
      {"hand.home_m.2=0.05",
       "one element of an array cannot be set alone; set the whole array, or one key of an entry "
       "as in hand.stroke.0.duration_s=1"},
      {"limits.energy_J=0.02",
       "limits.energy_J = 0.02 is too little to let go of force_N = 8 at speed_mps = 1.5; allowed: "
       "0.071 or more, or a lower speed_mps"},
      {"limits.speed_mps=9",
       "limits.energy_J = 0.1 is too little to let go of force_N = 8 at speed_mps = 9; allowed: "
       "0.375 or more, or a lower speed_mps"},
      {"limits.continuous_force_N=0.5",
       "limits.thermal_time_s = 10 is too short to come from force_N = 8 to continuous_force_N = "
       "0.5 within the slew; allowed: 33.171 or more"},
      {"limits.slew_N_per_s=700",
       "limits.slew_N_per_s = 700 is too slow for force_N = 8: a lost device must ramp down in "
       "10 ms; allowed: 816 or more"},
      {"contact.grip_open_ratio=0.9",
       "contact.grip_open_ratio = 0.9 must be below grip_close_ratio = 0.7; lower it or raise "
       "grip_close_ratio"},
      {"contact.grip_close_ratio=0.3",
       "contact.grip_open_ratio = 0.5 must be below grip_close_ratio = 0.3; lower it or raise "
       "grip_close_ratio"},
      {"hand.stroke.0.action=stab",
       "hand.stroke.0.action = \"stab\" is unknown; allowed: \"press\", \"hold\", \"slide\", "
       "\"release\", \"grip\", \"pull\", \"tear\", \"turn\""},
  };
  for (const Case& c : cases)
    EXPECT_EQ(complaint({c.text}), c.said.empty() ? "" : "--set " + c.text + ": " + c.said);
}

// The first of the allowed ones: a new law is no change of this test.
TEST(Override, UnknownSectionIsRefusedWithTheKnownOnes) {
  EXPECT_TRUE(complaint({"a.b.c=1"})
                  .starts_with("--set a.b.c=1: a is no key here; allowed here: name, rate_Hz, "
                               "table_knots, varies_by_place, exact_tip, "
                               "law, rhombus, "));
}

TEST(Override, CannotSmuggleInASecondKey) {
  EXPECT_EQ(complaint({"rate_Hz=1000\nname='x'"}),
            "--set rate_Hz=1000 name='x': the value has more than one line; write key.path=value, "
            "for example rhombus.units=8 or law=rhombus");
}

TEST(Override, OverrideErrorIsReportedBeforeErrorsOfTheFile) {
  const std::string bad = TACT_SOURCE_DIR "/tests/data/scenes/bad/too_small.toml";
  const Result<scene::Scene> scene = scene::load_scene(bad, {"limits.force_N=99"});
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().message,
            "--set limits.force_N=99: limits.force_N = 99 is out of range; allowed: 0 .. 20 N");
}

TEST(SceneDocument, MeshFileIsRefusedWithTheNewSceneCommand) {
  for (const char* mesh : {"kidney.stl", "kidney.obj", "kidney.glb"}) {
    const Result<SceneDocument> document = load_scene_document(mesh, {});
    ASSERT_FALSE(document);
    EXPECT_EQ(document.error().message,
              std::string(mesh) + ": is a mesh, no scene; make one of it: tact-lab new-scene " +
                  mesh + " --out mine.toml");
  }
}

TEST(SceneDocument, KnowsTheLineOfEveryNode) {
  const Result<SceneDocument> document = load_scene_document(kPlain, {"rhombus.units=8"});
  ASSERT_TRUE(document) << document.error().message;
  const toml::table& root = document->root;
  EXPECT_EQ(document->position_of(*root.get("rate_Hz")).line, 3u);
  EXPECT_EQ(document->position_of(*root.get("rate_Hz")).where, kPlain + ":3");
  EXPECT_EQ(document->position_of(*root["rhombus"].node()).line, 5u);
  EXPECT_EQ(document->position_of(*root["rhombus"]["growth"].node()).line, 10u);
  EXPECT_EQ(document->position_of(*root["rhombus"]["units"].node()).where, "--set rhombus.units=8");
}

}  // namespace tact::model::reader::scene_document_test
