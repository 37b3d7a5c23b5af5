// SPDX-License-Identifier: Apache-2.0
// A scene file is read to the letter: what it says is what the loop gets, and what it may not say
// is reported with its line.
#include "model/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta.h"
#include "model/indent/rhombus_patch.h"
#include "model/scene/compliance_file.h"
#include "tests/support/compliance_map.h"

namespace tact::model::scene::scene_test {

const std::string kData = TACT_SOURCE_DIR "/tests/data/scenes/";
const std::string kPlain = kData + "plain.toml";
const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

using Overrides = std::vector<std::string>;

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The error of a scene, without the folder of the file; "" where it loads.
std::string complaint(const std::string& path, const Overrides& overrides = {}) {
  const Result<Scene> scene = hal::registry::load_scene(path, overrides);
  if (scene) return "";
  const std::string& message = scene.error().message;
  EXPECT_EQ(message.find('\n'), message.npos) << "one line: " << message;
  EXPECT_NE(message.find("; "), message.npos) << "says what is wrong; what is right: " << message;
  const std::string folder = std::filesystem::path(path).parent_path().string() + "/";
  return message.starts_with(folder) ? message.substr(folder.size()) : message;
}

/// The plain scene with one text exchanged, in a file of its own.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = text_of(kPlain);
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  if (at != text.npos) text.replace(at, from.size(), to);
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::string path = std::string(TACT_BINARY_DIR) + "/scene_" + info->name() + ".toml";
  std::ofstream(path) << text;
  return path;
}

std::string name_of(const std::string& path) { return std::filesystem::path(path).filename(); }

TEST(Scene, HasWhatItsFileSays) {
  const Result<Scene> scene = hal::registry::load_scene(kPlain, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->path, kPlain);
  EXPECT_EQ(scene->name, "plain");
  EXPECT_EQ(scene->rate_Hz, 1000.0);
  EXPECT_EQ(scene->law, "rhombus");
  auto& chain = scene->laws.of<indent::RhombusParameters>().chain;
  EXPECT_EQ(chain.rod_length_m, 0.005);
  EXPECT_EQ(chain.initial_angle_rad, 0.5236);
  EXPECT_EQ(chain.normal_stiffness_N_per_m, 150.0);
  EXPECT_EQ(chain.tangential_stiffness_N_per_m, 180.0);
  EXPECT_EQ(chain.growth, 2.0);
  EXPECT_EQ(chain.units, 10u);
  ASSERT_EQ(scene->tool.spheres.size(), 1u);
  EXPECT_EQ(scene->tool.spheres[0].offset_m, (Vec3{0, 0, 0.001}));
  EXPECT_EQ(scene->tool.spheres[0].radius_m, 0.004);
  EXPECT_EQ(scene->contact.friction_ratio, 0.4);
  EXPECT_EQ(scene->contact.sliding_stiffness_N_per_m, 100.0);
  EXPECT_EQ(scene->contact.tear_force_N, 0.6);
  EXPECT_EQ(scene->device.kind, "sim-delta");
  EXPECT_EQ(scene->device.of<hal::sim::SimDeviceSettings>().counts_per_turn, 100000.0);
  EXPECT_EQ(scene->device.of<hal::sim::SimDeviceSettings>().sample_delay_s, 0.0005);
  EXPECT_EQ(scene->device.of<hal::sim::SimDeviceSettings>().joint_friction_Nm, 0.01);
  EXPECT_EQ(scene->device.of<hal::sim::SimDeviceSettings>().joint_damping_Nms_per_rad, 0.02);
  EXPECT_EQ(scene->device.of<hal::sim::SimDeviceSettings>().observer_bandwidth_Hz, 40.0);
  EXPECT_EQ(scene->hand.mass_kg, 0.15);
  EXPECT_EQ(scene->hand.stiffness_N_per_m, 600.0);
  EXPECT_EQ(scene->hand.damping_Ns_per_m, 15.0);
  EXPECT_FALSE(scene->hand.repeat);
  EXPECT_EQ(scene->limits.force_N, 8.0);
  EXPECT_EQ(scene->limits.torque_Nm, 0.2);
  EXPECT_EQ(scene->limits.slew_N_per_s, 1000.0);
  EXPECT_EQ(scene->limits.ramp_s, 0.5);
  EXPECT_EQ(scene->limits.workspace_radius_m, 0.18);
  EXPECT_EQ(scene->limits.workspace_half_length_m, 0.15);
  EXPECT_EQ(scene->frame_rate_Hz, 60.0);
}

TEST(Scene, FillsInDefaults) {
  const Result<Scene> scene = hal::registry::load_scene(kPlain, {});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->table_knots, 65u);
  EXPECT_EQ(scene->contact.grip_close_ratio, 0.7);
  EXPECT_EQ(scene->contact.grip_open_ratio, 0.5);
}

TEST(Scene, BringsItsMeshesInMetresAndTheOrganWhereItLies) {
  const Result<Scene> scene = hal::registry::load_scene(kPlain, {"tool.mesh_unit_m=0.0001"});
  ASSERT_TRUE(scene) << scene.error().message;
  const mesh::MeshSummary organ = summarize(scene->organ_mesh), tool = summarize(scene->tool_mesh);
  EXPECT_EQ(organ.triangles, 12u);
  EXPECT_NEAR(organ.low_m.z, -0.04, 1e-15) << "a box of 40 mm, 20 mm below the origin of W";
  EXPECT_NEAR(organ.high_m.z, 0.0, 1e-15);
  EXPECT_NEAR(tool.high_m.x, 0.002, 1e-15) << "a box of 4 mm about the tool's origin";
  EXPECT_NEAR(tool.low_m.x, -0.002, 1e-15);
  EXPECT_EQ(scene->organ.mesh_path, kData + "box.obj");
}

TEST(Scene, FindsItsMeshesFromItsOwnFolder) {
  const auto here = std::filesystem::current_path();
  std::filesystem::current_path(kData);
  const Result<Scene> scene = hal::registry::load_scene("plain.toml", {});
  std::filesystem::current_path(here);
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->organ.mesh_path, kData + "box.obj");
}

// Each file says in its first line what must be said of it: "# line: start of the message".
TEST(Scene, RefusesEveryBadFileWithItsLineAndWhatIsAllowed) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kData + "bad")) {
    const std::string text = text_of(entry.path());
    const std::string expected = text.substr(2, text.find('\n') - 2);
    const std::string said = complaint(entry.path());
    EXPECT_TRUE(said.starts_with(name_of(entry.path()) + ":" + expected))
        << "said: " << said << "\nwant: " << expected;
    ++files;
  }
  EXPECT_GE(files, 40);
}

TEST(Scene, NamesTheMissingKeyAndTheLineOfItsSection) {
  EXPECT_EQ(complaint(edited("friction_ratio = 0.4\n", "")),
            "scene_NamesTheMissingKeyAndTheLineOfItsSection.toml:20: contact.friction_ratio is "
            "missing; allowed: 0 .. 2");
  EXPECT_EQ(complaint(edited("height_m = 0.008\n", "")),
            "scene_NamesTheMissingKeyAndTheLineOfItsSection.toml:63: hand.stroke.4.height_m is "
            "missing; allowed: 0 .. 0.1 m");
}

TEST(Scene, RefusesALawThatItDoesNotDescribe) {
  const std::string said = complaint(edited("law = \"rhombus\"", "law = \"hex_sheet\""));
  EXPECT_NE(said.find("law = \"hex_sheet\" has no section [hex_sheet]; write it or choose another"),
            said.npos)
      << said;
  const std::string varies =
      complaint(edited("law = \"rhombus\"", "law = \"rhombus\"\nvaries_by_place = true"));
  EXPECT_NE(varies.find("varies_by_place = true needs a section [compliance]"), varies.npos)
      << varies;
}

TEST(Scene, RefusesKeysThatContradictEachOther) {
  const std::string name = "scene_RefusesKeysThatContradictEachOther.toml";
  EXPECT_EQ(complaint(edited("tear_force_N = 0.6", "tear_force_N = 0.6\ngrip_close_ratio = 0.4")),
            name +
                ":20: contact.grip_open_ratio = 0.5 must be below grip_close_ratio = 0.4; "
                "lower it or raise grip_close_ratio");
  EXPECT_EQ(complaint(edited("-0.5", "0.0")),
            name + ":48: hand.inward has no direction; allowed: any length but 0");
}

TEST(Scene, MissingIrregularOrLargeFileIsRefused) {
  EXPECT_EQ(complaint(kData + "none.toml"),
            "none.toml: no such file; give the path of a scene, such as model/scenes/liver.toml");
  EXPECT_TRUE(
      complaint(TACT_SOURCE_DIR "/tests/data")
          .ends_with(
              "this is a directory; give the path of a scene, such as model/scenes/liver.toml"));
  EXPECT_TRUE(
      complaint("/dev/null")
          .ends_with("this is a device, not a regular file; give the path of a scene, such as "
                     "model/scenes/liver.toml"));
  EXPECT_EQ(complaint(""),
            ": no such file; give the path of a scene, such as "
            "model/scenes/liver.toml");
  const std::string large = std::string(TACT_BINARY_DIR) + "/scene_large.toml";
  std::ofstream(large) << std::string(1'000'001, '#');
  EXPECT_EQ(complaint(large),
            "scene_large.toml: larger than 1000000 bytes; give the path of a scene, such as "
            "model/scenes/liver.toml");
}

TEST(Scene, MissingMeshIsReportedAtTheLineThatNamesIt) {
  EXPECT_EQ(complaint(kPlain, {"organ.mesh=no.obj"}),
            "--set organ.mesh=no.obj: " + kData +
                "no.obj is no file; name an OBJ file, absolute or from the folder of the scene");
  const std::string path = edited("\"box.obj\"", "\"no.obj\"");
  EXPECT_EQ(complaint(path),
            name_of(path) + ":13: " + std::string(TACT_BINARY_DIR) +
                "/no.obj is no file; name an OBJ file, absolute or from the folder of the scene");
  // A mesh that is broken complains for itself.
  EXPECT_TRUE(complaint(kPlain, {"organ.mesh=plain.toml"}).starts_with("plain.toml:"));
}

TEST(Scene, HashChangesWithTheTextAndWithEachOverride) {
  const auto hash = [](const std::string& path, const Overrides& overrides) {
    const Result<Scene> scene = hal::registry::load_scene(path, overrides);
    EXPECT_TRUE(scene) << scene.error().message;
    return scene ? scene->hash : "";
  };
  const std::string plain = hash(kPlain, {});
  EXPECT_TRUE(std::regex_match(plain, std::regex("[0-9a-f]{16}"))) << plain;
  EXPECT_EQ(plain, hash(kPlain, {}));
  EXPECT_NE(plain, hash(kPlain, {"rate_Hz=1000"}));
  EXPECT_NE(hash(kPlain, {"rate_Hz=1000"}), hash(kPlain, {"rate_Hz=2000"}));
  EXPECT_NE(plain, hash(kLiver, {}));
}

TEST(Scene, HashChangesWithTheComplianceMapInUse) {
  const std::string path = std::string(TACT_BINARY_DIR) + "/scene_hash.compliance";
  const auto own = hal::registry::load_scene(kLiver, {});
  ASSERT_TRUE(own) << own.error().message;
  const auto hash = [&](float compliance, const std::string& law) {
    const tissue::ComplianceMap map{.poisson_ratio = 0.45,
                                    .patch_radius_m = 0.008,
                                    .ring_pitch_m = 0.002,
                                    .rings = 1,
                                    .mesh_hash = surface_hash(own->organ_mesh.view()),
                                    .regular_times_E_per_m = {compliance},
                                    .sideways_times_E_per_m = {{1.0F, 2.0F, 3.0F, 4.0F}},
                                    .ring_times_E_per_m = {1.0F}};
    EXPECT_GT(tests::write_compliance_map(map, path), 0u);
    const auto scene = hal::registry::load_scene(kLiver, {"compliance.map=" + path, law});
    EXPECT_TRUE(scene) << scene.error().message;
    return scene ? scene->hash : "";
  };
  for (const char* rendered :
       {"law=compliance", "varies_by_place=true", "law=spring_patch", "law=auto"}) {
    EXPECT_EQ(hash(40.0F, rendered), hash(40.0F, rendered));
    EXPECT_NE(hash(40.0F, rendered), hash(40.1F, rendered)) << rendered;
  }
  EXPECT_EQ(hash(40.0F, "varies_by_place=false"), hash(40.1F, "varies_by_place=false"));
}

TEST(Scene, ComplianceMapOfAnotherOrganIsIgnoredWithANote) {
  const auto own = hal::registry::load_scene(kLiver, {});
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_TRUE(own->varies_by_place);
  EXPECT_EQ(own->note, "");
  const auto other = hal::registry::load_scene(kLiver, {"organ.mesh=meshes/heart_4002.obj"});
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_FALSE(other->varies_by_place);
  EXPECT_NE(other->note.find("is of another organ than"), std::string::npos) << other->note;
  EXPECT_NE(other->note.find("tact-lab condense " + kLiver), std::string::npos) << "the remedy";
  const auto unread = hal::registry::load_scene(kLiver, {"compliance.map=none.compliance"});
  ASSERT_TRUE(unread) << unread.error().message;
  EXPECT_TRUE(unread->varies_by_place) << "a file that is not there is an error of the law";
}

TEST(Scene, RefusesKeysThatDoNothing) {
  const std::string blade =
      complaint(kLiver, {"tool.blade.from_m=[0, 0, 0]", "tool.blade.to_m=[0, 0, 0.02]"});
  EXPECT_NE(blade.find("tool.blade cuts nothing with law = \"rhombus\"; write law = "), blade.npos)
      << blade;
  EXPECT_TRUE(hal::registry::load_scene(
      kLiver, {"law=spring_patch", "tool.blade.from_m=[0, 0, 0]", "tool.blade.to_m=[0, 0, 0.02]"}));
}

}  // namespace tact::model::scene::scene_test
