// SPDX-License-Identifier: Apache-2.0
#include "host/run/register_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/net/stop_signals.h"
#include "host/run/telemetry_client.h"
#include "host/tracking/operator_tracking.h"
#include "host/tracking/registration.h"
#include "model/io/json.h"
#include "model/result.h"

namespace tact::host::run {
namespace {

using model::Error;

constexpr int kGood = 0, kCheckFailed = 1, kBadInput = 2;
constexpr std::size_t kWorstNamed = 3;

void say(const std::string& message) { fmt::print(stderr, "tact-view: {}\n", message); }

double clock_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Collects pairs of a frame of tactd and a pose of the tracker; reports what it waits for.
class Collecting {
 public:
  Collecting(tracking::OperatorTracking& tracking, std::size_t wanted)
      : tracking_(tracking),
        tip_m_(*tracking.setup().body_of(tracking::BodyRole::kTool)->tip_m),
        wanted_(wanted) {}

  /// True when all poses are there.
  bool add(const record::Frame& frame) {
    const tracking::TrackedBody& tool = tracking_.now()[tracking::BodyRole::kTool];
    std::optional<Eigen::Vector3d> tip_m;
    // The raw pose: the filtered one lags behind.
    if (tool.state == tracking::BodyState::kTracked) tip_m = to_world(tool.raw, tip_m_);
    report_when_lost(tip_m.has_value());
    const Eigen::Vector3d device_m = Eigen::Vector3f(frame.tool_position_m).cast<double>();
    const Eigen::Vector3d velocity_mps = Eigen::Vector3f(frame.tool_velocity_mps).cast<double>();
    if (collector_.add(clock_s(), device_m, velocity_mps.norm(), tip_m)) {
      const std::size_t count = poses().size();
      say(fmt::format(
          "pose {} of {} taken{}", count, wanted_,
          count < wanted_ ? "; move the tool on by 15 mm or more and hold it still" : ""));
    }
    return poses().size() >= wanted_;
  }
  const std::vector<tracking::PosePair>& poses() const { return collector_.poses(); }

 private:
  void report_when_lost(bool is_seen) {
    if (is_seen != was_seen_ && !is_seen) say("the tracker does not see the tool now");
    if (is_seen != was_seen_ && is_seen) say("the tracker sees the tool; hold it still");
    was_seen_ = is_seen;
  }

  tracking::OperatorTracking& tracking_;
  Eigen::Vector3d tip_m_;
  std::size_t wanted_;
  tracking::PoseCollector collector_;
  bool was_seen_ = false;
};

/// The poses with the largest residuals, worst first.
std::vector<std::size_t> worst_of(const tracking::Registration& fit) {
  std::vector<std::size_t> order(fit.residual_m.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(
      order, [&](std::size_t a, std::size_t b) { return fit.residual_m[a] > fit.residual_m[b]; });
  // Sorted first, so that truncating keeps the worst.
  std::erase_if(order, [&](std::size_t i) { return !(fit.residual_m[i] > tracking::kDoubtful_m); });
  order.resize(std::min(order.size(), kWorstNamed));
  return order;
}

void report(const Options& options, const std::string& path,
            const std::vector<tracking::PosePair>& poses, const tracking::Registration& fit) {
  if (options.json) {
    const nlohmann::json all{{"file", path},
                             {"poses", poses.size()},
                             {"rms_m", fit.rms_m},
                             {"largest_m", fit.largest_m},
                             {"residuals_m", fit.residual_m}};
    fmt::print("{}\n", model::io::text_of(all));
  } else {
    fmt::print("{}: {} poses, residuals {:.2f} mm rms, {:.2f} mm at most\n", path, poses.size(),
               1e3 * fit.rms_m, 1e3 * fit.largest_m);
  }
  for (const std::size_t i : worst_of(fit)) {
    const Eigen::Vector3d p_mm = 1e3 * poses[i].device_m;
    say(fmt::format(
        "warning: pose {} at ({:.0f}, {:.0f}, {:.0f}) mm is off by {:.1f} mm, more than "
        "{:.0f}; hold the tool still with its markers in sight and register again",
        i + 1, p_mm.x(), p_mm.y(), p_mm.z(), 1e3 * fit.residual_m[i], 1e3 * tracking::kDoubtful_m));
  }
}

int finish(const Options& options, const std::vector<tracking::PosePair>& poses) {
  const model::Result<tracking::Registration> fit = tracking::fit_registration(poses);
  if (!fit) {
    say("no registration: " + fit.error().message);
    return kCheckFailed;
  }
  const std::string path = tracking::registration_path(options.tracking);
  if (const std::optional<Error> error = write_registration(path, *fit)) {
    say(error->message);
    return kBadInput;
  }
  report(options, path, poses, *fit);
  // Written in any case: a doubtful registration is better than none; the old file becomes .bak.
  return fit->largest_m <= tracking::kDoubtful_m ? kGood : kCheckFailed;
}

/// Error: why this description cannot be registered, and the remedy.
std::optional<Error> check(const std::string& path, const tracking::OperatorTracking& tracking) {
  const tracking::MarkerBody* tool = tracking.setup().body_of(tracking::BodyRole::kTool);
  if (tool == nullptr || !tool->tip_m) {
    return Error{fmt::format(
        "{}: no body has role = \"tool\" and tip_m; add the handle of the device", path)};
  }
  if (tracking.port() == 0) {
    return Error{fmt::format(
        "{}: registration needs udp_port, a recording does not follow the device; write udp_port "
        "for recording under [input]",
        path)};
  }
  // Its own section would have precedence over the written file, which would have no effect.
  if (tracking.setup().registered_by == path) {
    return Error{fmt::format(
        "{}: has a [registration] of its own, which would go first; remove it, then register",
        path)};
  }
  return std::nullopt;
}

}  // namespace

int register_tracker(const Options& options) {
  boost::asio::io_context io(1);
  tracking::OperatorTracking tracking(io, say);
  std::optional<Error> error =
      // In the tracker's own frame, because the fit goes from there to the device.
      tracking.open(options.tracking, tracking::OperatorTracking::Registered::kNo);
  if (!error) error = check(options.tracking, tracking);
  if (error) {
    say(error->message);
    return kBadInput;
  }
  Collecting collecting(tracking, options.poses);
  TelemetryClient client(
      io, options.socket,
      {.start = [](const record::RunHeader&, const record::MeshBytes&) { say("tactd is there"); },
       .frame =
           [&](const record::Frame& frame) {
             if (collecting.add(frame)) io.stop();
           },
       .lost =
           [&](const std::string& reason) {
             say(reason.empty() ? "waiting for tactd at " + options.socket : reason);
           }});
  net::StopSignals signals(io);
  if (const auto wrong = signals.wait([&io] { io.stop(); })) {
    say("Ctrl-C cannot be waited for: " + wrong.message());
    return kBadInput;
  }
  say(
      fmt::format("move the tool to {} places, 15 mm or more apart and not on a line, and hold it "
                  "still at each; Ctrl-C ends",
                  options.poses));
  tracking.start();
  client.start();
  io.run();
  return finish(options, collecting.poses());
}

}  // namespace tact::host::run
