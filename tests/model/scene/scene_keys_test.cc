// SPDX-License-Identifier: Apache-2.0
// The format of a scene, its reference and the scene that ships agree.
#include "model/scene/scene_keys.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <sstream>

#include "hal/registry/open_device.h"
#include "model/reader/scene_text.h"
#include "model/scene/laws.h"
#include "model/scene/tissue.h"
#include "tests/support/extent.h"

namespace tact::model::scene::scene_keys_test {

const std::string kScenes = TACT_SOURCE_DIR "/model/scenes/", kLiver = kScenes + "liver.toml";
const std::string kDevices = TACT_SOURCE_DIR "/tools/deploy/devices.toml";

std::vector<reader::ReferenceRow> reference_rows() {
  SceneText text;
  reader::SceneVisit visit(nullptr);
  reader::Keys::visit_root(
      visit, [&](reader::Keys& root) { visit_scene(root, hal::registry::visit_device, text); });
  EXPECT_FALSE(visit.problem());
  return visit.rows();
}

/// Every key below a table as "section.key"; entries of an array of sections have no number.
void collect(const toml::table& table, const std::string& path, std::set<std::string>& keys) {
  for (auto&& [key, node] : table) {
    const std::string name = path + std::string(key.str());
    if (const toml::table* section = node.as_table())
      collect(*section, name + ".", keys);
    else if (node.is_array_of_tables())
      for (const toml::node& entry : *node.as_array()) collect(*entry.as_table(), name + ".", keys);
    else
      keys.insert(name);
  }
}

/// The liver's, with the keys that no shipped scene has.
std::string liver_with_the_rest() {
  std::ostringstream text;
  text << std::ifstream(kLiver).rdbuf() << R"(
[[live]]
key = "elastic.youngs_modulus_Pa"
[[elastic.inclusion]]
center_m = [0.01, 0.02, 0.03]
radius_m = 0.005
youngs_modulus_Pa = 5e4
)";
  const std::string path = testing::TempDir() + "liver_" + std::to_string(getpid()) + ".toml";
  std::ofstream(path) << text.str();
  return path;
}

std::set<std::string> keys_of_shipped_scenes() {
  std::set<std::string> keys;
  for (const std::string& path : {kLiver, kScenes + "heart.toml", kScenes + "skin.toml",
                                  kScenes + "gum.toml", kScenes + "maintenance.toml",
                                  kScenes + "liver_twist.toml", liver_with_the_rest(), kDevices}) {
    const Result<reader::SceneDocument> document = reader::load_scene_document(path, {});
    EXPECT_TRUE(document) << document.error().message;
    if (document) collect(document->root, "", keys);
  }
  keys.insert({"compliance.layer_thickness_m", "exact_tip"});  // of no shipped scene
  return keys;
}

TEST(SceneReference, HasEveryKeyOfTheShippedScenesAndTheyHaveEveryKey) {
  const std::set<std::string> shipped = keys_of_shipped_scenes();
  std::set<std::string> reference;
  for (const reader::ReferenceRow& row : reference_rows()) {
    const std::string section = row.section.empty() ? "" : row.section + ".";
    // laws_test.cc reads the section of a law that no shipped scene describes.
    const auto first = shipped.lower_bound(section);
    const bool is_shipped = first != shipped.end() && first->starts_with(section);
    if (!row.key.empty() && (is_shipped || !find_law(row.section)))
      reference.insert(section + row.key);
  }
  EXPECT_EQ(reference, shipped);
}

TEST(SceneReference, ASectionThatNoShippedSceneHasIsRead) {
  const auto scene =
      load_scene(liver_with_the_rest(), {"organ.mesh=" + kScenes + "meshes/liver_3116.obj",
                                         "tool.mesh=" + kScenes + "meshes/forceps_174.obj"});
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->live, std::vector<std::string>{"elastic.youngs_modulus_Pa"});
  const Inclusion& lump = scene->elastic->inclusions.at(0);
  EXPECT_EQ(norm(lump.center_m - Vec3{0.01, 0.02, 0.03}) + lump.radius_m, 0.005);
  EXPECT_EQ(lump.youngs_modulus_Pa, 5e4);
}

TEST(SceneReference, SaysOfEveryKeyWhatIsAllowedAndWhatItMeans) {
  for (const reader::ReferenceRow& row : reference_rows()) {
    EXPECT_FALSE(row.allowed.empty() || row.meaning.empty()) << row.section << "." << row.key;
    if (row.allowed.find(" .. ") == std::string::npos || row.key.empty()) continue;
    // A number without a unit is a ratio, a count, or one of these.
    const std::set<std::string> bare{"growth",    "inward",         "axis",
                                     "sphere",    "node",           "id",
                                     "exponent",  "exponent_slope", "softening_exponent",
                                     "direction", "motion_scale",   "reference_site",
                                     "relaxation"};
    const bool named = row.key.ends_with("_ratio") || row.allowed.ends_with("whole") ||
                       row.key.starts_with("counts_per_") || row.section == "device.lines" ||
                       bare.contains(row.key);
    EXPECT_EQ(io::unit_of(row.key).empty(), named) << row.section << "." << row.key;
  }
}

TEST(SceneReference, IsAPageWithEveryRow) {
  const std::string page = scene_reference(hal::registry::visit_device);
  for (const reader::ReferenceRow& row : reference_rows()) {
    const auto at = page.find(row.key.empty() ? "\n" + row.allowed : row.key + " ");
    EXPECT_NE(at, page.npos) << row.section << "." << row.key;
    EXPECT_NE(page.find(row.meaning), page.npos) << row.meaning;
  }
  EXPECT_NE(page.find("[contact]"), page.npos);
  EXPECT_NE(page.find("[[hand.stroke]]"), page.npos);
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 140u) << line;
}

TEST(Scene, CutAtAnyByteNeverCrashesAndSaysOneLine) {
  std::ifstream file(kLiver, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string path = std::string(TACT_BINARY_DIR) + "/scene_cut.toml";
  for (std::size_t length = 0; length < text.size(); length += 3) {
    std::ofstream(path, std::ios::binary) << text.substr(0, length);
    const Result<Scene> scene = hal::registry::load_scene(path, {});
    ASSERT_FALSE(scene) << "its meshes are not here, cut at " << length;
    ASSERT_TRUE(scene.error().message.starts_with(path + ":")) << scene.error().message;
    ASSERT_EQ(scene.error().message.find('\n'), std::string::npos) << scene.error().message;
  }
}

TEST(Scene, WithAnyByteSpoiltNeverCrashesAndSaysOneLine) {
  std::ifstream file(kLiver, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::string path = std::string(TACT_BINARY_DIR) + "/scene_spoilt.toml";
  const std::string spoilers = std::string("\0\xff\"'[]{}=.,-9e\n#_", 17);
  for (std::size_t i = 0; i < text.size(); i += 10 / tests::share_of(10, 10)) {
    std::string spoilt = text;
    spoilt[i] = spoilers[(7 * i) % spoilers.size()];
    std::ofstream(path, std::ios::binary) << spoilt;
    const Result<Scene> scene = hal::registry::load_scene(path, {});
    ASSERT_FALSE(scene) << "its meshes are not here, spoilt at " << i;
    ASSERT_EQ(scene.error().message.find('\n'), std::string::npos) << scene.error().message;
  }
}

/// Height of the surface above (x, y), by the highest triangle there.
double surface_z_m(const mesh::SurfaceMesh& mesh, double x_m, double y_m) {
  double highest_m = -std::numeric_limits<double>::infinity();
  for (const contact::TriangleCorners& t : mesh.triangle) {
    const Vec3 a = mesh.vertex_m[t[0]], u = mesh.vertex_m[t[1]] - a, v = mesh.vertex_m[t[2]] - a;
    const double area = u.x * v.y - u.y * v.x;
    if (!(std::fabs(area) > 0.0)) continue;
    const double s = ((x_m - a.x) * v.y - (y_m - a.y) * v.x) / area;
    const double r = (u.x * (y_m - a.y) - u.y * (x_m - a.x)) / area;
    if (s < 0.0 || r < 0.0 || s + r > 1.0) continue;
    highest_m = std::max(highest_m, a.z + s * u.z + r * v.z);
  }
  return highest_m;
}

class Liver : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(scene_) << scene_.error().message; }
  const Result<Scene> scene_ = load_scene(kLiver, {});
};

TEST_F(Liver, LoadsWithItsMeshes) {
  EXPECT_EQ(scene_->organ_mesh.vertex_m.size(), 3116u);
  EXPECT_EQ(scene_->organ_mesh.triangle.size(), 6228u);
  EXPECT_EQ(scene_->tool_mesh.vertex_m.size(), 174u);
  EXPECT_EQ(scene_->tool_mesh.triangle.size(), 348u);
}

TEST_F(Liver, LiesInTheWorkspaceWithItsTopAtTheTouchedPoint) {
  const mesh::MeshSummary organ = summarize(scene_->organ_mesh);
  EXPECT_LT(std::max(organ.high_m.x, -organ.low_m.x), scene_->limits.workspace_half_length_m);
  EXPECT_LT(std::hypot(organ.high_m.y, organ.low_m.z), scene_->limits.workspace_radius_m);
  EXPECT_NEAR(surface_z_m(scene_->organ_mesh, 0.0, 0.0), 0.0, 0.0005);
}

TEST_F(Liver, HasJawsWhereItsProbeSpheresAre) {
  // The tip of each jaw is inside its sphere.
  for (const contact::ProbeSphere& sphere : scene_->tool.spheres) {
    EXPECT_TRUE(std::ranges::any_of(scene_->tool_mesh.vertex_m, [&](const Vec3& v) {
      return norm(v - sphere.offset_m) <= sphere.radius_m;
    }));
  }
  EXPECT_GT(summarize(scene_->tool_mesh).high_m.z, 0.05) << "handle towards +z";
}

/// The tool of a scene over the origin, straight up and down.
class UpAndDown {
 public:
  explicit UpAndDown(const Scene& scene) : tissue_(std::move(*make_tissue(scene))) {
    contact_.emplace(tissue_->contact_scene());
    to(0.005);
  }
  /// The force on the tool there, N, up positive; depths below 0 are above the surface.
  double to(double depth_m, double grip_ratio = 0.0) {
    constexpr double kStep_m = 2e-5;
    const int steps = std::max(1, static_cast<int>(std::abs(depth_m - depth_m_) / kStep_m));
    double force_N = 0.0;
    for (int i = 1; i <= steps; ++i) {
      const double now_m = depth_m_ + (depth_m - depth_m_) * i / steps;
      const Tool tool{.position_m = {0, 0, -now_m}, .grip_ratio = grip_ratio};
      contact_->detect_contact(tool);
      force_N = contact_->render_force(tool, false).wrench.force_N.z;
    }
    depth_m_ = depth_m;
    return force_N;
  }
  /// A hand's spring wants the tool at this depth: the force where both are in balance.
  double wanted_N(double wanted_m, double hand_N_per_m, double grip_ratio) {
    const double step_m = wanted_m > depth_m_ ? 1e-4 : -1e-4;
    double force_N = to(depth_m_, grip_ratio);
    while ((hand_N_per_m * (wanted_m - depth_m_) - force_N) * step_m > 0.0)
      force_N = to(depth_m_ + step_m, grip_ratio);
    return force_N;
  }
  bool holds() const {
    return std::ranges::all_of(contact_->contacts(),
                               [](const contact::SphereContact& sphere_contact) {
                                 return sphere_contact.state == ContactState::kHeld;
                               });
  }

 private:
  std::unique_ptr<Tissue> tissue_;
  std::optional<contact::Contact> contact_;
  double depth_m_ = -0.01;
};

TEST_F(Liver, AHandleMovesTheToolsOriginAndNothingOfTheToolInTheRoom) {
  const Vec3 handle_m{0.0, 0.01, 0.093};
  const auto held = load_scene(kLiver, {"tool.handle_m=[0.0, 0.01, 0.093]"});
  ASSERT_TRUE(held) << held.error().message;
  ASSERT_EQ(held->hand.path.size(), scene_->hand.path.size());
  for (std::size_t i = 0; i < scene_->hand.path.size(); ++i)
    EXPECT_LT(norm(held->hand.path[i].position_m - scene_->hand.path[i].position_m - handle_m),
              1e-12);
  for (std::size_t i = 0; i < scene_->tool.spheres.size(); ++i)
    EXPECT_LT(norm(held->tool.spheres[i].offset_m + handle_m - scene_->tool.spheres[i].offset_m),
              1e-12);
  EXPECT_LT(norm(held->tool_mesh.vertex_m[7] + handle_m - scene_->tool_mesh.vertex_m[7]), 1e-12);
  EXPECT_NE(held->hash, scene_->hash);
}

TEST_F(Liver, TearsWhenItSaysTearAndHoldsWhenItSaysPull) {
  const double hand_N_per_m = scene_->hand.stiffness_N_per_m;
  UpAndDown pull(*scene_);
  const double pull_N = -0.5 * pull.wanted_N(-0.008, hand_N_per_m, 1.0);
  EXPECT_TRUE(pull.holds());
  EXPECT_NEAR(pull_N, 0.21, 0.005) << "the number in liver.toml";
  EXPECT_LT(pull_N, 0.8 * scene_->contact.tear_force_N);
  UpAndDown tear(*scene_);
  tear.to(-0.0120, 1.0);
  EXPECT_TRUE(tear.holds()) << "the number in liver.toml: 12.2 mm";
  tear.to(-0.0124, 1.0);
  EXPECT_FALSE(tear.holds());
  EXPECT_GT(hand_N_per_m * (0.025 - 0.0124), 2.0 * scene_->contact.tear_force_N);
  // Both jaws at the deepest press stay below the quarter of the limit that a slow PC may use.
  UpAndDown press(*scene_);
  EXPECT_LT(press.wanted_N(0.010, hand_N_per_m, 0.0), 0.5 * 0.25 * scene_->limits.force_N);
}

TEST_F(Liver, OneJawAloneHasTheForceOfTheScene) {
  Scene one = *scene_;
  one.tool.spheres = {one.tool.spheres[0]};
  one.tool.spheres[0].offset_m.y = 0.0;
  UpAndDown jaw(one);
  EXPECT_NEAR(jaw.to(0.001), 0.0129, 0.0003) << "the number in liver.toml";
  EXPECT_NEAR(jaw.to(0.010), 0.265, 0.003) << "the number in liver.toml";
}

TEST_F(Liver, RepeatsAScriptOfTwentySecondsFromHomeToHome) {
  const std::vector<HandWaypoint>& path = scene_->hand.path;
  EXPECT_TRUE(scene_->hand.repeat);
  EXPECT_NEAR(path.back().time_s, 20.0, 2.0);
  EXPECT_EQ(path.front().position_m, path.back().position_m);
  EXPECT_NEAR(path.front().position_m.z - surface_z_m(scene_->organ_mesh, 0.0, 0.0), 0.06, 0.001);
  EXPECT_EQ(path.back().grip_ratio, 0.0);
}

}  // namespace tact::model::scene::scene_keys_test
