// SPDX-License-Identifier: Apache-2.0
// tact-soak: a day at the device in simulated time, as fast as the CPU allows.
//
// The whole controller with the simulated delta and its safety lines: random strokes, faults,
// stops, late ticks and operators by a seed; after each tick its invariants are checked: force,
// torque, their slew, power, energy and RMS by accounts of its own (energy_ledger.h), states,
// latching, the grid. A quarter as many ticks, but 100 000 at least, follow with narrower limits,
// so that every stage of the gate has its say. The same seed gives the same hashes with every
// compiler.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "firmware/gate/limits_for.h"
#include "firmware/loop/alloc_counter.h"
#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "firmware/run/loop_parts.h"
#include "firmware/run/replay.h"
#include "firmware/telemetry/force_hash.h"
#include "hal/registry/open_device.h"
#include "hal/sim/sim_delta.h"
#include "model/scene/tissue.h"
#include "model/time_ns.h"
#include "tests/soak/fault_injection.h"
#include "tests/soak/invariants.h"

namespace tact::soak {
namespace {

std::atomic<bool> interrupted{false};

struct Outcome {
  std::uint64_t ticks = 0, skipped = 0, armed_ticks = 0, pushing_ticks = 0, stops = 0;
  std::uint64_t broken = 0, heap_calls = 0;
  std::int64_t grown_kB = 0;  // resident memory, from a tenth of the way to the end
  std::uint64_t force_hash = model::kFnvStart;
  std::string first;
  std::array<std::uint64_t, firmware::gate::kStageCount> acted{};  // of the gate's stages
};

// So that the hand reaches them all the time: the tissue alone asks for less than the scene allows.
const std::vector<std::string> kTightLimits{"limits.force_N=0.3", "limits.slew_N_per_s=31"};
// So that it also meets those of speed, energy, heat and power, which soft tissue cannot reach: 16
// times as stiff.
const std::vector<std::string> kNarrowLimits{"rhombus.normal_stiffness_N_per_m=25",
                                             "rhombus.tangential_stiffness_N_per_m=13",
                                             "limits.force_N=1",
                                             "limits.torque_Nm=0.004",
                                             "limits.slew_N_per_s=125",
                                             "limits.speed_mps=0.3",
                                             "limits.turn_radps=0.5",
                                             "limits.energy_J=0.002",
                                             "limits.continuous_force_N=0.4",
                                             "limits.thermal_time_s=0.5",
                                             "limits.power_W=0.1"};

std::int64_t resident_kB() {
  std::int64_t size = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> size >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

void count(const firmware::loop::TickRecord& record, firmware::loop::State before,
           Outcome& outcome) {
  const firmware::loop::TickOutput& output = record.output;
  outcome.force_hash = firmware::telemetry::hash_wrench(outcome.force_hash, output.written);
  if (output.state == firmware::loop::State::kArmed) ++outcome.armed_ticks;
  if (norm(output.written.force_N) > 0.0) ++outcome.pushing_ticks;
  if (output.state == firmware::loop::State::kStopped && before != output.state) ++outcome.stops;
}

model::Result<Outcome> soak(const model::scene::Scene& scene, std::uint64_t ticks,
                            std::uint64_t seed) {
  const auto tissue = model::scene::make_tissue(scene);
  if (!tissue) return tissue.error();
  auto device =
      hal::sim::make_sim_delta(scene.device.of<hal::sim::SimDeviceSettings>(), scene.hand);
  if (!device) return device.error();
  hal::sim::SimLines lines;
  firmware::loop::SimulatedClock clock;
  firmware::loop::Requests requests;
  const auto ring = std::make_unique<firmware::loop::TickRing>();
  const std::int64_t period_ns = model::period_ns(scene.rate_Hz);
  const model::Limits limits = firmware::gate::limits_for(scene.limits, (*device)->info());
  const auto controller = std::make_unique<firmware::loop::Controller>(
      (*tissue)->contact_scene(),
      firmware::gate::Gate(limits, static_cast<double>(period_ns) * 1e-9, 1.0),
      /*hard_real_time=*/true);
  firmware::loop::RtLoop loop({.period_ns = period_ns}, **device, lines, *controller, clock,
                              requests, *ring);
  FaultInjection injected(seed, scene.hand, period_ns);
  Invariants invariants(limits, period_ns);
  Outcome outcome;
  firmware::loop::State state = firmware::loop::State::kOff;
  firmware::loop::TickRecord record;
  while (ring->dropped() == 0) ring->push(record);  // all of its memory is there from the start
  while (ring->pop(record)) continue;
  std::int64_t early_kB = 0;
  firmware::pc::flush_denormals();
  for (; outcome.ticks < ticks && !interrupted.load(); ++outcome.ticks) {
    injected.step(**device, lines, clock, requests, state == firmware::loop::State::kStopped);
    {
      const firmware::loop::HeapCallCounter heap;
      loop.step();
      outcome.heap_calls += heap.calls();
    }
    ring->pop(record);
    invariants.check(record);
    count(record, state, outcome);
    state = record.output.state;
    if (outcome.ticks == ticks / 10) early_kB = resident_kB();
    if (outcome.ticks % 1'000'000 == 0 && isatty(STDERR_FILENO) != 0)
      fmt::print(stderr, "\rtact-soak: {} of {} million ticks", outcome.ticks / 1'000'000,
                 ticks / 1'000'000);
  }
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\n");
  outcome.grown_kB = resident_kB() - early_kB;
  outcome.skipped = loop.statistics().skipped_ticks;
  outcome.broken = invariants.broken();
  outcome.first = invariants.first();
  outcome.acted = controller->gate().counters();
  return outcome;
}

nlohmann::ordered_json stages_json(const Outcome& outcome) {
  nlohmann::ordered_json stages;
  for (std::size_t i = 0; i < firmware::gate::kStageCount; ++i)
    stages[firmware::gate::kStageName[i]] = outcome.acted[i];
  return stages;
}

nlohmann::ordered_json to_json(const Outcome& outcome, std::uint64_t seed) {
  return {{"ticks", outcome.ticks},
          {"seed", seed},
          {"skipped", outcome.skipped},
          {"armed_ticks", outcome.armed_ticks},
          {"pushing_ticks", outcome.pushing_ticks},
          {"stops", outcome.stops},
          {"stages_acted", stages_json(outcome)},
          {"promises_broken", outcome.broken},
          {"first_broken", outcome.first},
          {"heap_calls", outcome.heap_calls},
          {"resident_grown_kB", outcome.grown_kB},
          {"force_hash", fmt::format("{:016x}", outcome.force_hash)}};
}

// A soak that never pushed or never stopped proves nothing.
std::string complaint(const Outcome& outcome, bool every_stage) {
  constexpr std::int64_t kPageNoise_kB = 256;
  if (outcome.broken != 0) return fmt::format("{} broken, first {}", outcome.broken, outcome.first);
  if (firmware::loop::can_count_heap_calls() && outcome.heap_calls != 0)
    return fmt::format("{} heap calls in the loop", outcome.heap_calls);
  if (!firmware::loop::is_sanitized() && outcome.grown_kB > kPageNoise_kB)
    return fmt::format("resident memory grew by {} kB", outcome.grown_kB);
  for (std::size_t i = 0; i < firmware::gate::kStageCount; ++i)
    if (every_stage && outcome.acted[i] == 0)
      return fmt::format("the stage {} never acted: it proves nothing",
                         firmware::gate::kStageName[i]);
  if (outcome.pushing_ticks < outcome.ticks / 10 || outcome.stops == 0 || outcome.skipped == 0)
    return fmt::format("{} of {} ticks pushed, {} stops, {} skipped: it proves nothing",
                       outcome.pushing_ticks, outcome.ticks, outcome.stops, outcome.skipped);
  return {};
}

model::Result<Outcome> soak_with(const std::vector<std::string>& limits, const std::string& path,
                                 std::uint64_t ticks, std::uint64_t seed) {
  const auto scene = hal::registry::load_scene(path, limits);
  if (!scene) return scene.error();
  return soak(*scene, ticks, seed);
}

int run(const std::string& path, std::uint64_t ticks, std::uint64_t seed) {
  std::signal(SIGINT, [](int) { interrupted.store(true); });
  const auto tight = soak_with(kTightLimits, path, ticks, seed);
  const std::uint64_t narrow_ticks = std::max<std::uint64_t>(ticks / 4, 100'000);
  const auto narrow = soak_with(kNarrowLimits, path, narrow_ticks, seed);
  for (const auto* outcome : {&tight, &narrow})
    if (!*outcome) {
      fmt::print(stderr, "tact-soak: {}\n", outcome->error().message);
      return 2;
    }
  nlohmann::ordered_json out = to_json(*tight, seed);
  out["narrow"] = to_json(*narrow, seed);
  fmt::print("{}\n", out.dump(2));
  std::string wrong = complaint(*tight, false);
  if (wrong.empty()) wrong = complaint(*narrow, true);
  if (!wrong.empty()) fmt::print(stderr, "tact-soak: {}\n", wrong);
  return wrong.empty() && !interrupted.load() ? 0 : 1;
}

}  // namespace
}  // namespace tact::soak

int main(int argc, char** argv) {
  CLI::App app{
      "tact-soak: random strokes, faults, stops and operators in simulated time; checks every "
      "tick."};
  std::string scene;
  std::uint64_t ticks = 200'000, seed = 1;
  app.add_option("SCENE", scene, "scene file with the simulated delta")->required();
  app.add_option("--ticks", ticks, "how many; a day at 1 kHz has 86400000 (200000)");
  app.add_option("--seed", seed, "another day (1)");
  CLI11_PARSE(app, argc, argv);
  return tact::soak::run(scene, ticks, seed);
}
