// SPDX-License-Identifier: Apache-2.0
// Deep presses into every shipped organ, at random places: nothing falls through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/indent/compliance_law.h"
#include "model/law/relaxation.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/sentence.h"

namespace tact::model::scene::deep_press_test {

constexpr double kTick_s = 1e-3, kBefore_m = 6_mm, kDeep_m = 60_mm, kRadius_m = 4_mm;
constexpr double kRange_m = 12_mm;  // of the law
constexpr double kOverARim = 0.5;   // cosine of two normals

bool is_long() { return std::getenv("TACT_LONG") != nullptr; }

/// A shipped organ of one elastic law, which may relax and rub; no cutting.
struct Organ {
  explicit Organ(const char* name, bool rubs = false) {
    auto loaded = load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(name) + ".toml", {});
    EXPECT_EQ(tests::sentence_of(loaded), "");
    scene = std::move(*loaded);
    tree = contact::make_triangle_tree(scene.organ_mesh.view());
    if (!rubs) return;
    parameters.friction_ratio = 0.4;
    parameters.sliding_stiffness_N_per_m = 20.0;
    const std::vector<law::PronyTerm> terms{{.share = 0.3, .time_s = 0.2},
                                            {.share = 0.3, .time_s = 2.0}};
    field = tissue::ElasticField({.curves = {&law, 1},
                                  .coordinate = {},
                                  .pull_coordinate = {},
                                  .surface = {},
                                  .relaxation = *law::make_relaxation(terms, kTick_s)});
  }
  contact::ContactScene contact_scene() {
    return {.law = &field,
            .parameters = parameters,
            .spheres = spheres,
            .surface = scene.organ_mesh.view(),
            .tree = tree.view(),
            .blade = {}};
  }
  Scene scene;
  contact::TriangleTree tree;
  contact::ContactParameters parameters{.tear_force_N = 1.0};
  std::vector<contact::ProbeSphere> spheres{{{}, kRadius_m}};
  std::vector<double> flat{0.0};
  indent::ComplianceCurve curve = *indent::make_compliance_curve(
      {.tip = {.youngs_modulus_Pa = 5000.0, .poisson_ratio = 0.45, .radius_m = kRadius_m},
       .working_depth_m = kRange_m,
       .ring_pitch_m = 2_mm,
       .ring_m_per_N = flat});
  const law::Law* law = &curve;
  tissue::ElasticField field{{.curves = {&law, 1},
                              .coordinate = {},
                              .pull_coordinate = {},
                              .surface = {},
                              .relaxation = {}}};
};

struct Push {
  Vec3 from_m, along;  // unit
  double speed_mps = 0.0;
  Vec3 drag_mps{};  // beside the push
  bool is_straight = false;
};

/// What a push in and out again came to.
struct Felt {
  double most_depth_m = 0.0;
  double resist_N = 0.0;    // against the push, where the tool was farthest in
  double most_N = 0.0;      // of the force
  double given_J = 0.0;     // to the hand, over the whole way
  bool over_a_rim = false;  // the followed place lies on another side than the one pushed at
  int jumps = 0;            // ticks on the way in, in which the place went to another side
  int falls = 0;            // ticks in which the force fell while the tool went away from its place
  int turns = 0;  // places on the way out at which the force is not on the side of the way in
  bool is_free_at_first = false, is_free_at_last = false;
  bool came_out = false;  // pushed in, it was wholly outside again on another side
};

/// Is the whole sphere outside?
bool is_outside(const contact::ContactScene& scene, const Vec3& centre_m, double radius_m) {
  return contact::nearest_site(scene.tree, scene.surface, centre_m, 1.0, contact::kNoTriangle)
             .distance_m >= radius_m;
}

/// One sphere's place, from tick to tick.
class Watch {
 public:
  Watch(std::span<const Vec3> face_normal, double radius_m)
      : face_(face_normal), radius_m_(radius_m) {}

  void see(const contact::SphereTouch& touch, bool goes_in, bool is_out, Felt& felt) {
    if (touch.state != contact::TouchState::kTouching) {
      before_.reset();
      return;
    }
    const Vec3& normal = face_[touch.place.triangle];
    if (!entered_) entered_ = normal;
    felt.over_a_rim = felt.over_a_rim || (goes_in && dot(normal, *entered_) < kOverARim);
    felt.most_depth_m = std::max(felt.most_depth_m, touch.depth_m);
    const Seen now{touch.surface_point_m, normal, touch.depth_m + touch.slack_m,
                   norm(touch.force_N)};
    if (before_) {
      const bool centre_was_inside = before_->away_m > radius_m_;
      if (goes_in && centre_was_inside && norm(now.place_m - before_->place_m) > radius_m_ &&
          dot(now.normal, before_->normal) < 0.0)
        ++felt.jumps;
      constexpr double kRounding_N = 1e-9;
      if (!is_out && now.away_m > before_->away_m && now.force_N < before_->force_N - kRounding_N)
        ++felt.falls;
    }
    before_ = now;
  }

 private:
  struct Seen {
    Vec3 place_m, normal;
    double away_m = 0.0, force_N = 0.0;
  };
  std::span<const Vec3> face_;
  double radius_m_;
  std::optional<Vec3> entered_;
  std::optional<Seen> before_;
};

Felt feel(const contact::ContactScene& scene, const Push& push, const Vec3& tip_m = {}) {
  contact::Contact contact(scene);
  std::vector<Watch> watch;
  for (const contact::ProbeSphere& sphere : scene.spheres)
    watch.emplace_back(scene.surface.face_normal, sphere.radius_m);
  const auto ticks = static_cast<int>((kDeep_m + kBefore_m) / (push.speed_mps * kTick_s));
  std::vector<Vec3> way_in_N;
  Felt felt;
  Vec3 before_m, force_before_N;
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double t_s = (i <= ticks ? i : 2 * ticks - i) * kTick_s;
    Tool tool;
    tool.position_m =
        push.from_m - tip_m + (push.speed_mps * t_s - kBefore_m) * push.along + t_s * push.drag_mps;
    contact.touch(tool);
    const Vec3 force_N = contact.feel(tool, true).wrench.force_N;
    const contact::SphereTouch& touch = contact.touches()[0];
    if (i == 0) felt.is_free_at_first = touch.state == contact::TouchState::kFree;
    if (i > 0) felt.given_J += 0.5 * dot(force_N + force_before_N, tool.position_m - before_m);
    for (std::size_t k = 0; k < watch.size(); ++k) {
      const Vec3 centre_m = tool.position_m + scene.spheres[k].offset_m;
      const bool is_out = is_outside(scene, centre_m, scene.spheres[k].radius_m);
      felt.came_out = felt.came_out || (i <= ticks && is_out && felt.most_depth_m > 0.0);
      watch[k].see(contact.touches()[k], i <= ticks, felt.came_out, felt);
    }
    felt.most_N = std::max(felt.most_N, norm(force_N));
    if (i <= ticks) way_in_N.push_back(force_N);
    if (i > ticks && dot(force_N, way_in_N[static_cast<std::size_t>(2 * ticks - i)]) < 0.0)
      ++felt.turns;
    if (i == ticks) felt.resist_N = -dot(force_N, push.along);
    before_m = tool.position_m;
    force_before_N = force_N;
  }
  felt.is_free_at_last = contact.touches()[0].state == contact::TouchState::kFree;
  return felt;
}

/// At a random point: straight in, oblique by 27 degrees, dragged along; 5, 50, 500 mm/s. The slow
/// ones take long: of every tenth and fiftieth point.
std::vector<Push> pushes_at(int point, const contact::SurfaceView& surface, std::mt19937& random) {
  const std::size_t t = random() % surface.triangle.size();
  const contact::TriangleCorners& corner = surface.triangle[t];
  const Vec3 at_m =
      (surface.vertex_m[corner[0]] + surface.vertex_m[corner[1]] + surface.vertex_m[corner[2]]) /
      3.0;
  const Vec3 in = -surface.face_normal[t];
  const Vec3 side = normalized(cross(in, std::abs(in.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  std::vector<Push> out;
  for (const double speed_mps : {0.5, 0.05, 0.005}) {
    if (!is_long() && point % (speed_mps < 0.01 ? 50 : speed_mps < 0.1 ? 10 : 1) != 0) continue;
    const Push straight{
        .from_m = at_m - kRadius_m * in, .along = in, .speed_mps = speed_mps, .is_straight = true};
    Push oblique = straight, dragged = straight;
    oblique.is_straight = dragged.is_straight = false;
    oblique.along = normalized(in + 0.5 * side);
    dragged.drag_mps = 0.3 * speed_mps * side;
    out.insert(out.end(), {straight, oblique, dragged});
  }
  return out;
}

class DeepPress : public ::testing::TestWithParam<const char*> {};

// Deeper than the law reaches, the tool is pushed back to where it came from; it comes out
// elsewhere only where the followed place went over a rim.
TEST_P(DeepPress, NeverFallsThrough) {
  Organ organ(GetParam());
  const contact::SurfaceView surface = organ.scene.organ_mesh.view();
  const double limit_N = organ.curve.respond(kRange_m).force_N;
  std::mt19937 random(7);
  int straight = 0, straight_over = 0, straight_through = 0, other = 0, other_over = 0, turned = 0;
  for (int point = 0; point < 500; ++point)
    for (const Push& push : pushes_at(point, surface, random)) {
      const Felt felt = feel(organ.contact_scene(), push);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s, straight " << push.is_straight << " out " << felt.came_out << " rim " << felt.over_a_rim);
      // An edge crossed within a tick is felt a tick late: at most that tick's work.
      EXPECT_LE(felt.given_J, limit_N * push.speed_mps * kTick_s);
      EXPECT_EQ(felt.falls, 0);
      EXPECT_EQ(felt.jumps, 0);
      if (felt.most_depth_m < kRange_m) continue;
      ++(push.is_straight ? straight : other);
      if (felt.over_a_rim) ++(push.is_straight ? straight_over : other_over);
      if (felt.over_a_rim && !felt.came_out && push.is_straight && !(felt.resist_N >= 0.5 * limit_N))
        ++straight_through;
      if (felt.over_a_rim || felt.came_out) continue;
      turned += push.is_straight && felt.turns > 0 ? 1 : 0;
      EXPECT_GE(felt.resist_N, 0.5 * limit_N);
      EXPECT_TRUE(felt.is_free_at_last || !felt.is_free_at_first);
    }
  RecordProperty("straight", straight);
  RecordProperty("straight_over_a_rim", straight_over);
  RecordProperty("straight_through", straight_through);
  RecordProperty("oblique_or_dragged", other);
  RecordProperty("oblique_or_dragged_over_a_rim", other_over);
  RecordProperty("not_back_the_same_way", turned);
  EXPECT_GT(straight, 100);
  // Gaskets are thin and have sharp edges everywhere.
  const double most = std::string(GetParam()) == "maintenance" ? 0.25 : 0.05;
  EXPECT_LE(straight_over, most * straight);
  EXPECT_LE(straight_through, 0.04 * straight) << "of a heart 5, of a gasket 19";
  EXPECT_LT(other_over, other / 2);
}

// Friction and relaxation take energy; they never carry the place to another side.
TEST_P(DeepPress, RubbingTissueThatRelaxesGivesNothingAndNeverJumps) {
  Organ organ(GetParam(), true);
  const contact::SurfaceView surface = organ.scene.organ_mesh.view();
  const double limit_N = organ.curve.respond(kRange_m).force_N;
  std::mt19937 random(8);
  for (int point = 0; point < (is_long() ? 500 : 100); ++point)
    for (const Push& push : pushes_at(point, surface, random)) {
      const Felt felt = feel(organ.contact_scene(), push);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s, straight " << push.is_straight << " out " << felt.came_out << " rim " << felt.over_a_rim);
      EXPECT_LE(felt.given_J, limit_N * push.speed_mps * kTick_s);
      EXPECT_EQ(felt.jumps, 0);
    }
}

// A scene as shipped: its law, whole tool, friction, memory and blade. A force that a tick holds
// errs by that tick's work at most, whatever the speed; a gain that does not shrink with the tick
// would be the contact's.
TEST_P(DeepPress, AShippedToolGivesNothingAndNeverJumps) {
  Organ organ(GetParam());
  const auto tissue = make_tissue(organ.scene);
  ASSERT_EQ(tests::sentence_of(tissue), "");
  const contact::ContactScene scene = (*tissue)->contact_scene();
  std::mt19937 random(9);
  for (int point = 1; point <= (is_long() ? 200 : 10); ++point)
    for (const Push& push : pushes_at(point, scene.surface, random)) {
      const Felt felt = feel(scene, push, scene.spheres[0].offset_m);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s, straight " << push.is_straight << " out " << felt.came_out << " rim " << felt.over_a_rim);
      EXPECT_LE(felt.given_J, felt.most_N * push.speed_mps * kTick_s);
      EXPECT_EQ(felt.jumps, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, DeepPress,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

}  // namespace tact::model::scene::deep_press_test
