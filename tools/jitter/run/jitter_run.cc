// SPDX-License-Identifier: Apache-2.0
#include "tools/jitter/run/jitter_run.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <thread>

#include "firmware/loop/rt_loop.h"
#include "firmware/run/loop_parts.h"
#include "hal/threads/thread.h"
#include "model/time_ns.h"
#include "tools/jitter/run/bare_loop.h"
#include "tools/jitter/run/follower.h"
#include "tools/jitter/run/live_line.h"
#include "tools/jitter/run/load.h"
#include "tools/jitter/run/peer.h"
#include "tools/jitter/trace/marker.h"

namespace tact::tools::jitter {
namespace {

using namespace firmware;
using namespace std::chrono_literals;
using model::Error;
using model::Result;
using SteadyClock = std::chrono::steady_clock;

constexpr double kBareRate_Hz = 1000.0;
constexpr double kLongestSlice_s = 5.0;
constexpr double kThresholdShare = 0.1;  // of the period: what integrators allow a wake-up
constexpr auto kDrainPeriod = 5ms;       // 50 ticks at 10 kHz, of 4096 that the ring holds
constexpr auto kCostPeriod = 100ms;
constexpr double kLoadLeft_s = 60.0;  // beyond the run: it ends by itself should we be killed
constexpr auto kLoadNeeds = 1s;       // until all of its processes run

// Everything of one measurement, in the order in which it comes to life.
class Run {
 public:
  explicit Run(const JitterOptions& options) : options_(options) {}
  Result<JitterResult> run();

 private:
  std::optional<Error> open();
  std::optional<Error> measure();
  std::optional<Error> run_slice(double duration_s, bool last);
  void follow(const std::atomic<bool>& ended);
  void drain();
  void explain();
  bool is_hardware() const {
    return !options_.bare && !hal::registry::is_simulated(scene_->device);
  }
  // Drives and safety lines hold a pause for a fault.
  bool in_one_piece() const { return is_hardware() || (scene_ && lines().wired()); }
  const hal::LinesSettings& lines() const { return scene_->device.of<hal::LinesSettings>(); }
  std::int64_t loop_period_ns() const { return model::period_ns(result_.rate_Hz); }
  firmware::loop::TickRing& ring() { return options_.bare ? *bare_ring_ : *parts_.ring; }

  const JitterOptions& options_;
  JitterResult result_;
  firmware::pc::RtSettings rt_;
  std::optional<firmware::pc::ProcessSetup> process_;
  std::optional<model::scene::Scene> scene_;
  firmware::run::LoopParts parts_;
  std::unique_ptr<firmware::loop::TickRing> bare_ring_;
  firmware::loop::MonotonicClock clock_;
  firmware::loop::Requests requests_;
  std::optional<TraceMarker> marker_;
  std::optional<LiveLine> live_;
  std::unique_ptr<LoopBack> loop_back_;
  firmware::pc::PcFiles files_;
  std::atomic<int> loop_thread_{0};
  Costs before_;
  SteadyClock::time_point looked_;  // at the kernel's counters
};

Result<JitterResult> Run::run() {
  firmware::pc::use_small_thread_stacks();
  rt_.core = options_.core;
  // Before anything of the scene allocates: memory is locked from here on.
  process_.emplace(result_.shortfalls);
  for (firmware::pc::Shortfall& s : probe_rt_threads(rt_))
    result_.shortfalls.push_back(std::move(s));
  result_.non_rt = !result_.shortfalls.empty();
  result_.core = choose_core(rt_);
  result_.priority = rt_.priority;
  if (auto error = open()) return *error;
  const double threshold_us =
      options_.threshold_us > 0.0 ? options_.threshold_us : kThresholdShare * 1e6 / result_.rate_Hz;
  result_.sink = std::make_unique<TickSink>(SinkSettings{
      .period_ns = loop_period_ns(), .threshold_ns = std::llround(1e3 * threshold_us)});
  // Before the loop: while it runs nothing is opened.
  marker_.emplace(files_, options_.stop_trace);
  result_.has_marker = marker_->is_open();
  if (options_.stop_trace && !marker_->is_open())
    return Error{
        "/sys/kernel/tracing/trace_marker cannot be written; be root and mount tracefs: "
        "sudo mount -t tracefs tracefs /sys/kernel/tracing"};
  result_.pc = firmware::pc::check_pc({files_, hal::registry::usb_parts(), result_.core});
  result_.environment = firmware::pc::read_environment(result_.scene_hash);
  if (auto error = measure()) return *error;
  if (loop_back_) result_.pin.emplace(loop_back_->stop());
  if (!options_.bare) {
    const model::FaultEntry& fault = model::describe(parts_.controller->newest().fault);
    if (fault.fault != model::Fault::kNone)
      result_.fault = fmt::format("{}: {}; {}", fault.name, fault.cause, fault.remedy);
    parts_.lines->stop();
    parts_.device->stop();
  }
  return std::move(result_);
}

std::optional<Error> Run::open() {
  result_.rate_Hz = options_.rate_Hz > 0.0 ? options_.rate_Hz : kBareRate_Hz;
  result_.subject = "bare loop";
  if (options_.bare) {
    bare_ring_ = std::make_unique<firmware::loop::TickRing>();
    return std::nullopt;
  }
  program::SceneArguments arguments = options_.scene;
  if (options_.rate_Hz > 0.0)
    arguments.overrides.push_back(fmt::format("rate_Hz={}", options_.rate_Hz));
  if (options_.scope_pin >= 0)
    arguments.overrides.push_back(fmt::format("device.lines.scope={}", options_.scope_pin));
  auto scene = arguments.load(hal::registry::visit_device);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  auto parts = firmware::run::open_loop_parts(*scene_, {.non_rt = result_.non_rt, .rt = rt_});
  if (!parts) return parts.error();
  parts_ = std::move(*parts);
  result_.rate_Hz = scene_->rate_Hz;
  result_.scene_hash = scene_->hash;
  result_.subject = fmt::format("{} on {}, law {}", scene_->name, parts_.device->info().name,
                                parts_.tissue->law().title());
  if (options_.loop_back >= 0) {
    auto edges = hal::gpio::open_edge_monitor(lines().chip, options_.loop_back, "tact-jitter");
    if (!edges) return edges.error();
    auto loop_back = LoopBack::start(std::move(*edges), loop_period_ns());
    if (!loop_back) return loop_back.error();
    loop_back_ = std::move(*loop_back);
  }
  result_.armed = options_.arm || !is_hardware();
  requests_.arm_at_start.store(result_.armed);
  return std::nullopt;
}

std::optional<Error> Run::measure() {
  auto folder = program::ScratchFolder::make("tact-jitter");
  if (!folder) return folder.error();
  std::optional<program::RunningProgram> load;
  if (!options_.load.empty()) {
    auto started = start_load(options_.load, *folder, kLoadLeft_s + 3.0 * options_.duration_s);
    if (!started) return started.error();
    load.emplace(std::move(*started));
    result_.load = fmt::format("{}", fmt::join(options_.load, ","));
    std::this_thread::sleep_for(kLoadNeeds);
    if (!load->is_running()) return Error{"stress-ng ended at once; try its --load alone by hand"};
  }
  if (options_.peer) result_.peer.emplace();
  result_.peer_gate = options_.peer_gate;
  if (options_.live) live_.emplace(options_.duration_s);
  const auto slices = slices_of(options_.duration_s, options_.peer && !in_one_piece());
  for (std::size_t i = 0; i < slices.size(); ++i) {
    const double slice_s = slices[i];
    if (auto error = run_slice(slice_s, i + 1 == slices.size())) return error;
    if (program::is_interrupted()) break;
    if (!options_.peer) continue;
    Series turn;
    if (auto error = run_cyclictest({.core = result_.core,
                                     .priority = result_.priority,
                                     .period_ns = loop_period_ns(),
                                     .duration_s = slice_s},
                                    *folder, turn)) {
      if (!program::was_interrupted(*error)) return error;
      break;
    }
    result_.peer->add(turn);
    if (const auto ratio = ratio_at_p999(result_.sink->slice_wake(), turn))
      result_.turn_ratios.push_back(*ratio);
  }
  const TickSink& sink = *result_.sink;
  result_.interrupted = program::is_interrupted();
  result_.measured_s =
      static_cast<double>(sink.ticks() + sink.skipped() + sink.unseen()) / result_.rate_Hz;
  // A load that died in between would make the numbers better than they are.
  if (load && !load->is_running()) return Error{"stress-ng ended before the loop; nothing counts"};
  return std::nullopt;
}

// Letting go takes the power of an armed device away, which is a fault in the next slice: between
// slices, which only a simulated device has, the loop pauses with its last force.
std::optional<Error> Run::run_slice(double duration_s, bool last) {
  const auto periods = static_cast<std::uint64_t>(std::ceil(duration_s * result_.rate_Hz));
  std::optional<firmware::loop::RtLoop> loop;
  std::optional<BareLoop> bare;
  if (options_.bare)
    bare.emplace(loop_period_ns(), periods, clock_, requests_.stop, ring());
  else
    loop.emplace(
        firmware::loop::LoopSettings{.period_ns = loop_period_ns(), .max_periods = periods},
        *parts_.device, *parts_.lines, *parts_.controller, clock_, requests_, ring());
  result_.sink->begin_slice();
  std::atomic<bool> ended{false};
  firmware::run::ThreadCosts costs;
  // follow() waits for the new thread's number: the counters of the old one are gone.
  loop_thread_.store(0);
  auto thread = hal::threads::start_thread("tact-loop", [&] {
    costs = firmware::run::run_as_loop_thread(rt_, [&] {
      loop_thread_.store(gettid());
      if (bare) bare->run();
      while (loop && !last && loop->may_run()) loop->step();
      if (loop && (last || requests_.stop.load())) loop->run();  // what is left, then let go
    });
    if (is_hardware()) parts_.device->stop();  // at once: drives watch for their host
    ended.store(true);
  });
  if (!thread) return thread.error();
  follow(ended);
  thread->join();
  drain();
  add_to(result_.thread, costs);
  return std::nullopt;
}

// The thread beside the loop: empties the ring, reads the kernel's counters, shows a line. As an
// ordinary thread it would get no CPU under load for longer than the ring lasts.
void Run::follow(const std::atomic<bool>& ended) {
  const Follower follower(result_.core);
  while (loop_thread_.load() == 0 && !ended.load()) std::this_thread::sleep_for(1ms);
  before_ = read_costs(files_, loop_thread_.load(), result_.core);
  looked_ = SteadyClock::now();
  while (!ended.load()) {
    if (program::is_interrupted()) requests_.stop.store(true);
    if (parts_.guardian && parts_.guardian->is_lost()) requests_.trip(model::Fault::kGuardianLost);
    drain();
    if (SteadyClock::now() - looked_ >= kCostPeriod) explain();
    if (live_) live_->show(*result_.sink);
    std::this_thread::sleep_for(kDrainPeriod);
  }
  drain();
  explain();
  if (live_) live_->clear();
}

void Run::drain() {
  firmware::loop::TickRecord record;
  while (ring().pop(record)) result_.sink->add(record);
}

// What the kernel counted since the last look belongs to the late ticks since then.
void Run::explain() {
  const Costs now = read_costs(files_, loop_thread_.load(), result_.core);
  const Costs delta = now - before_;
  const std::chrono::duration<double> looked_away = SteadyClock::now() - looked_;
  looked_ = SteadyClock::now();
  for (LateTick* late : result_.sink->new_late_ticks()) {
    late->attribution = fmt::format("{} (in {:.2f} s)", describe(delta), looked_away.count());
    marker_->write(fmt::format("tact-jitter: tick {} due {} ns came to its force {} us late",
                               late->times.tick, late->times.due_ns, late->worst_ns / 1000));
  }
  // The thread may be gone by now, and its counters with it; the last full reading counts.
  add_to(result_.costs, delta);
  before_ = now;
}

}  // namespace

Result<JitterResult> run_jitter(const JitterOptions& options) { return Run(options).run(); }

std::vector<double> slices_of(double duration_s, bool takes_turns) {
  if (!takes_turns) return {duration_s};
  const double slices = std::max(2.0, std::ceil(duration_s / kLongestSlice_s));
  return std::vector<double>(static_cast<std::size_t>(slices), duration_s / slices);
}

}  // namespace tact::tools::jitter
