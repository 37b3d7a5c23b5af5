// SPDX-License-Identifier: Apache-2.0
// The shipped tools in the shipped organs with their shipped laws, on ways that once ended wrong:
// begun inside, left by a side, dragged far away, paused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/units.h"
#include "tests/support/brute_force.h"
#include "tests/support/contact_rules.h"
#include "tests/support/extent.h"
#include "tests/support/message.h"

namespace tact::model::scene::organ_acts_test {

/// A shipped scene under a tool that goes straight from point to point.
class Shipped {
 public:
  explicit Shipped(const std::string& name, const std::vector<std::string>& overrides = {}) {
    auto loaded = load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", overrides);
    EXPECT_EQ(tests::message_of(loaded), "");
    scene_ = std::move(*loaded);
    auto made = make_tissue(scene_);
    EXPECT_EQ(tests::message_of(made), "");
    tissue_ = std::move(*made);
    body_.emplace(scene_.organ_mesh.vertex_m, scene_.organ_mesh.triangle);
  }
  const tests::BruteForce& body() const { return *body_; }
  const mesh::SurfaceMesh& mesh() const { return scene_.organ_mesh; }
  const std::vector<contact::ProbeSphere>& spheres() const { return scene_.tool.spheres; }
  double period_s() const { return 1.0 / scene_.rate_Hz; }
  const contact::Contact& contact() const { return *contact_; }
  double force_N() const { return norm(rendered_.wrench.force_N); }
  Vec3 force_vector_N() const { return rendered_.wrench.force_N; }
  bool is_inside() const { return rendered_.is_inside; }
  /// Of all rules that a tool of coupled spheres and a law that remembers must keep; empty: none.
  const std::string& broken() const { return broken_; }

  void start(const Vec3& at_m) {
    contact_.emplace(tissue_->contact_scene());
    rules_.clear();
    for (const contact::ProbeSphere& sphere : spheres())
      rules_.emplace_back(*body_, tests::RuleSettings{.radius_m = sphere.radius_m,
                                                      .limit_N = 1.0,
                                                      .range_m = 20_mm,
                                                      .period_s = period_s(),
                                                      .is_alone = false,
                                                      .friction_ratio = 0.4});
    broken_.clear();
    at_m_ = at_m;
    tick(at_m, {}, 1);
  }
  /// `periods` ticks are skipped, the first of them tick `paused` of the way, counted from 1.
  void go(const Vec3& to_m, double seconds, double grip_ratio = 0.0, int paused = -1,
          std::uint32_t periods = 0) {
    const int n = std::max(1, static_cast<int>(std::lround(seconds / period_s())));
    const Vec3 from_m = at_m_;
    grip_ratio_ = grip_ratio;
    std::uint32_t since = 1;
    for (int i = 1; i <= n; ++i) {
      if (i >= paused && i < paused + static_cast<int>(periods)) {
        ++since;
        continue;
      }
      tick(from_m + i / double(n) * (to_m - from_m), (to_m - from_m) / (n * period_s()), since);
      since = 1;
    }
    at_m_ = to_m;
  }
  bool all_overlap(const Vec3& tool_m) const {
    return std::all_of(spheres().begin(), spheres().end(),
                       [&](const auto& sphere) { return overlaps(tool_m, sphere); });
  }
  bool overlaps(const Vec3& tool_m, const contact::ProbeSphere& sphere) const {
    const Vec3 p_m = tool_m + sphere.offset_m;
    return body_->winding(p_m) > 0.7 ||
           body_->nearest(p_m, 2 * sphere.radius_m).distance_m < sphere.radius_m;
  }

 private:
  void tick(const Vec3& at_m, const Vec3& velocity_mps, std::uint32_t periods) {
    const Tool tool{.position_m = at_m, .velocity_mps = velocity_mps, .grip_ratio = grip_ratio_};
    contact_->detect_contact(tool, periods);
    rendered_ = contact_->render_force(tool, true);
    if (grip_ratio_ > 0.0) return;  // held tissue pulls
    for (std::size_t k = 0; k < rules_.size(); ++k) {
      const contact::SphereContact& sphere_contact = contact_->contacts()[k];
      for (const tests::Breach& breach :
           rules_[k].check({.centre_m = at_m + spheres()[k].offset_m,
                            .periods = periods,
                            .sphere_contact = sphere_contact,
                            .is_saturated = sphere_contact.law_status == law::LawStatus::kSaturated,
                            .is_lost = rendered_.is_lost}))
        if (broken_.empty()) broken_ = std::string("rule ") + breach.rule + ": " + breach.what;
    }
  }

  Scene scene_;
  std::unique_ptr<Tissue> tissue_;
  std::optional<tests::BruteForce> body_;
  std::optional<contact::Contact> contact_;
  std::vector<tests::ContactRules> rules_;
  contact::ContactResponse rendered_;
  std::string broken_;
  Vec3 at_m_;
  double grip_ratio_ = 0.0;
};

struct Spot {
  Vec3 at_m, outward;
};
Spot random_spot(const mesh::SurfaceMesh& mesh, std::mt19937& random) {
  const std::size_t t = random() % mesh.triangle.size();
  const auto& [a, b, c] = mesh.triangle[t];
  return {(mesh.vertex_m[a] + mesh.vertex_m[b] + mesh.vertex_m[c]) / 3.0, mesh.face_normal[t]};
}
Vec3 beside(const Vec3& outward, std::mt19937& random) {
  std::uniform_real_distribution<double> from(-1.0, 1.0);
  return normalized(tangential({from(random), from(random), from(random)}, outward));
}

TEST(LiverActs, StartInsideAndLiftOutGivesNoForce) {
  Shipped liver("liver");
  liver.start({0, 0, -40_mm});
  EXPECT_TRUE(liver.is_inside());
  for (double z_m = -40_mm; z_m < 60_mm; z_m += 1_mm) {
    liver.go({0, 0, z_m}, 0.03);
    ASSERT_EQ(liver.force_N(), 0.0) << "at z = " << z_m;
    if (z_m < -20_mm) EXPECT_TRUE(liver.is_inside());
  }
  EXPECT_FALSE(liver.is_inside());
  // From now on it is touched as ever.
  liver.go({0, 0, -5_mm}, 1.0);
  EXPECT_GT(liver.force_vector_N().z, 0.05);
  EXPECT_EQ(liver.broken(), "");
}

TEST(LiverActs, PushedInAndOutOfTheSideEndsTheForce) {
  Shipped liver("liver");
  liver.start({0, 0, 30_mm});
  liver.go({0, 0, -40_mm}, 3.0);
  EXPECT_GT(liver.force_N(), 0.5);
  liver.go({0, 98_mm, -40_mm}, 4.0);
  liver.go({0, 128_mm, -40_mm}, 1.0);
  EXPECT_EQ(liver.force_N(), 0.0);
  liver.go({0, 128_mm, -40_mm}, 1.0);
  EXPECT_EQ(liver.force_N(), 0.0);
  EXPECT_EQ(liver.broken(), "");
}

TEST(LiverActs, ALossInAPressGivesNoForceUntilOutside) {
  Shipped liver("liver");
  liver.start({0, 0, 30_mm});
  liver.go({0, 0, -8_mm}, 0.5);
  ASSERT_GT(liver.force_N(), 0.1);
  auto contact = liver.contact();
  const Tool tool{.position_m = {0, 0, -40_mm}};
  contact.detect_contact(tool, 5, 20_mm);
  const contact::ContactResponse rendered = contact.render_force(tool, true);
  EXPECT_TRUE(rendered.is_lost);
  EXPECT_TRUE(rendered.is_inside);
  EXPECT_EQ(norm(rendered.wrench.force_N), 0.0);
  for (const contact::SphereContact& sphere_contact : contact.contacts())
    EXPECT_EQ(sphere_contact.state, ContactState::kInside);
}

class OrganActs : public ::testing::TestWithParam<const char*> {};

TEST_P(OrganActs, StartInsideAndLiftOutGivesNoForce) {
  Shipped organ(GetParam());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> deep_m(1_mm, 25_mm);
  int starts = 0, failed = 0;
  std::string first;
  for (int tries = 0; starts < 60 && tries < 10000; ++tries) {
    const Spot spot = random_spot(organ.mesh(), random);
    const double depth_m = deep_m(random);
    const Vec3 start_m = spot.at_m - depth_m * spot.outward - organ.spheres()[0].offset_m;
    if (!std::all_of(organ.spheres().begin(), organ.spheres().end(),
                     [&](const auto& sphere) { return organ.overlaps(start_m, sphere); }))
      continue;
    ++starts;
    organ.start(start_m);
    organ.go(start_m + (depth_m + 40_mm) * spot.outward, 0.5);
    if (organ.broken().empty()) continue;
    ++failed;
    if (first.empty()) first = organ.broken();
  }
  EXPECT_EQ(starts, 60);
  EXPECT_EQ(failed, 0) << first;
}

TEST_P(OrganActs, PressThenFarAsideEndsTheForce) {
  Shipped organ(GetParam());
  std::mt19937 random(12);
  int failed = 0;
  for (int press = 0; press < 60; ++press) {
    const Spot spot = random_spot(organ.mesh(), random);
    const contact::ProbeSphere& tip = organ.spheres()[0];
    const Vec3 on_m = spot.at_m + tip.radius_m * spot.outward - tip.offset_m;
    const Vec3 in_m = on_m - 20_mm * spot.outward;
    organ.start(on_m + 5_mm * spot.outward);
    organ.go(in_m, 0.25);
    organ.go(in_m + 250_mm * beside(spot.outward, random), 1.0);
    if (organ.force_N() > 0.0) ++failed;
  }
  EXPECT_EQ(failed, 0) << "of 60 have a force 250 mm away";
}

INSTANTIATE_TEST_SUITE_P(Shipped, OrganActs,
                         ::testing::Values("liver", "heart", "skin", "gum", "maintenance"));

// The act with a pause of skipped periods against the same without one, 10 ms after it.
class PauseActs : public ::testing::TestWithParam<int> {
 protected:
  using Act = void (*)(Shipped&, std::uint32_t);

  void expect_alike(const char* scene, Act act) {
    std::vector<std::string> rate{"rate_Hz=" + std::to_string(GetParam())};
    // Half the steps of a tick that is twice as long.
    if (GetParam() < 1000) rate.push_back("spring_patch.substeps=2");
    Shipped whole(scene, rate), paused(scene, rate);
    act(whole, 0);
    const Vec3 want_N = whole.force_vector_N();
    ASSERT_GT(norm(want_N), 0.02);
    for (std::uint32_t periods = 1; periods <= 19; ++periods) {
      if (!tests::extent_is("long") && periods != 1 && periods != 4 && periods != 19) continue;
      act(paused, periods);
      EXPECT_LE(norm(paused.force_vector_N() - want_N), 0.05 * norm(want_N))
          << periods << " periods: " << paused.force_N() << " N, without " << norm(want_N) << " N";
      EXPECT_EQ(paused.contact().contacts()[0].state, whole.contact().contacts()[0].state);
    }
  }
  /// On to `to_m`, with a pause that ends 10 ms before.
  static void pause_on_the_way(Shipped& scene, const Vec3& to_m, double seconds, double grip_ratio,
                               std::uint32_t periods) {
    const int ticks = static_cast<int>(std::lround(seconds / scene.period_s()));
    const int after = static_cast<int>(std::lround(0.01 / scene.period_s()));
    scene.go(to_m, seconds, grip_ratio, ticks - after - static_cast<int>(periods), periods);
  }
};

TEST_P(PauseActs, PressOfTheLiverGoesOn) {
  expect_alike("liver", [](Shipped& liver, std::uint32_t periods) {
    liver.start({0, 0, 5_mm});
    pause_on_the_way(liver, {0, 0, -9_mm}, 0.3, 0.0, periods);
  });
}

TEST_P(PauseActs, DeepPressOfTheLiverGoesOn) {
  expect_alike("liver", [](Shipped& liver, std::uint32_t periods) {
    liver.start({0, 0, 5_mm});
    pause_on_the_way(liver, {0, 0, -45_mm}, 1.0, 0.0, periods);
  });
}

TEST_P(PauseActs, ClosedGripHoldsTheLiverOn) {
  expect_alike("liver", [](Shipped& liver, std::uint32_t periods) {
    liver.start({0, 0, 5_mm});
    liver.go({0, 0, -5_mm}, 0.2);
    liver.go({0, 0, -5_mm}, 0.02, 1.0);
    pause_on_the_way(liver, {0, 0, 2_mm}, 0.3, 1.0, periods);
  });
}

TEST_P(PauseActs, CutOfTheGumGoesOn) {
  expect_alike("gum", [](Shipped& gum, std::uint32_t periods) {
    gum.start({0, 0, 2_mm});
    gum.go({0, 0, -4_mm}, 0.4);
    pause_on_the_way(gum, {4_mm, 0, -4_mm}, 0.4, 0.0, periods);
  });
}

INSTANTIATE_TEST_SUITE_P(RateHz, PauseActs, ::testing::Values(500, 1000, 4000, 10000));

}  // namespace tact::model::scene::organ_acts_test
