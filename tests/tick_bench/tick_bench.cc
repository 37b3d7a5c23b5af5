// SPDX-License-Identifier: Apache-2.0
// tact-tick-bench: time of detect and render over one path of the scene's hand, on Google
// Benchmark.
//
// The path is that of the scene's script, 10 000 ticks, without the tissue's answer: the same poses
// in every pass and in every revision. The time of a tick is the least of all passes, which other
// load of the machine does not change. Counters: median, p99.9 and longest over the ticks in
// contact; `ticks` in contact and `work_J` show whether two revisions computed the same forces.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "model/contact/contact.h"
#include "model/hand_path.h"
#include "model/scene/tissue.h"

namespace {

using tact::model::Tool;
using tact::model::Vec3;
using tact::model::contact::Contact;
using tact::model::scene::Scene;
using tact::model::scene::Tissue;

constexpr std::size_t kTicks = 10'000;
constexpr std::size_t kBetweenTicks_B = 3'000'000;     // more than the caches of a core
constexpr std::size_t kBetweenProcesses_B = 64 << 20;  // what other programs read meanwhile

/// A scene that is ready for any number of passes.
struct Ready {
  Scene scene;
  std::unique_ptr<Tissue> tissue;
  std::vector<Tool> path;  // where the hand wants to be in each tick
};

std::vector<Tool> path_of(const Scene& scene) {
  std::vector<Tool> path(kTicks);
  for (std::size_t k = 0; k < kTicks; ++k) {
    const double time_s = static_cast<double>(k) / scene.rate_Hz;
    const auto at = hand_target(scene.hand.path, scene.hand.repeat, time_s);
    const Vec3 before_m = k > 0 ? path[k - 1].position_m : at.position_m;
    path[k] = {.position_m = at.position_m,
               .orientation = tact::model::quat_from_rotation_vector(at.rotation_rad),
               .velocity_mps = scene.rate_Hz * (at.position_m - before_m),
               .grip_ratio = at.grip_ratio};
  }
  return path;
}

Vec3 tick_N(Contact& contact, const Tool& tool) {
  contact.detect_contact(tool);
  return contact.render_force(tool, false).wrench.force_N;
}

bool is_in_contact(const Contact& contact) {
  return std::ranges::any_of(contact.contacts(),
                             [](const auto& sphere) { return norm(sphere.force_N) > 0.0; });
}

/// Reads that much memory, a cache line at a time.
void walk(std::size_t size_B) {
  static std::vector<unsigned char> memory(kBetweenProcesses_B, 1);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < size_B; i += 64) sum += memory[i]++;
  benchmark::DoNotOptimize(sum);
}

template <typename Work>
double time_us(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

struct TickTimes {
  std::vector<double> us = std::vector<double>(kTicks, HUGE_VAL);
  std::vector<bool> in_contact = std::vector<bool>(kTicks, false);
  double work_J = 0.0;  // of the tool on the tissue
};

/// One pass over the path; each time falls to the least so far.
void pass(const Ready& ready, std::size_t walked_B, TickTimes& times) {
  Contact contact(ready.tissue->contact_scene());
  times.work_J = 0.0;
  for (std::size_t k = 0; k < kTicks; ++k) {
    const Tool& tool = ready.path[k];
    if (walked_B > 0 && k > 0 && times.in_contact[k - 1]) walk(walked_B);
    Vec3 force_N;
    times.us[k] = std::min(times.us[k], time_us([&] { force_N = tick_N(contact, tool); }));
    times.in_contact[k] = is_in_contact(contact);
    times.work_J -= dot(force_N, tool.velocity_mps) / ready.scene.rate_Hz;
  }
}

void report(benchmark::State& state, const TickTimes& times) {
  std::vector<double> us;
  for (std::size_t k = 0; k < kTicks; ++k)
    if (times.in_contact[k]) us.push_back(times.us[k]);
  std::ranges::sort(us);
  if (us.empty()) us.push_back(HUGE_VAL);  // a path without contact meets no goal
  const auto last = static_cast<double>(us.size() - 1);
  state.counters["ticks"] = static_cast<double>(us.size());
  state.counters["median_us"] = us[static_cast<std::size_t>(0.5 * last)];
  state.counters["p999_us"] = us[static_cast<std::size_t>(std::ceil(0.999 * last))];
  state.counters["longest_us"] = us.back();
  state.counters["work_J"] = times.work_J;
}

void passes(benchmark::State& state, const Ready& ready, std::size_t walked_B, int count) {
  TickTimes times;
  for (auto _ : state)
    for (int i = 0; i < count; ++i) pass(ready, walked_B, times);
  report(state, times);
}

/// The first tick with force, after other programs have used the caches.
void first_contact(benchmark::State& state, const Ready& ready, int count) {
  TickTimes known;
  pass(ready, 0, known);
  const auto first = static_cast<std::size_t>(std::ranges::find(known.in_contact, true) -
                                              known.in_contact.begin());
  std::vector<double> us(first < kTicks ? 0 : 1, HUGE_VAL);
  for (auto _ : state)
    for (int i = 0; i < count && first < kTicks; ++i) {
      Contact contact(ready.tissue->contact_scene());
      for (std::size_t k = 0; k < first; ++k) tick_N(contact, ready.path[k]);
      walk(kBetweenProcesses_B);
      us.push_back(time_us([&] { tick_N(contact, ready.path[first]); }));
    }
  std::ranges::sort(us);
  state.counters["median_us"] = us[us.size() / 2];
}

void print_help() {
  fmt::print(
      "usage: tact-tick-bench SCENE [KEY=VALUE]... [--benchmark_filter=REGEX]\n"
      "  [--benchmark_format=json]\n\n"
      "Time of detect and render over 10 000 ticks of the scene's hand, the least of all passes:\n"
      "hot; with 3 MB read before each tick; the first contact after 64 MB; and with the first\n"
      "spheres of the tool alone. Other options: those of Google Benchmark. Exit status:\n"
      "0 measured, 2 bad usage or input.\n");
}

int fail(const std::string& message) {
  fmt::print(stderr, "tact-tick-bench: {}\n", message);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv, print_help);
  if (argc < 2) return fail("give a SCENE; see --help");
  const auto loaded = tact::model::scene::load_scene(argv[1], {argv + 2, argv + argc});
  if (!loaded) return fail(loaded.error().message);
  const std::size_t spheres = loaded->tool.spheres.size();
  std::vector<std::unique_ptr<Ready>> with;  // 1, 2 .. all spheres
  for (std::size_t n = 1; n <= spheres; ++n) {
    with.push_back(std::make_unique<Ready>(*loaded, nullptr, path_of(*loaded)));
    with.back()->scene.tool.spheres.resize(n);
    auto tissue = make_tissue(with.back()->scene);
    if (!tissue) return fail(tissue.error().message);
    with.back()->tissue = std::move(*tissue);
  }
  const auto add = [](const std::string& name, auto run, const Ready& ready, auto... more) {
    benchmark::RegisterBenchmark(name.c_str(), [=, &ready](auto& state) {
      run(state, ready, more...);
    })->Iterations(1);
  };
  constexpr int kHot = 100, kCold = 5, kFirst = 21;
  add("hot", passes, *with.back(), std::size_t{0}, kHot);
  add("cold_caches", passes, *with.back(), kBetweenTicks_B, kCold);
  add("first_contact", first_contact, *with.back(), kFirst);
  for (std::size_t n = 1; n < spheres; ++n)
    add(fmt::format("spheres_{}", n), passes, *with[n - 1], std::size_t{0}, kHot);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
