#include "firmware/session.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "firmware/loop_parts.h"
#include "firmware/operator_signals.h"
#include "firmware/operator_view.h"
#include "firmware/pc_check.h"
#include "firmware/report.h"
#include "firmware/telemetry_setup.h"

namespace tact::firmware {
namespace {

using model::Error;
using model::Result;

constexpr timespec kStatusPeriod{.tv_sec = 0, .tv_nsec = 200'000'000};

int fail(const std::string& sentence, int status) {
  fmt::print(stderr, "tactd: {}\n", sentence);
  return status;
}

// The short form of tact-doctor: what of this PC will make the loop late, in one line.
void tell_red_rows(const RtSettings& settings) {
  const std::string red =
      name_red_rows(check_pc({.files = PcFiles{}, .core = choose_core(settings)}));
  if (!red.empty()) fmt::print(stderr, "tactd: {}\n", red);
}

// Everything of one run, in the order in which it comes to life.
class Session {
 public:
  Session(const model::Scene& scene, const Options& options) : scene_(scene), options_(options) {
    rt_.core = options.core;
  }

  int run();

 private:
  std::optional<Error> open();
  std::optional<Error> open_telemetry();
  void run_real_time();
  void run_free();
  void in_loop_thread();
  void watch();
  int report();
  PartsSetup parts_setup() const {
    return {.simulated_time = options_.free_run, .non_rt = non_rt_, .rt = rt_};
  }
  // As often as a viewer looks.
  std::uint64_t ticks_per_shape() const {
    return std::max(1ul, static_cast<std::uint64_t>(scene_.rate_Hz / scene_.frame_rate_Hz));
  }

  const model::Scene& scene_;
  const Options& options_;
  RtSettings rt_;
  std::optional<OperatorSignals> operator_;
  std::optional<ProcessSetup> process_;
  std::vector<Shortfall> shortfalls_;
  bool non_rt_ = false;
  LoopParts parts_;
  std::unique_ptr<hal::HandSocket> hand_socket_;
  std::optional<Telemetry> telemetry_;
  MonotonicClock monotonic_clock_;
  SimulatedClock simulated_clock_;
  std::optional<RtLoop> loop_;
  Requests requests_;
  std::atomic<bool> loop_ended_{false};
  ThreadCosts costs_;
};

int Session::run() {
  use_small_thread_stacks();
  operator_.emplace();
  if (!options_.free_run) {
    process_.emplace(shortfalls_);
    for (Shortfall& s : probe_rt_thread(rt_)) shortfalls_.push_back(std::move(s));
    non_rt_ = !shortfalls_.empty();
  }
  for (const Shortfall& s : shortfalls_) fmt::print(stderr, "tactd: {}\n", s.sentence);
  if (!options_.free_run) tell_red_rows(rt_);
  if (non_rt_ && options_.strict) return fail("refused by --strict: no hard real time here", 1);
  if (non_rt_)
    fmt::print(stderr, "tactd: no hard real time: force capped to {:g} %, records stamped non-rt\n",
               100.0 * kNonRtForceShare);
  if (const auto error = open()) return fail(error->sentence, 2);
  if (options_.check) {
    fmt::print("{}\n", make_check_line(scene_, parts_.device->info().name, parts_.tissue->law(),
                                       parts_.stiffness, parts_.time));
    return 0;
  }
  if (!options_.json_path.empty() && options_.json_path != "-" &&
      !std::ofstream(options_.json_path, std::ios::app))
    return fail(options_.json_path + ": cannot be written; name a file in a folder of yours", 2);
  if (const auto error = open_telemetry()) return fail(error->sentence, 2);
  requests_.arm.store(options_.arm || hal::is_simulated(scene_.device));
  if (options_.free_run)
    run_free();
  else
    run_real_time();
  return report();
}

std::optional<Error> Session::open() {
  auto parts = open_loop_parts(scene_, parts_setup());
  if (!parts) return parts.error();
  parts_ = std::move(*parts);
  const auto asked_periods =
      static_cast<std::uint64_t>(std::ceil(options_.seconds * scene_.rate_Hz));
  Clock& clock = options_.free_run ? static_cast<Clock&>(simulated_clock_) : monotonic_clock_;
  loop_.emplace(LoopSettings{.period_ns = period_ns(scene_),
                             .max_ticks = options_.ticks,
                             .max_periods = asked_periods,
                             .ticks_per_shape = ticks_per_shape()},
                *parts_.device, *parts_.lines, *parts_.controller, clock, requests_, *parts_.ring);
  return std::nullopt;
}

std::optional<Error> Session::open_telemetry() {
  auto outlets = open_outlets({.scene = scene_,
                               .options = options_,
                               .tissue = *parts_.tissue,
                               .device = *parts_.device,
                               .limits = parts_.limits,
                               .period_ns = period_ns(scene_),
                               .force_share = parts_setup().force_share(),
                               .gate = parts_.controller->gate(),
                               .non_rt = non_rt_});
  if (!outlets) return outlets.error();
  hand_socket_ = std::move(outlets->hand);
  telemetry_.emplace(
      *parts_.ring,
      FrameBuilder(parts_.tissue->law().site_law(), parts_.controller->shapes(), non_rt_),
      scene_.frame_rate_Hz, std::move(outlets->socket), std::move(outlets->log));
  return std::nullopt;
}

void Session::run_free() {
  flush_denormals();
  const auto ticks_per_frame = static_cast<std::uint64_t>(scene_.rate_Hz / scene_.frame_rate_Hz);
  while (loop_->may_run()) {
    loop_->step();
    telemetry_->drain();
    if (loop_->statistics().ticks % (ticks_per_frame + 1) != 0) continue;
    telemetry_->publish();
    operator_->obey(requests_, {});
  }
  loop_->let_go();
}

void Session::run_real_time() {
  telemetry_->start();
  std::thread loop_thread(&Session::in_loop_thread, this);
  watch();
  loop_thread.join();
}

void Session::in_loop_thread() {
  costs_ = run_as_loop_thread(rt_, [this] { loop_->run(); });
  parts_.device->stop();  // at once: drives watch for their host
  loop_ended_.store(true);
}

// The main thread while the loop runs: waits for signals, tells what happens.
void Session::watch() {
  OperatorView view(*parts_.device, *parts_.lines, requests_.arm.load());
  while (!loop_ended_.load()) {
    operator_->obey(requests_, kStatusPeriod);
    view.show(telemetry_->newest_frame());
  }
  view.end();
}

int Session::report() {
  const std::string trouble =
      trouble_behind(parts_.controller->newest().fault, *parts_.device, *parts_.lines);
  parts_.lines->stop();
  parts_.device->stop();
  if (hand_socket_) hand_socket_->stop();
  const std::string log_trouble = telemetry_->stop();
  rusage process{};
  getrusage(RUSAGE_SELF, &process);
  const LoopStatistics& statistics = loop_->statistics();
  const RunFacts facts{
      .scene_name = scene_.name,
      .law_title = parts_.tissue->law().title(),
      .device_name = parts_.device->info().name,
      .rate_Hz = scene_.rate_Hz,
      .duration_s =
          static_cast<double>(statistics.ticks + statistics.skipped_ticks) / scene_.rate_Hz,
      .force_limit_N = parts_.controller->gate().force_limit_N(),
      .non_rt = non_rt_,
      .simulated_time = options_.free_run,
      .shortfalls = shortfalls_,
      .costs = costs_,
      .dropped_records = parts_.ring->dropped(),
      .dropped_frames = telemetry_->dropped_frames(),
      .state = parts_.controller->newest().state,
      .fault = parts_.controller->newest().fault,
      .trouble = trouble,
      .force_hash = telemetry_->force_hash(),
      .resident_peak_kB = process.ru_maxrss,
      .law_table_bytes = parts_.tissue->law().memory_bytes()};
  const std::string json =
      make_report(facts, statistics, parts_.controller->gate(), read_environment(scene_.hash))
          .dump(2);
  if (options_.json_path == "-")
    fmt::print("{}\n", json);
  else
    fmt::print("{}\n", make_summary(facts, statistics));
  if (!options_.json_path.empty() && options_.json_path != "-") {
    std::ofstream file(options_.json_path);
    if (!(file << json << '\n')) return fail(options_.json_path + ": cannot be written", 2);
  }
  if (!log_trouble.empty()) return fail(log_trouble, 1);
  return facts.fault == Fault::kNone ? 0 : 1;
}

}  // namespace

int run_session(const model::Scene& scene, const Options& options) {
  return Session(scene, options).run();
}

}  // namespace tact::firmware
