// SPDX-License-Identifier: Apache-2.0
// Deep presses into every shipped organ, at random places: nothing falls through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/indent/compliance_law.h"
#include "model/law/relaxation.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/tissue/elastic_field.h"
#include "model/units.h"
#include "tests/support/extent.h"
#include "tests/support/message.h"

namespace tact::model::scene::deep_press_test {

constexpr double kTick_s = 1e-3, kBefore_m = 6_mm, kDeep_m = 60_mm, kRadius_m = 4_mm;
constexpr double kRange_m = 12_mm;  // of the law

/// A shipped organ of one elastic law, which may relax and rub; no cutting.
struct Organ {
  explicit Organ(const char* name, bool rubs = false) {
    auto loaded = load_scene(TACT_SOURCE_DIR "/model/scenes/" + std::string(name) + ".toml", {});
    EXPECT_EQ(tests::message_of(loaded), "");
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
struct Rendered {
  double most_depth_m = 0.0;
  double most_N = 0.0;          // of the force
  double given_energy_J = 0.0;  // to the hand, over the whole way
  int falls = 0;                // ticks in which the force fell while its sphere went deeper
  bool is_drawn_in = false;  // the force pointed along the push while the sphere was in the organ
};

/// Is the whole sphere outside?
bool is_outside(const contact::ContactScene& scene, const Vec3& centre_m, double radius_m) {
  return contact::nearest_contact_point(scene.tree, scene.surface, centre_m, 1.0,
                                        contact::kNoTriangle)
             .distance_m >= radius_m;
}

Rendered render_force(const contact::ContactScene& scene, const Push& push,
                      const Vec3& tip_m = {}) {
  contact::Contact contact(scene);
  const auto ticks = static_cast<int>((kDeep_m + kBefore_m) / (push.speed_mps * kTick_s));
  Rendered rendered;
  bool has_come_out = false;  // on another side: its force from there on is another contact
  double depth_before_m = 0.0, depth_offset_before_m = 0.0, sphere_before_N = 0.0;
  Vec3 before_m, force_before_N;
  for (int i = 0; i <= 2 * ticks; ++i) {
    const double t_s = (i <= ticks ? i : 2 * ticks - i) * kTick_s;
    Tool tool;
    tool.position_m =
        push.from_m - tip_m + (push.speed_mps * t_s - kBefore_m) * push.along + t_s * push.drag_mps;
    contact.detect_contact(tool);
    const Vec3 force_N = contact.render_force(tool, true).wrench.force_N;
    if (i > 0)
      rendered.given_energy_J += 0.5 * dot(force_N + force_before_N, tool.position_m - before_m);
    rendered.most_N = std::max(rendered.most_N, norm(force_N));
    before_m = tool.position_m, force_before_N = force_N;

    const contact::SphereContact& sphere_contact = contact.contacts()[0];
    rendered.most_depth_m = std::max(rendered.most_depth_m, sphere_contact.depth_m);
    has_come_out = has_come_out || (rendered.most_depth_m > 0.0 &&
                                    is_outside(scene, tool.position_m + scene.spheres[0].offset_m,
                                               scene.spheres[0].radius_m));
    const double depth_m = sphere_contact.depth_m + sphere_contact.depth_offset_m,
                 sphere_N = norm(sphere_contact.force_N);
    constexpr double kRounding_N = 1e-9;
    const bool is_another = sphere_contact.depth_offset_m >
                            depth_offset_before_m;  // contact, or its contact point jumped
    if (!has_come_out && !is_another && depth_m > depth_before_m &&
        sphere_N < sphere_before_N - kRounding_N)
      ++rendered.falls;
    if (!has_come_out && i <= ticks && dot(sphere_contact.force_N, push.along) > kRounding_N)
      rendered.is_drawn_in = true;
    depth_before_m = depth_m, depth_offset_before_m = sphere_contact.depth_offset_m,
    sphere_before_N = sphere_N;
  }
  return rendered;
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
    if (!tests::extent_is("long") && point % (speed_mps < 0.01  ? 50
                                              : speed_mps < 0.1 ? 10
                                                                : 1) !=
                                         0)
      continue;
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

// Deeper than the law reaches, too: the force holds against the push until the tool comes out.
TEST_P(DeepPress, HoldsAgainstThePushAndGivesNothing) {
  Organ organ(GetParam());
  const contact::SurfaceView surface = organ.scene.organ_mesh.view();
  const double limit_N = organ.curve.respond(kRange_m).force_N;
  std::mt19937 random(7);
  int straight = 0, straight_drawn = 0, other = 0, other_drawn = 0;
  const int points = static_cast<int>(tests::share_of(500, 500));
  for (int point = 0; point < points; ++point)
    for (const Push& push : pushes_at(point, surface, random)) {
      const Rendered rendered = render_force(organ.contact_scene(), push);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s");
      // An edge crossed within a tick acts a tick late: at most that tick's work.
      EXPECT_LE(rendered.given_energy_J, limit_N * push.speed_mps * kTick_s);
      EXPECT_EQ(rendered.falls, 0);
      if (rendered.most_depth_m < kRange_m) continue;
      ++(push.is_straight ? straight : other);
      if (rendered.is_drawn_in) ++(push.is_straight ? straight_drawn : other_drawn);
    }
  RecordProperty("straight", straight);
  RecordProperty("straight_drawn_in", straight_drawn);
  RecordProperty("oblique_or_dragged", other);
  RecordProperty("oblique_or_dragged_drawn_in", other_drawn);
  EXPECT_GT(straight, points / 5);
  // Over a rim, where the tool slips off to the other side. An oblique push of 60 mm slides there.
  EXPECT_LE(straight_drawn, 0.05 * straight);
}

// Friction and relaxation take energy.
TEST_P(DeepPress, RubbingTissueThatRelaxesGivesNothing) {
  Organ organ(GetParam(), true);
  const contact::SurfaceView surface = organ.scene.organ_mesh.view();
  const double limit_N = organ.curve.respond(kRange_m).force_N;
  std::mt19937 random(8);
  for (int point = 0; point < static_cast<int>(tests::share_of(100, 500)); ++point)
    for (const Push& push : pushes_at(point, surface, random)) {
      const Rendered rendered = render_force(organ.contact_scene(), push);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s");
      EXPECT_LE(rendered.given_energy_J, limit_N * push.speed_mps * kTick_s);
    }
}

// A scene as shipped: its law, whole tool, friction, memory and blade. A force that a tick holds
// errs by that tick's work at most, for any speed; a gain that does not shrink with the tick
// would be the contact's.
TEST_P(DeepPress, AShippedToolGivesNothing) {
  Organ organ(GetParam());
  const auto tissue = make_tissue(organ.scene);
  ASSERT_EQ(tests::message_of(tissue), "");
  const contact::ContactScene scene = (*tissue)->contact_scene();
  std::mt19937 random(9);
  for (int point = 1; point <= static_cast<int>(tests::share_of(10, 200)); ++point)
    for (const Push& push : pushes_at(point, scene.surface, random)) {
      const Rendered rendered = render_force(scene, push, scene.spheres[0].offset_m);
      SCOPED_TRACE(testing::Message() << "point " << point << ", " << push.speed_mps << " m/s");
      EXPECT_LE(rendered.given_energy_J, rendered.most_N * push.speed_mps * kTick_s);
    }
}

INSTANTIATE_TEST_SUITE_P(Shipped, DeepPress,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

}  // namespace tact::model::scene::deep_press_test
