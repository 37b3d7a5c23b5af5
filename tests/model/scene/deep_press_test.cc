// SPDX-License-Identifier: Apache-2.0
// Deep presses into every shipped organ, at random places: nothing falls through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/law/compliance_law.h"
#include "model/scene/scene.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/sentence.h"

namespace tact::model::scene::deep_press_test {

constexpr double kTick_s = 1e-3, kBefore_m = 6_mm, kDeep_m = 60_mm, kRadius_m = 4_mm;
constexpr double kRange_m = 12_mm;  // of the law
constexpr double kOverARim = 0.5;   // cosine of two normals

/// A shipped organ of one elastic law; no friction, cutting or relaxation.
struct Organ {
  explicit Organ(const char* name) {
    auto loaded = load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(name) + ".toml", {});
    EXPECT_EQ(tests::sentence_of(loaded), "");
    scene = std::move(*loaded);
    seeds = contact::make_seed_grid(scene.organ_mesh.view(), 2 * kRadius_m);
  }
  contact::Contact contact() {
    return contact::Contact({.law = &field,
                             .parameters = {.tear_force_N = 1.0},
                             .spheres = spheres,
                             .surface = scene.organ_mesh.view(),
                             .seeds = seeds.view(),
                             .blade = {}});
  }
  Scene scene;
  contact::SeedGrid seeds;
  std::vector<contact::ProbeSphere> spheres{{{}, kRadius_m}};
  std::vector<double> flat{0.0};
  law::ComplianceCurve curve = *law::make_compliance_curve(
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
};

/// What a push in and out again came to.
struct Felt {
  double most_depth_m = 0.0;
  double resist_N = 0.0;    // against the push, where the tool was farthest in
  double given_J = 0.0;     // to the hand, over the whole way
  bool over_a_rim = false;  // the followed place lies on another side than the one pushed at
  bool is_free_at_first = false, is_free_at_last = false;
};

Felt feel(Organ& organ, const Push& push) {
  contact::Contact contact = organ.contact();
  const std::span<const Vec3> face = organ.scene.organ_mesh.view().face_normal;
  const auto ticks = static_cast<int>((kDeep_m + kBefore_m) / (push.speed_mps * kTick_s));
  Felt felt;
  Vec3 before_m, force_before_N;
  std::optional<Vec3> entered;
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double t_s = (i <= ticks ? i : 2 * ticks - i) * kTick_s;
    const Tool tool{.position_m = push.from_m + (push.speed_mps * t_s - kBefore_m) * push.along +
                                  t_s * push.drag_mps};
    contact.touch(tool);
    const Vec3 force_N = contact.feel(tool, false).force_N;
    const contact::SphereTouch& touch = contact.touches()[0];
    if (i == 0) felt.is_free_at_first = touch.state == contact::TouchState::kFree;
    if (i > 0) felt.given_J += 0.5 * dot(force_N + force_before_N, tool.position_m - before_m);
    if (i <= ticks && touch.state == contact::TouchState::kTouching) {
      const Vec3& normal = face[touch.place.triangle];
      if (!entered) entered = normal;
      felt.over_a_rim = felt.over_a_rim || dot(normal, *entered) < kOverARim;
      felt.most_depth_m = std::max(felt.most_depth_m, touch.depth_m);
    }
    if (i == ticks) felt.resist_N = -dot(force_N, push.along);
    before_m = tool.position_m;
    force_before_N = force_N;
  }
  felt.is_free_at_last = contact.touches()[0].state == contact::TouchState::kFree;
  return felt;
}

/// The k-th of many: straight in, oblique by 27 degrees, or dragged along; slow, middling, fast.
Push push_number(int k, const contact::SurfaceView& surface, std::mt19937& random) {
  const std::size_t t = random() % surface.triangle.size();
  const contact::TriangleCorners& corner = surface.triangle[t];
  const Vec3 at_m =
      (surface.vertex_m[corner[0]] + surface.vertex_m[corner[1]] + surface.vertex_m[corner[2]]) /
      3.0;
  const Vec3 in = -surface.face_normal[t];
  const Vec3 side = normalized(cross(in, std::abs(in.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  Push push{.from_m = at_m - kRadius_m * in,
            .along = in,
            .speed_mps = k % 10 == 0  ? 0.005
                         : k % 2 == 0 ? 0.05
                                      : 0.5};
  if (k % 3 == 1) push.along = normalized(in + 0.5 * side);
  if (k % 3 == 2) push.drag_mps = 0.3 * push.speed_mps * side;
  return push;
}

class DeepPress : public ::testing::TestWithParam<const char*> {};

// Deeper than the law reaches, the tool is pushed back to where it came from; it comes out
// elsewhere only where the followed place went over a rim.
TEST_P(DeepPress, NeverFallsThrough) {
  Organ organ(GetParam());
  const contact::SurfaceView surface = organ.scene.organ_mesh.view();
  const double limit_N = organ.curve.respond(kRange_m).force_N;
  std::mt19937 random(7);
  int deep = 0, over = 0;
  for (int k = 0; k < 500; ++k) {
    const Push push = push_number(k, surface, random);
    const Felt felt = feel(organ, push);
    // An edge crossed within a tick is felt a tick late: at most that tick's work.
    EXPECT_LE(felt.given_J, limit_N * push.speed_mps * kTick_s) << "push " << k;
    if (felt.most_depth_m < kRange_m) continue;
    ++deep;
    over += felt.over_a_rim ? 1 : 0;
    if (felt.over_a_rim) continue;
    EXPECT_GE(felt.resist_N, 0.5 * limit_N) << "push " << k;
    EXPECT_TRUE(felt.is_free_at_last || !felt.is_free_at_first) << "push " << k;
  }
  EXPECT_GT(deep, 300);
  EXPECT_LT(over, deep / 2);
}

INSTANTIATE_TEST_SUITE_P(Shipped, DeepPress,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

}  // namespace tact::model::scene::deep_press_test
