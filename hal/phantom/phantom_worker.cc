// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/phantom_worker.h"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "hal/monotonic.h"
#include "hal/vendor_sdk/rotation.h"

namespace tact::hal::phantom {
namespace {

using model::Error;
using model::Fault;
using model::Quat;
using model::Vec3;
using vendor_sdk::LibraryPose;

constexpr unsigned short kHighestPriority = 0xFFFF;  // of the scheduler's callbacks
constexpr int kTimeout_ms = 1000;                    // until it is calibrated

/// Of a matrix by columns, the axes of the stylus along those of the device. The handle is +z of
/// the stylus and +z of the tool. x of the tool is -y of the stylus, y is x, so that an upright
/// stylus is the tool's identity (HD-7).
Quat orientation_of(const double transform[16]) {
  constexpr int kAxisOfStylus[3] = {1, 0, 2};
  constexpr double kSign[3] = {-1.0, 1.0, 1.0};
  double r[3][3];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      r[row][column] = kSign[column] * transform[4 * kAxisOfStylus[column] + kAxisOfDevice[row]];
  return vendor_sdk::quat_from_rotation(r);
}

}  // namespace

model::Result<std::shared_ptr<PhantomWorker>> PhantomWorker::start(const PhantomSession& session,
                                                                   double rate_Hz) {
  std::shared_ptr<PhantomWorker> worker(new PhantomWorker(session, rate_Hz));
  const HdFunctions& hd = session.hd;
  worker->expect_threads(1);
  worker->self_ = worker;  // the library must not call what is gone
  const auto does_not_start = [](unsigned code) {
    return Error{fmt::format("the PHANTOM's scheduler does not start: {}", text_of_hd_error(code))};
  };
  hd.set_scheduler_rate(static_cast<unsigned long>(kPhantomRate_Hz));
  const unsigned long scheduled = hd.schedule(on_cycle, worker.get(), kHighestPriority);
  if (const unsigned code = take_hd_errors(hd); code != 0) {
    hd.unschedule(scheduled);
    hd.disable_device(session.id);
    worker->self_.reset();  // no call comes: the scheduler has not been started
    return does_not_start(code);
  }
  hd.start_scheduler();
  if (const unsigned code = take_hd_errors(hd); code != 0) {
    // From here on a call may come at any time, so the worker is not freed: it keeps itself.
    if (!worker->stop()) worker->close();
    return does_not_start(code);
  }
  if (auto error = worker->wait_until_calibrated()) return *error;
  return worker;
}

std::optional<Error> PhantomWorker::wait_until_calibrated() {
  for (int i = 0; i < kTimeout_ms && !calibrated_ && first_cause().fault == Fault::kNone; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (calibrated_ && first_cause().fault == Fault::kNone) return std::nullopt;
  // False: the library hangs, with its forces off, and the device stays open until tactd ends.
  static_cast<void>(stop());
  if (const std::string why = fault_text(monotonic_ns()); !why.empty()) return Error{why};
  const std::string device = session_.model.empty() ? "PHANTOM" : session_.model;
  if (calibration_ == 0)
    return Error{fmt::format(
        "the library does not drive the {}: its scheduler made no call within a second; end other "
        "programs of OpenHaptics, then start tactd again",
        device)};
  return Error{fmt::format("the {} is not calibrated; {}, then start tactd again", device,
                           calibration_remedy(session_))};
}

std::string PhantomWorker::cause_text() const {
  // What and remedy, by Source; {} is what the library or its model returns.
  constexpr std::array kTexts{
      "", "the PHANTOM failed: {}",
      "the PHANTOM's force output is off; end other programs that use the device, then start tactd "
      "again",
      "the PHANTOM has lost its calibration; {}, then start tactd again",
      "the PHANTOM reports a pose that is no number; check its cable, calibrate it, then start "
      "tactd "
      "again"};
  const FaultCause reported = first_cause();
  const bool failed = static_cast<Source>(reported.kind) == Source::kError;
  return fmt::format(fmt::runtime(kTexts.at(reported.kind)),
                     failed ? text_of_hd_error(reported.code) : calibration_remedy(session_));
}

unsigned PhantomWorker::on_cycle(void* of) {
  return static_cast<PhantomWorker*>(of)->cycle() ? kHdContinue : kHdDone;
}

/// False when the library shall call no more.
bool PhantomWorker::cycle() {
  if (!entered_) enter_fifo("tact-phantom");
  entered_ = true;
  session_.hd.make_current(session_.id);
  if (!quits() && first_cause().fault == Fault::kNone) {
    exchange();
    cycle_ended(monotonic_ns());
    return true;
  }
  // In a cycle of its own after a fault, as the library takes one frame in each.
  let_go();
  cycles_ended();
  // If no thread waits for so long, this one is the last to use the worker.
  const std::shared_ptr<PhantomWorker> last = std::move(self_);
  thread_ends();  // a thread that waits may close the device now
  return false;
}

/// One pose, one force.
void PhantomWorker::exchange() {
  LibraryPose pose{.position_m = {}, .orientation = {}, .stamp_ns = monotonic_ns()};
  session_.hd.begin_frame(session_.id);
  const bool sound = evaluate(pose);
  // The time once more: the library may have waited for the state, and the command has aged.
  const auto force = sound ? next_force(monotonic_ns()) : std::nullopt;
  const Vec3 force_N = force ? force->wrench.force_N : Vec3{};
  send(force_N);
  if (!sound) return;
  if (force_N == Vec3{}) switch_output();
  if (errors()) return;
  if (powered_for_sure() && session_.hd.is_enabled(kHdForceOutput) == 0) {
    fail(Fault::kForceOff, Source::kForceOff, 0);
    return;
  }
  if (calibrated_) publish(pose);
}

/// The state of this frame; false when no force may follow it.
bool PhantomWorker::evaluate(LibraryPose& pose) {
  const HdFunctions& hd = session_.hd;
  double transform[16] = {};
  hd.get_doubles(kHdCurrentTransform, transform);
  int buttons = 0;
  hd.get_integers(kHdCurrentButtons, &buttons);
  const unsigned calibration = hd.check_calibration();
  // Before any force alone: an update during a run might move the position under the force (HD-4).
  // Encoders that a person resets by hand are left to the vendor's program.
  const int ways = session_.calibration_styles & (kHdAuto | kHdInkwell);
  if (calibration == kHdNeedsUpdate && !calibrated_ && ways != 0)
    hd.update_calibration((ways & kHdAuto) != 0 ? kHdAuto : kHdInkwell);
  calibration_ = calibration;
  if (errors()) return false;
  if (calibrated_ && calibration != kHdCalibrated && calibration != kHdNeedsUpdate)
    return fail(Fault::kHomingLost, Source::kCalibration, calibration);
  if (calibration == kHdCalibrated) calibrated_ = true;
  if (!calibrated_) return true;
  pose.position_m = to_w(transform + 12, 1e-3) - session_.middle_m;
  pose.grip_ratio = (buttons & kHdButton1) != 0 ? 1.0 : 0.0;
  if (session_.wrist) pose.orientation = orientation_of(transform);
  const bool reported = is_finite(pose.position_m) && std::isfinite(pose.orientation.w);
  return reported || fail(Fault::kSampleNotFinite, Source::kPose, 0);
}

/// Takes the library's errors; true when there was one.
bool PhantomWorker::errors() {
  const unsigned code = take_hd_errors(session_.hd);
  return code != 0 && !fail(fault_of_hd_error(code), Source::kError, code);
}

/// Ends the frame with this force.
void PhantomWorker::send(const Vec3& force_N) {
  double of_device[3];
  to_device(force_N, of_device);
  session_.hd.set_doubles(kHdCurrentForce, of_device);
  session_.hd.end_frame(session_.id);
}

/// No answer is looked at: each step is tried, also if the one before failed.
void PhantomWorker::let_go() {
  session_.hd.begin_frame(session_.id);
  send({});
  session_.hd.disable(kHdForceOutput);
  take_hd_errors(session_.hd);
}

bool PhantomWorker::switch_forces(bool on) {
  wanted_on_ = on;
  return true;  // done after the frame, and what is wrong is on the stack of errors
}

/// After a frame that carried zero.
void PhantomWorker::switch_output() {
  if (wanted_on_ == output_on_) return;
  output_on_ = wanted_on_;
  if (output_on_)
    session_.hd.enable(kHdForceOutput);
  else
    session_.hd.disable(kHdForceOutput);
}

void PhantomWorker::close() {
  session_.hd.stop_scheduler();
  session_.hd.disable_device(session_.id);
}

/// False, for the caller to pass on.
bool PhantomWorker::fail(Fault fault, Source source, unsigned code) {
  keep({.fault = fault, .kind = static_cast<std::uint8_t>(source), .code = code});
  return false;
}

}  // namespace tact::hal::phantom
