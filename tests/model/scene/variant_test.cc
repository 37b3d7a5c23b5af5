// SPDX-License-Identifier: Apache-2.0
// A tissue with other numbers replaces one that is out of contact.
#include "model/scene/variant.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "tests/support/message.h"

namespace tact::model::scene::variant_test {

using contact::Contact;

Scene shipped(const std::string& name) {
  return *load_scene(std::string(TACT_SOURCE_DIR) + "/model/scenes/" + name + ".toml", {});
}

/// A tool that dips into the organ around the hand's site, at random places and speeds.
class RandomPath {
 public:
  RandomPath(const Scene& scene, unsigned seed) : scene_(scene), random_(seed) {
    std::uniform_real_distribution<double> rate(0.5, 3.0), phase(0.0, 2.0 * std::numbers::pi);
    for (int i = 0; i < 4; ++i) {
      rate_Hz_[i] = rate(random_);
      phase_[i] = phase(random_);
    }
  }
  Tool at(int tick) const {
    const double time_s = tick / scene_.rate_Hz;
    const auto wave = [&](int i) {
      return std::sin(2.0 * std::numbers::pi * rate_Hz_[i] * time_s + phase_[i]);
    };
    const Vec3 dip_m = (0.006 * wave(0) - 0.004) * scene_.hand_inward;
    Tool tool;
    tool.position_m = scene_.hand_site_m + dip_m + Vec3{0.004 * wave(1), 0.004 * wave(2), 0.0};
    tool.grip_ratio = 0.5 + 0.5 * wave(3);
    return tool;
  }
  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }

 private:
  const Scene& scene_;
  std::mt19937 random_;
  double rate_Hz_[4], phase_[4];
};

struct Live {
  std::unique_ptr<Tissue> tissue;
  std::unique_ptr<Contact> contact;
};

Live made(const Scene& scene) {
  Live out{.tissue = std::move(*make_tissue(scene)), .contact = nullptr};
  out.contact = std::make_unique<Contact>(out.tissue->contact_scene());
  return out;
}

Wrench step(Contact& contact, const Tool& tool) {
  contact.detect_contact(tool);
  return contact.render_force(tool, false).wrench;
}

class EqualNumbers : public testing::TestWithParam<const char*> {};

// The oracle is a contact that is never replaced.
TEST_P(EqualNumbers, ChangeNoBitOfTheForceOnAnyPath) {
  const Scene scene = shipped(GetParam());
  for (unsigned seed = 1; seed <= 5; ++seed) {
    RandomPath path(scene, seed);
    const Live whole = made(scene);
    std::array<Live, 2> live{made(scene), made(scene)};
    std::size_t now = 0;
    int changes = 0, pressed = 0;
    for (int tick = 0; tick < 4000; ++tick) {
      if (live[now].contact->is_clear() && path.chance(0.02)) {
        Live& next = live[1 - now];
        next.contact = std::make_unique<Contact>(next.tissue->contact_scene());
        next.contact->continue_from(*live[now].contact);
        now = 1 - now;
        ++changes;
      }
      const Wrench expected = step(*whole.contact, path.at(tick));
      ASSERT_EQ(step(*live[now].contact, path.at(tick)), expected)
          << "seed " << seed << " tick " << tick;
      if (norm(expected.force_N) > 0.0) ++pressed;
    }
    EXPECT_GT(changes, 3) << seed;
    EXPECT_GT(pressed, 100) << seed;
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, EqualNumbers, testing::Values("liver", "heart", "skin"));

TEST(Variant, IsClearOnlyWithoutContactAndWithoutALeftForce) {
  const Scene scene = shipped("liver");
  const Live live = made(scene);
  RandomPath path(scene, 7);
  for (int tick = 0; tick < 4000; ++tick) {
    const Wrench wrench = step(*live.contact, path.at(tick));
    if (live.contact->is_clear()) ASSERT_EQ(wrench, Wrench{}) << tick;
  }
}

TEST(Variant, StiffnessFollowsEAndTheRestStays) {
  const Scene scene = shipped("liver");
  const std::vector<std::string> set{"elastic.youngs_modulus_Pa=2500"};
  const auto soft = make_variant(scene, set);
  ASSERT_TRUE(soft) << tests::message_of(soft);
  EXPECT_EQ(soft->scene->elastic->youngs_modulus_Pa, 2500.0);
  EXPECT_EQ(soft->scene->hash, scene.hash);
  const Live before = made(scene);
  Contact after(soft->tissue->contact_scene());
  double hard_N = 0.0, soft_N = 0.0;
  for (double depth_m = -0.004; depth_m < 0.004; depth_m += 0.0001) {
    Tool tool;
    tool.position_m = scene.hand_site_m + depth_m * scene.hand_inward;
    hard_N = norm(step(*before.contact, tool).force_N);
    soft_N = norm(step(after, tool).force_N);
  }
  EXPECT_GT(hard_N, 0.0);
  EXPECT_LT(soft_N, 0.95 * hard_N);
}

TEST(Variant, RefusesWhatMayNotChangeWithTheKeysThatMay) {
  const Scene scene = shipped("liver");
  const auto error = [&](const std::string& set) {
    const std::vector<std::string> one{set};
    return tests::message_of(make_variant(scene, one));
  };
  EXPECT_EQ(error("limits.force_N=3")
                .find("limits.force_N cannot change while the scene runs; "
                      "these can: rhombus.rod_length_m, "),
            0u);
  EXPECT_EQ(error("rhombus.units=3").find("rhombus.units cannot change"), 0u) << "a count";
  EXPECT_EQ(error("elastic.poisson_ratio=0.4").find("elastic.poisson_ratio cannot change"), 0u);
  for (const char* value : {"", "soft", "nan", "0", "1e12", "5 000", "5000Pa", "0x10"})
    EXPECT_NE(error(std::string("elastic.youngs_modulus_Pa=") + value)
                  .find("give a number from 1 to 1e+09"),
              std::string::npos)
        << value;
}

}  // namespace tact::model::scene::variant_test
