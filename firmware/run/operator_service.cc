// SPDX-License-Identifier: Apache-2.0
#include "firmware/run/operator_service.h"

#include "firmware/console/request_handler.h"
#include "firmware/console/service_manager.h"
#include "firmware/loop/clock.h"
#include "firmware/loop/release_schedule.h"

namespace tact::firmware::run {
namespace {

constexpr std::int64_t kStatusPeriod_ns = 200'000'000;

}  // namespace

void serve_operator(const ServiceParts& s, LoopExecutor& executor) {
  console::OperatorView view(*s.parts.device, *s.parts.lines, s.requests.arm_at_start.load(),
                             s.scene.path);
  const auto control = console::open_control(s.scene.path, view);
  const auto set = [&](console::ControlRequest request, const std::string& numbers) {
    if (const auto refusal = s.updater.request(std::move(request), numbers)) view.report(*refusal);
  };
  console::RequestHandler request_handler(
      s.signals, s.requests, view, [&s] { return s.telemetry.newest_frame(); }, control.get(),
      &s.progress, console::pause_a_moment, set);
  console::ServiceManager service;
  loop::MonotonicClock clock;
  const auto report_news = [&] {
    if (const auto change = s.updater.poll()) view.report(*change);
    if (const auto news = s.telemetry.record_news()) view.report(*news);
    if (s.black_box == nullptr) return;
    for (const std::string& message : s.black_box->news()) view.report(message);
  };
  while (!executor.ended()) {
    const std::int64_t now_ns = clock.now_ns();
    const bool is_waited_for = LawUpdater::waits(s.updater.state());
    const std::int64_t pause_ns = is_waited_for ? LawUpdater::kPollPeriod_ns : kStatusPeriod_ns;
    const std::int64_t until_ns = loop::next_half_way_ns(now_ns + pause_ns, s.period_ns);
    request_handler.serve(until_ns - now_ns);
    service.report({now_ns, view.why_not_arm().empty(), s.progress.ticks(), view.status()});
    report_news();
    if (!executor.hangs()) continue;
    executor.leave_behind(1, [&] {
      view.report(
          "the loop does not come back, so tactd ends without it: switch the device's power off");
      // The loop is lost; an error of a sink no longer matters.
      static_cast<void>(s.telemetry.stop());
      view.show(s.telemetry.newest_frame());
      report_news();
    });
  }
  view.end();
}

}  // namespace tact::firmware::run
