// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/session.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "firmware/console/operator_view.h"
#include "firmware/console/say.h"
#include "firmware/console/service_manager.h"
#include "firmware/run/loop_executor.h"
#include "firmware/run/loop_parts.h"
#include "firmware/run/operator_service.h"
#include "firmware/run/report.h"
#include "firmware/run/start_text.h"
#include "firmware/run/telemetry_setup.h"
#include "firmware/run/thread_costs.h"
#include "model/io/file_writer.h"
#include "model/time_ns.h"

namespace tact::firmware::run {
namespace {

using console::say;

int fail(const std::string& message, int status) {
  say(stderr, "tactd: {}\n", message);
  return status;
}

// All objects of one run, in the order of their construction.
class Session {
 public:
  Session(const model::scene::Scene& scene, const Options& options)
      : scene_(scene), options_(options) {
    rt_.core = options.core;
  }

  int run();

 private:
  std::optional<model::Error> open();
  std::optional<model::Error> open_telemetry();
  std::optional<model::Error> open_call_filter();
  std::optional<model::Error> run_real_time();
  void run_free();
  // Includes a fault of the watch that no tick has reported.
  model::Fault last_fault() const {
    const model::Fault latched = parts_.controller->newest().fault;
    return latched != model::Fault::kNone ? latched : requests_.fault.load();
  }
  // A stop request after the last tick is in no tick's state.
  loop::State last_state() const {
    return requests_.stop.load() ? loop::State::kStopped : parts_.controller->newest().state;
  }
  int report();
  RunFacts collect_facts(model::Fault fault, const std::string& detail) const;
  PartsSetup parts_setup() const {
    return {.simulated_time = options_.free_run, .non_rt = non_rt_, .rt = rt_};
  }
  std::int64_t period_ns() const { return model::period_ns(scene_.rate_Hz); }
  // One shape per frame of a viewer.
  std::uint64_t ticks_per_shape() const {
    return std::max(1ul, static_cast<std::uint64_t>(scene_.rate_Hz / scene_.frame_rate_Hz));
  }

  const model::scene::Scene& scene_;
  const Options& options_;
  pc::RtSettings rt_;
  std::optional<console::OperatorSignals> operator_;
  RealTime real_time_;
  bool non_rt_ = false;
  LoopParts parts_;
  std::unique_ptr<hal::sim::HandSocket> hand_socket_;
  std::unique_ptr<black_box::BlackBox> black_box_;
  std::optional<telemetry::Telemetry> telemetry_;
  loop::MonotonicClock monotonic_clock_;
  loop::SimulatedClock simulated_clock_;
  std::optional<loop::RtLoop> loop_;
  loop::Requests requests_;
  std::unique_ptr<watch::CallFilter> filter_;
  std::unique_ptr<LawUpdater> law_updater_;
  ThreadCosts costs_;
};

int Session::run() {
  pc::use_small_thread_stacks();
  operator_.emplace();
  if (!options_.free_run) {
    real_time_.enter(rt_);
    real_time_.report(rt_);
    non_rt_ = !real_time_.shortfalls().empty();
  }
  if (non_rt_ && options_.strict) return fail("refused by --strict: no hard real time here", 1);
  if (non_rt_)
    say(stderr, "tactd: no hard real time: force capped to {:g} %, records stamped non-rt\n",
        100.0 * gate::kNonRtForceShare);
  if (console::is_service() && !wait_for_bus(scene_, *operator_)) return 0;
  if (const auto error = open()) return fail(error->message, 2);
  for (const std::string& note : start_notes(scene_, parts_, options_.check))
    say(stderr, "tactd: {}\n", note);
  if (options_.check) {
    say(stdout, "{}\n", check_lines(scene_, parts_));
    return 0;
  }
  if (options_.has_json_file())
    if (const auto error = model::io::check_target(options_.json_path, "{"))
      return fail(error->message, 2);
  if (const auto error = open_telemetry()) return fail(error->message, 2);
  if (const auto error = open_call_filter()) return fail(error->message, 1);
  const bool arms_itself = hal::registry::is_simulated(scene_.device) && !console::is_service();
  requests_.arm_at_start.store(options_.arm || arms_itself);
  if (options_.free_run)
    run_free();
  else if (const auto error = run_real_time())
    return fail(error->message, 2);
  return report();
}

std::optional<model::Error> Session::open() {
  auto parts = open_loop_parts(scene_, parts_setup());
  if (!parts) return parts.error();
  parts_ = std::move(*parts);
  const auto asked_periods =
      static_cast<std::uint64_t>(std::ceil(options_.duration_s * scene_.rate_Hz));
  loop::Clock& clock =
      options_.free_run ? static_cast<loop::Clock&>(simulated_clock_) : monotonic_clock_;
  loop_.emplace(loop::LoopSettings{.period_ns = period_ns(),
                                   .max_ticks = options_.ticks,
                                   .max_periods = asked_periods,
                                   .ticks_per_shape = ticks_per_shape(),
                                   .grip = {.toggles = scene_.grip_toggles,
                                            .close_ratio = scene_.contact.grip_close_ratio,
                                            .open_ratio = scene_.contact.grip_open_ratio}},
                *parts_.device, *parts_.lines, *parts_.controller, clock, requests_, *parts_.ring);
  return std::nullopt;
}

std::optional<model::Error> Session::open_telemetry() {
  auto sinks = open_sinks({.scene = scene_,
                           .options = options_,
                           .parts = parts_,
                           .period_ns = period_ns(),
                           .force_share = parts_setup().force_share(),
                           .non_rt = non_rt_});
  if (!sinks) return sinks.error();
  hand_socket_ = std::move(sinks->hand);
  black_box_ = std::move(sinks->black_box);
  if (!sinks->no_black_box.empty()) say(stderr, "tactd: {}\n", sinks->no_black_box);
  telemetry_.emplace(*parts_.ring,
                     telemetry::FrameBuilder(parts_.tissue->law().contact_law(),
                                             parts_.controller->shapes(), non_rt_, sinks->utc),
                     telemetry::FramePace{scene_.frame_rate_Hz, period_ns()},
                     std::move(sinks->sinks), &requests_.fault);
  return std::nullopt;
}

std::optional<model::Error> Session::open_call_filter() {
  if (options_.free_run || options_.no_seccomp) return std::nullopt;
  auto filter =
      watch::CallFilter::make(parts_.device->loop_calls(), parts_.lines->loop_calls(), requests_);
  if (filter) {
    filter_ = std::move(*filter);
    return std::nullopt;
  }
  if (options_.seccomp) return model::Error{"refused by --seccomp: " + filter.error().message};
  say(stderr, "tactd: {}; --no-seccomp says that this is meant\n", filter.error().message);
  return std::nullopt;
}

void Session::run_free() {
  pc::flush_denormals();
  while (loop_->may_run()) {
    loop_->step();
    telemetry_->drain();
    if (loop_->statistics().ticks % ticks_per_shape() != 0) continue;
    telemetry_->publish();
    if (operator_->wait_for_end(0)) requests_.stop.store(true);
  }
  loop_->release_device();
}

std::optional<model::Error> Session::run_real_time() {
  say(stderr, "tactd: limits {} (the page shows them too)\n", parts_.limits_checksum);
  if (auto error = telemetry_->start()) return error;
  auto updater =
      LawUpdater::make({scene_, *parts_.device, requests_, loop_->contacts(), *telemetry_});
  if (!updater) return updater.error();
  law_updater_ = std::move(*updater);
  LoopExecutor executor({.runs = {{loop_->progress(), [this] { loop_->run(); }}},
                         .device = *parts_.device,
                         .lines = *parts_.lines,
                         .requests = requests_,
                         .filter = filter_.get(),
                         .guardian = parts_.guardian.get(),
                         .rt = rt_,
                         .period_ns = period_ns(),
                         .hard_real_time = !non_rt_});
  serve_operator({.scene = scene_,
                  .parts = parts_,
                  .signals = *operator_,
                  .requests = requests_,
                  .telemetry = *telemetry_,
                  .black_box = black_box_.get(),
                  .updater = *law_updater_,
                  .progress = loop_->progress(),
                  .period_ns = period_ns()},
                 executor);
  auto error = executor.join();
  costs_ = executor.costs();
  return error;
}

// Collects the final state of device, lines and threads, prints the report, and returns the status.
int Session::report() {
  const model::Fault fault = last_fault();
  const std::string detail = console::fault_detail_of(fault, *parts_.device, *parts_.lines);
  parts_.lines->stop();
  parts_.device->stop();
  if (hand_socket_) hand_socket_->stop();
  const auto log_error = telemetry_->stop();
  for (const std::string& message : black_box_ ? black_box_->news() : std::vector<std::string>{})
    say(stderr, "tactd: {}\n", message);
  const RunFacts facts = collect_facts(fault, detail);
  const std::string report = make_report(facts, loop_->statistics(), parts_.controller->gate(),
                                         pc::read_environment(scene_.hash));
  say(stdout, "{}\n",
      options_.json_path == "-" ? report : make_summary(facts, loop_->statistics()));
  if (options_.has_json_file())
    if (const auto error = model::io::write_file(options_.json_path, report + "\n"))
      return fail(error->message, 2);
  if (const std::string on = parts_.device->why_not_off(); !on.empty()) return fail(on, 1);
  if (log_error) return fail(log_error->message, 1);
  return fault == model::Fault::kNone ? 0 : 1;
}

RunFacts Session::collect_facts(model::Fault fault, const std::string& detail) const {
  rusage process{};
  getrusage(RUSAGE_SELF, &process);
  const loop::LoopStatistics& statistics = loop_->statistics();
  return {.scene_name = scene_.name,
          .law_title = parts_.tissue->law().title(),
          .device_name = parts_.device->info().name,
          .rate_Hz = scene_.rate_Hz,
          .duration_s =
              static_cast<double>(statistics.ticks + statistics.skipped_ticks) / scene_.rate_Hz,
          .force_limit_N = parts_.controller->gate().force_limit_N(),
          .limits_checksum = parts_.limits_checksum,
          .non_rt = non_rt_,
          .simulated_time = options_.free_run,
          .shortfalls = real_time_.shortfalls(),
          .costs = costs_,
          .device_counts = parts_.device->counters(),
          .dropped_records = parts_.ring->dropped(),
          .dropped_frames = telemetry_->dropped_frames(),
          .state = last_state(),
          .fault = fault,
          .fault_detail = detail,
          .refused_requests = requests_.refused.load(),
          .variants = law_updater_ ? law_updater_->count() : 0,
          .force_hash = telemetry_->force_hash(),
          .resident_peak_kB = process.ru_maxrss,
          .law_table_bytes = parts_.tissue->law().memory_bytes(),
          .call_filter = costs_.call_filter,
          .black_boxes = black_box_ ? black_box_->files() : std::vector<std::string>{}};
}

}  // namespace

int run_session(const model::scene::Scene& scene, const Options& options) {
  return Session(scene, options).run();
}

}  // namespace tact::firmware::run
