// SPDX-License-Identifier: Apache-2.0
#include "tools/reference/plan/solve_cache.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tools/program/run_program.h"
#include "tools/reference/press/contact_radius.h"
#include "tools/reference/press/half_space.h"
#include "tools/reference/self_check/block.h"

namespace tact::tools::reference::solve_cache_test {

namespace fs = std::filesystem;

Organ block() {
  auto organ = make_block(0.05, 0.05, {.youngs_modulus_Pa = 1000.0, .poisson_ratio = 0.45});
  EXPECT_TRUE(organ) << organ.error().message;
  organ->hash = mesh_hash(organ->surface);
  return std::move(*organ);
}

program::ScratchFolder folder() {
  auto made = program::ScratchFolder::make("tact-solve-cache-test");
  EXPECT_TRUE(made) << made.error().message;
  return std::move(*made);
}

constexpr Indentation kPress{
    .vertex = 0, .tool_radius_m = 5e-3, .depth_m = 1e-3, .contact_radius_m = 2.2e-3};

TEST(SolveCache, FindsWhatItKeptAndNothingElse) {
  const auto where = folder();
  const SolveCache cache(where.file("new/folder"));
  EXPECT_FALSE(cache.find("a key"));
  const ground_truth::ReferenceCase solved{.depth_m = 1e-3,
                                           .large_strain = true,
                                           .force_N = 0.1 / 3.0,
                                           .contact_radius_m = 2e-3,
                                           .profile_m = {1e-3, 1e-3 / 7.0}};
  ASSERT_FALSE(cache.keep("a key", solved));
  const auto found = cache.find("a key");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->force_N, solved.force_N) << "to the last bit";
  EXPECT_EQ(found->profile_m, solved.profile_m);
  EXPECT_TRUE(found->large_strain);
  EXPECT_FALSE(cache.find("another key"));
}

TEST(SolveCache, KeepsTheWholeToolToo) {
  const auto where = folder();
  const SolveCache cache(where.path());
  ASSERT_FALSE(cache.keep_tool(
      "a key", {{.depth_m = 1e-3, .force_N = 0.1 / 3.0, .sphere_N = {0.01, 0.07 / 3.0}}}));
  const auto found = cache.find_tool("a key");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->front().force_N, 0.1 / 3.0) << "to the last bit";
  EXPECT_EQ(found->front().sphere_N, (std::vector<double>{0.01, 0.07 / 3.0}));
  EXPECT_FALSE(cache.find_tool("another key"));
  EXPECT_FALSE(cache.find("a key")) << "it is no single sphere";
  const ToolPress press{.direction = {0, 0, -1},
                        .sphere = {{.centre_m = {0, 0, 4e-3}, .radius_m = 4e-3}},
                        .depths_m = {1e-3},
                        .level = 1};
  ToolPress other = press;
  other.sphere[0].centre_m.x = 1e-6;
  EXPECT_NE(cache_key(block(), press, "s"), cache_key(block(), other, "s"));
  other = press;
  other.depths_m.push_back(2e-3);
  EXPECT_NE(cache_key(block(), press, "s"), cache_key(block(), other, "s"));
  other = press;
  other.level = 2;
  EXPECT_NE(cache_key(block(), press, "s"), cache_key(block(), other, "s"));
}

TEST(SolveCache, ManyMayKeepTheSameCaseAtOnce) {
  const auto where = folder();
  const SolveCache cache(where.path());
  const ground_truth::ReferenceCase solved{
      .depth_m = 1e-3, .force_N = 0.25, .profile_m = std::vector<double>(3000, 1.0 / 3.0)};
  std::atomic<int> failed{0};
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 50; ++i) failed += cache.keep("a key", solved) ? 1 : 0;
      });
  }
  EXPECT_EQ(failed, 0);
  ASSERT_TRUE(cache.find("a key"));
  for (const auto& entry : fs::directory_iterator(where.path()))
    EXPECT_EQ(entry.path().string(), cache.path_of("a key")) << "nothing else is left behind";
}

TEST(SolveCache, SaysWhatToDoWithoutRoom) {
  const auto where = folder();
  // No file can be made here: the name is longer than any file system takes.
  const SolveCache nowhere(where.file(std::string(300, 'x')));
  const auto error = nowhere.keep("a key", {.depth_m = 1e-3, .profile_m = {}});
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("name another --cache"), std::string::npos) << error->message;
}

TEST(SolveCache, ADamagedFileCountsAsAbsent) {
  const auto where = folder();
  const SolveCache cache(where.path());
  ASSERT_FALSE(cache.keep("a key", {.depth_m = 1e-3, .profile_m = {}}));
  std::ofstream(cache.path_of("a key")) << "{\"key\": \"a key\", \"depth_m\":";
  EXPECT_FALSE(cache.find("a key"));
  // Two keys of one hash: the other's file lies where ours would.
  ASSERT_FALSE(cache.keep("another key", {.depth_m = 1e-3, .profile_m = {}}));
  fs::rename(cache.path_of("another key"), cache.path_of("a key"));
  EXPECT_FALSE(cache.find("a key"));
}

TEST(SolveCache, TheKeyNamesEverythingThatChangesTheAnswer) {
  const Organ organ = block();
  const std::string key = cache_key(organ, kPress, "solver 1");
  EXPECT_EQ(cache_key(organ, kPress, "solver 1"), key);
  EXPECT_NE(cache_key(organ, kPress, "solver 2"), key);
  for (int change = 0; change < 6; ++change) {
    Indentation other = kPress;
    if (change == 0) other.vertex = 1;
    if (change == 1) other.tool_radius_m = 4e-3;
    if (change == 2) other.depth_m = -1e-3;
    if (change == 3) other.large_strain = true;
    if (change == 4) other.level = 3;
    if (change == 5) other.contact_radius_m = 2e-3;
    EXPECT_NE(cache_key(organ, other, "solver 1"), key) << change;
  }
  Indentation ball = kPress;
  ball.large_strain = true;
  EXPECT_NE(cache_key(organ, ball, "solver 1").find("ball"), std::string::npos)
      << "its method has a number of its own";
  EXPECT_EQ(key.find("ball"), std::string::npos);
  for (int change = 0; change < 4; ++change) {
    Organ other = organ;
    if (change == 0) other.material.youngs_modulus_Pa = 2000.0;
    if (change == 1) other.material.poisson_ratio = 0.4;
    if (change == 2) other.held.max_m.z = -0.02;
    if (change == 3) {
      other.surface.vertex_m[5].x += 1e-6;
      other.hash = mesh_hash(other.surface);
    }
    EXPECT_NE(cache_key(other, kPress, "solver 1"), key) << change;
  }
}

TEST(SolveCache, AHitDoesNotRunTheSolver) {
  const auto where = folder();
  const SolveCache cache(where.path());
  const Organ organ = block();
  ASSERT_FALSE(cache.keep(cache_key(organ, kPress, "s"),
                          {.depth_m = 1e-3, .force_N = 42.0, .profile_m = {1e-3}}));
  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);  // no gmsh, no ccx
  const auto hit = solve_once(organ, kPress, "s", cache);
  const auto miss = solve_once(organ, kPress, "another solver", cache);
  setenv("PATH", path.c_str(), 1);
  ASSERT_TRUE(hit) << hit.error().message;
  EXPECT_EQ(hit->force_N, 42.0);
  ASSERT_FALSE(miss);
  EXPECT_EQ(miss.error().message, "gmsh is not installed; apt install gmsh");
}

TEST(SolveCache, APressWithoutARadiusIsSolvedCoarselyFirst) {
  const auto where = folder();
  const SolveCache cache(where.path());
  const Organ organ = block();
  Indentation asked = kPress;
  asked.contact_radius_m = 0.0;
  const std::string path = std::getenv("PATH");
  const auto solve_without_programs = [&] {
    setenv("PATH", "/nowhere", 1);
    auto result = solve_once(organ, asked, "s", cache);
    setenv("PATH", path.c_str(), 1);
    return result;
  };
  EXPECT_FALSE(solve_without_programs());
  Indentation probe = kPress;
  probe.depth_m = 5e-3;
  probe.level = kCoarsestLevel;
  probe.contact_radius_m = 0.75 * 5e-3;
  const double probe_N = 0.9 * sphere_force_N(organ.material, 5e-3, 5e-3);
  ASSERT_FALSE(cache.keep(cache_key(organ, probe, "s"),
                          {.depth_m = 5e-3, .force_N = probe_N, .profile_m = {}}));
  const TipContact tip(organ.material, 5e-3, {}, 1e-3);  // the block's top is flat
  Indentation pressed = kPress;
  pressed.contact_radius_m = tip.radius_m(1e-3, tip.compliance_m_per_N(5e-3, probe_N));
  EXPECT_LT(pressed.contact_radius_m, 0.99 * sphere_contact_radius_m(5e-3, 1e-3));
  ASSERT_FALSE(cache.keep(cache_key(organ, pressed, "s"),
                          {.depth_m = 1e-3, .force_N = 42.0, .profile_m = {}}));
  const auto solved = solve_without_programs();
  ASSERT_TRUE(solved) << solved.error().message;
  EXPECT_EQ(solved->force_N, 42.0);
}

}  // namespace tact::tools::reference::solve_cache_test
