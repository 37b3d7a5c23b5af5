// SPDX-License-Identifier: Apache-2.0
// Random paths through the shipped liver as rendered: one jaw and both on the organ that they
// move, with friction and without, held against distance and winding number by brute force.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/scene/scene.h"
#include "model/scene/tissue.h"
#include "model/units.h"
#include "tests/support/brute_force.h"
#include "tests/support/extent.h"
#include "tests/support/path_run.h"
#include "tests/support/random_path.h"

namespace tact::model::scene::any_path_moved_test {

constexpr double kPeriod_s = 1e-3;
constexpr double kSlope_N_per_m = 125.0;           // of the tip's law, the steepest
constexpr double kRange_m = 18_mm;                 // of the tip's law
constexpr double kFar_m = 40_mm, kEnding_s = 0.2;  // beyond, after this time, there is no force
constexpr double kFree_J = 2.5e-7, kMade = 0.025;  // ML-9: of one contact, and of the stored energy

/// What must hold of one sphere, tick by tick.
class SphereRules {
 public:
  SphereRules(const tests::BruteForce& body, double radius_m, bool is_alone)
      : body_(body), radius_m_(radius_m), is_alone_(is_alone) {}

  /// The rule that the tick breaks; 0: none.
  char check(const Vec3& centre_m, const contact::SphereContact& sphere_contact,
             std::uint32_t periods, bool is_saturated, bool is_lost) {
    if (!is_finite(sphere_contact.force_N)) return 'f';
    const double force_N = norm(sphere_contact.force_N);
    const double near_m = body_.nearest(centre_m, kFar_m).distance_m;
    const bool is_in = body_.is_near(centre_m) && body_.winding(centre_m) > 0.5;
    const bool is_outside = !is_in && near_m > radius_m_ + 1e-9;
    const double way_m = before_m_ && !is_lost ? norm(centre_m - *before_m_) : 0.0;
    char broken = 0;
    // Found in the organ: no force until it has been outside.
    if (!before_m_ || is_lost) must_be_inside_ = !is_outside;
    if (is_outside) must_be_inside_ = false;
    if (must_be_inside_ && force_N != 0.0) broken = 'a';
    // Far away it is let go.
    far_s_ = !is_in && !(near_m <= kFar_m) ? far_s_ + periods * kPeriod_s : 0.0;
    if (far_s_ > kEnding_s && force_N > 0.0) broken = 'c';
    // Alone, deeper with its centre inside: force within three ticks.
    if (is_outside && force_N == 0.0) entered_ = true;
    if (is_lost || is_saturated || sphere_contact.state == ContactState::kInside) entered_ = false;
    const bool is_deeper = is_in && was_in_ && near_m > near_before_m_ + 1e-9;
    without_ = is_alone_ && entered_ && is_deeper && force_N == 0.0 ? without_ + 1 : 0;
    if (without_ > 3) broken = 'd';
    // No jump: by the way, or while it lets go.
    const double most_N =
        kSlope_N_per_m * (10.0 * way_m + kRange_m * periods * kPeriod_s / contact::kEnding_s);
    if (before_m_ && !is_lost && norm(sphere_contact.force_N - force_before_N_) > most_N)
      broken = 'e';
    jump_N_ = norm(sphere_contact.force_N - force_before_N_), most_N_ = most_N;
    is_free_ = is_outside && force_N == 0.0;
    before_m_ = centre_m, force_before_N_ = sphere_contact.force_N, was_in_ = is_in,
    near_before_m_ = near_m;
    return broken;
  }
  bool is_free() const { return is_free_; }
  std::string jump() const {
    return ", jump " + std::to_string(jump_N_) + " N of " + std::to_string(most_N_) + " N";
  }

 private:
  const tests::BruteForce& body_;
  double radius_m_;
  bool is_alone_, must_be_inside_ = false, entered_ = false, is_free_ = false, was_in_ = false;
  std::optional<Vec3> before_m_;
  Vec3 force_before_N_;
  double near_before_m_ = 0.0, far_s_ = 0.0, jump_N_ = 0.0, most_N_ = 0.0;
  int without_ = 0;
};

struct Counts {
  std::size_t ticks = 0, unsolved = 0, unsettled = 0, strokes = 0;
  double max_given_energy_J = 0.0;
  std::map<char, int> broken;
  std::string first;
};

/// One path; what it breaks goes into `counts`.
void run(const Scene& scene, const Tissue& tissue, const tests::BruteForce& body,
         const tests::Path& path, const std::string& name, Counts& counts) {
  contact::Contact contact(tissue.contact_scene());
  std::vector<SphereRules> rules;
  for (const contact::ProbeSphere& s : scene.tool.spheres)
    rules.emplace_back(body, s.radius_m, scene.tool.spheres.size() == 1);
  Vec3 force_N, at_m = path.start_m;
  double given_energy_J = 0.0, stored_J = 0.0, most_N = 0.0, most_m = 0.0;
  std::uint32_t periods = 0;
  std::size_t index = 0;
  const auto broke = [&](char rule, const std::string& what) {
    if (counts.broken[rule]++ == 0)
      counts.first += std::string(1, rule) + ": " + name + ", tick " + std::to_string(index) +
                      ": " + what + "\n" + tests::as_code(path) + "\n";
  };
  for (const tests::PathTick& tick : tests::ticks_of(path)) {
    ++index;
    ++periods;
    if (tick.is_skipped) continue;
    const Tool tool{.position_m = tick.position_m};
    contact.detect_contact(tool, periods);
    const contact::ContactResponse rendered = contact.render_force(tool, false);
    bool is_free = true;
    double now_J = 0.0;
    for (std::size_t k = 0; k < rules.size(); ++k) {
      const contact::SphereContact& sphere_contact = contact.contacts()[k];
      now_J += sphere_contact.energy_J;
      const char rule =
          rules[k].check(tool.position_m + scene.tool.spheres[k].offset_m, sphere_contact, periods,
                         rendered.is_saturated, rendered.is_lost);
      if (rule != 0)
        broke(rule, "jaw " + std::to_string(k) + ", force " +
                        std::to_string(norm(sphere_contact.force_N)) + " N" + rules[k].jump() +
                        (contact.moved().status().is_solved ? "" : ", unsolved"));
      is_free = is_free && rules[k].is_free();
    }
    const Vec3 way_m = tool.position_m - at_m;
    given_energy_J += 0.5 * dot(rendered.wrench.force_N + force_N, way_m);
    most_N = std::max(most_N, norm(rendered.wrench.force_N));
    most_m = std::max(most_m, norm(way_m));
    stored_J = std::max(stored_J, now_J);
    if (rendered.is_lost || is_free) {
      counts.max_given_energy_J = std::max(counts.max_given_energy_J, given_energy_J);
      if (!rendered.is_lost && given_energy_J > most_N * most_m + kFree_J + kMade * stored_J)
        broke('h', "given " + std::to_string(1e6 * given_energy_J) + " uJ of " +
                       std::to_string(1e6 * stored_J));
      if (stored_J > 0.0) ++counts.strokes;
      given_energy_J = stored_J = most_N = most_m = 0.0;
    }
    if (!contact.moved().status().is_solved) ++counts.unsolved;
    if (rendered.is_unsettled) ++counts.unsettled;
    ++counts.ticks;
    force_N = rendered.wrench.force_N, at_m = tool.position_m, periods = 0;
  }
}

TEST(AnyPathMoved, TheShippedLiverKeepsTheRulesOfContact) {
  const std::size_t most_ticks = tests::share_of(100'000, 4'000'000);
  Counts counts;
  const auto whole = load_scene(TACT_SOURCE_DIR "/model/scenes/liver.toml", {});
  ASSERT_TRUE(whole);
  const tests::BruteForce body(whole->organ_mesh.vertex_m, whole->organ_mesh.triangle);
  std::vector<Scene> scene;
  for (const double friction_ratio : {0.4, 0.0}) {
    scene.push_back(*whole);
    scene.back().contact.friction_ratio = friction_ratio;
    scene.push_back(scene.back());
    scene.back().tool.spheres.resize(1);
  }
  std::vector<std::unique_ptr<Tissue>> tissue;
  for (const Scene& s : scene) tissue.push_back(std::move(*make_tissue(s)));
  for (std::uint32_t seed = 1; counts.ticks < most_ticks; ++seed) {
    const std::size_t i = seed % scene.size();
    tests::PathMaker maker(whole->organ_mesh.vertex_m, whole->organ_mesh.triangle, body,
                           whole->tool.spheres[0].radius_m, seed);
    run(scene[i], *tissue[i], body, maker.make(6),
        "seed " + std::to_string(seed) + ", " + std::to_string(scene[i].tool.spheres.size()) +
            " jaws, friction " + std::to_string(scene[i].contact.friction_ratio),
        counts);
  }
  std::string reported;
  for (const auto& [rule, n] : counts.broken)
    reported += std::string(1, rule) + " " + std::to_string(n) + " ";
  RecordProperty("counts", std::to_string(counts.ticks) + " ticks, " +
                               std::to_string(counts.unsolved) + " unsolved, " +
                               std::to_string(counts.unsettled) + " unsettled, " +
                               std::to_string(counts.strokes) + " strokes, broken: " + reported);
  EXPECT_TRUE(counts.broken.empty()) << reported << "\n" << counts.first;
  EXPECT_LT(static_cast<double>(counts.unsolved), 0.01 * static_cast<double>(counts.ticks));
  // Those whose force would have jumped and was slowed down, and reported so.
  EXPECT_LT(static_cast<double>(counts.unsettled), 0.03 * static_cast<double>(counts.ticks));
  EXPECT_GT(counts.strokes, tests::share_of(20, 20));
}

}  // namespace tact::model::scene::any_path_moved_test
