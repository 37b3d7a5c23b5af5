// SPDX-License-Identifier: Apache-2.0
#include "hal/phantom/phantom_worker.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "hal/maker_library/rotation.h"
#include "hal/monotonic.h"
#include "hal/phantom/hd_words.h"

namespace tact::hal::phantom {
namespace {

using maker_library::LibraryPose;
using model::Error;
using model::Fault;
using model::Quat;
using model::Vec3;

constexpr unsigned short kFirst = 0xFFFF;  // of the scheduler's callbacks
constexpr int kPatience_ms = 1000;         // until it is calibrated

/// Of a matrix by columns; its axes renamed on both sides.
Quat orientation_of(const double transform[16]) {
  constexpr int kAxis[3] = {2, 0, 1};  // of the device, for x, y, z of W
  double r[3][3];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      r[row][column] = transform[4 * kAxis[column] + kAxis[row]];
  return maker_library::quat_from_rotation(r);
}

}  // namespace

model::Result<std::shared_ptr<PhantomWorker>> PhantomWorker::start(const PhantomSession& session,
                                                                   double rate_Hz) {
  std::shared_ptr<PhantomWorker> worker(new PhantomWorker(session, rate_Hz));
  const HdFunctions& hd = session.hd;
  worker->expect_threads(1);
  worker->self_ = worker;  // the library must not call what is gone
  hd.set_scheduler_rate(static_cast<unsigned long>(kPhantomRate_Hz));
  const unsigned long scheduled = hd.schedule(on_cycle, worker.get(), kFirst);
  hd.start_scheduler();
  if (const unsigned code = take_hd_errors(hd); code != 0) {
    hd.unschedule(scheduled);
    hd.stop_scheduler();
    hd.disable_device(session.id);
    worker->self_.reset();  // nobody calls any more
    return Error{
        fmt::format("the PHANTOM's scheduler does not start: {}", words_of_hd_error(code))};
  }
  if (auto error = worker->wait_until_calibrated()) return *error;
  return worker;
}

std::optional<Error> PhantomWorker::wait_until_calibrated() {
  for (int i = 0; i < kPatience_ms && !calibrated_ && trouble().fault == Fault::kNone; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (calibrated_ && trouble().fault == Fault::kNone) return std::nullopt;
  stop();
  if (const std::string why = words(); !why.empty()) return Error{why};
  const std::string device = session_.model.empty() ? "PHANTOM" : session_.model;
  if (calibration_ == 0)
    return Error{fmt::format(
        "the library does not drive the {}: its scheduler made no call within a second; end other "
        "programs of OpenHaptics, then start tactd again",
        device)};
  return Error{fmt::format("the {} is not calibrated; {}, then start tactd again", device,
                           calibration_cure(session_))};
}

std::string PhantomWorker::words() const {
  const auto told = trouble();
  switch (static_cast<Source>(told.source)) {
    case Source::kNone:
      return {};
    case Source::kError:
      return fmt::format("the PHANTOM failed: {}", words_of_hd_error(told.code));
    case Source::kForceOff:
      return "the PHANTOM's force output is off; end other programs that use the device, then "
             "start tactd again";
    case Source::kCalibration:
      break;
  }
  return fmt::format("the PHANTOM has lost its calibration; {}, then start tactd again",
                     calibration_cure(session_));
}

unsigned PhantomWorker::on_cycle(void* of) {
  return static_cast<PhantomWorker*>(of)->cycle() ? kHdContinue : kHdDone;
}

/// False when the library shall call no more.
bool PhantomWorker::cycle() {
  if (!entered_) enter_fifo("tact-phantom");
  entered_ = true;
  session_.hd.make_current(session_.id);
  if (!quits() && trouble().fault == Fault::kNone) {
    exchange();
    // At once; the zero force follows in the next cycle, as the library takes one frame in each.
    if (trouble().fault != Fault::kNone) session_.hd.disable(kHdForceOutput);
    return true;
  }
  let_go();
  // When nobody has waited so long, this thread is the last to know the worker.
  const std::shared_ptr<PhantomWorker> last = std::move(self_);
  thread_ends();  // whoever waits may close the device now
  return false;
}

/// One pose, one force.
void PhantomWorker::exchange() {
  const HdFunctions& hd = session_.hd;
  LibraryPose pose{.position_m = {}, .orientation = {}, .stamp_ns = monotonic_ns()};
  double transform[16] = {};
  hd.begin_frame(session_.id);
  hd.get_doubles(kHdCurrentTransform, transform);
  const unsigned calibration = hd.check_calibration();
  // HD-4. Later, with force, its position may jump. By hand: with the maker's program alone.
  const int ways = session_.calibration_styles & (kHdAuto | kHdInkwell);
  if (calibration == kHdNeedsUpdate && !calibrated_ && ways != 0)
    hd.update_calibration((ways & kHdAuto) != 0 ? kHdAuto : kHdInkwell);
  const auto wrench = next_wrench(pose.stamp_ns);
  set_force(wrench ? wrench->force_N : Vec3{});
  hd.end_frame(session_.id);
  calibration_ = calibration;
  if (const unsigned code = take_hd_errors(hd); code != 0)
    return fail(fault_of_hd_error(code), Source::kError, code);
  if (calibrated_ && calibration == kHdNeedsHand)
    return fail(Fault::kHomingLost, Source::kCalibration, calibration);
  if (powered_for_sure() && hd.is_enabled(kHdForceOutput) == 0)
    return fail(Fault::kForceOff, Source::kForceOff, 0);
  if (calibration == kHdCalibrated) calibrated_ = true;
  pose.position_m = to_w(transform + 12, 1e-3) - session_.middle_m;
  if (session_.wrist) pose.orientation = orientation_of(transform);
  if (calibrated_) publish(pose);
}

void PhantomWorker::set_force(const Vec3& force_N) {
  const double of_device[3] = {force_N.y, force_N.z, force_N.x};
  session_.hd.set_doubles(kHdCurrentForce, of_device);
}

/// No answer is looked at: each step is tried, whatever became of the one before.
void PhantomWorker::let_go() {
  session_.hd.begin_frame(session_.id);
  set_force({});
  session_.hd.end_frame(session_.id);
  session_.hd.disable(kHdForceOutput);
  take_hd_errors(session_.hd);
}

bool PhantomWorker::switch_forces(bool on) {
  if (on)
    session_.hd.enable(kHdForceOutput);
  else
    session_.hd.disable(kHdForceOutput);
  return true;  // what is wrong is on the stack of errors
}

void PhantomWorker::close() {
  session_.hd.stop_scheduler();
  session_.hd.disable_device(session_.id);
}

void PhantomWorker::fail(Fault fault, Source source, unsigned code) {
  keep({.fault = fault,
        .source = static_cast<std::uint8_t>(source),
        .code = static_cast<std::uint16_t>(std::min(code, 0xFFFFu))});
}

}  // namespace tact::hal::phantom
