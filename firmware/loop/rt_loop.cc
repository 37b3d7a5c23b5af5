// SPDX-License-Identifier: Apache-2.0
// The only wait in this file is that for the clock; nothing locks, allocates, prints or throws.
// Every force passes the gate before it is written.
#include "firmware/loop/rt_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/loop/release_schedule.h"
#include "model/time_ns.h"

namespace tact::firmware::loop {

void RtLoop::run() RT_SAFE {
  // After a stop request no tick follows; release_device() writes zero force.
  while (may_run()) step();
  release_device();
}

void RtLoop::step() RT_SAFE {
  const std::int64_t period_ns = settings_.period_ns;
  if (statistics_.ticks == 0) {
    progress_.enter(Callee::kDevice);
    device_.catch_up(now_ns());
    progress_.enter(Callee::kOwn);
    due_ns_ = next_deadline_ns(now_ns() + period_ns, period_ns);
  }
  clock_.sleep_until_ns(due_ns_);
  tick(due_ns_);
  due_ns_ += period_ns;  // absolute deadlines: one late tick does not delay the next
  // Read from the clock, not extrapolated: lateness must be in the kernel's time (RT-14).
  const std::int64_t behind_ns = clock_.now_ns() - due_ns_;
  // Measured before between_ticks(): simulated physics is not part of the tick.
  record_.margin_ns = -behind_ns;
  std::int64_t skipped = 0;
  if (behind_ns >= 0) {
    skipped = behind_ns / period_ns + 1;
    due_ns_ += skipped * period_ns;
    ++statistics_.late_ticks;
    statistics_.skipped_ticks += static_cast<std::uint64_t>(skipped);
  }
  constexpr std::int64_t kMax = std::numeric_limits<std::uint32_t>::max();
  record_.input.skipped_periods = static_cast<std::uint32_t>(std::min(skipped, kMax));
  device_.between_ticks(static_cast<double>((1 + skipped) * period_ns) * 1e-9);
}

void RtLoop::tick(std::int64_t due_ns) RT_SAFE {
  const std::int64_t wake_ns = now_ns();
  // Counted before any call that could hang, so that the watch sees this tick.
  progress_.tick();
  lines_.scope(true);
  record_.tick = statistics_.ticks++;
  record_.due_ns = due_ns;
  record_.sync = due_ns / model::kSecond_ns % 2 != 0;
  record_.event = requests_.take_event(record_.tick);
  record_phase(Phase::kWake, wake_ns - due_ns);

  hear_requests();
  TickInput& input = record_.input;
  contacts_.take(controller_, input);
  input.device_fault = read(wake_ns);
  // After both were read: a loss of power stops the force in the same tick.
  input.ready = lines_.enabled() && device_.ready();
  const std::int64_t read_ns = end_phase(Phase::kRead, wake_ns);

  controller_.detect_contact(input);
  const std::int64_t detected_ns = end_phase(Phase::kDetect, read_ns);
  controller_.render_force(input);
  const std::int64_t rendered_ns = end_phase(Phase::kRender, detected_ns);
  record_.output = controller_.limit(input);
  answer_requests();
  const std::int64_t limited_ns = end_phase(Phase::kLimit, rendered_ns);

  write();
  lines_.scope(false);
  const std::int64_t written_ns = end_phase(Phase::kWrite, limited_ns);
  const bool stopped = record_.output.state == State::kStopped;  // stop times come from the clock
  stop_timer_.step(input, record_.output, wake_ns, stopped ? clock_.now_ns() : written_ns);
  statistics_.stop = stop_timer_.times();
  const model::Vec3& force_N = record_.output.written.force_N;
  progress_.show({.time_ns = written_ns,
                  .state = record_.output.state,
                  .fault = record_.output.fault,
                  .force_N = {static_cast<float>(force_N.x), static_cast<float>(force_N.y),
                              static_cast<float>(force_N.z)}});

  publish();
  const std::int64_t end_ns = end_phase(Phase::kPublish, written_ns);
  record_phase(Phase::kTotal, end_ns - wake_ns);
}

void RtLoop::release_device() RT_SAFE {
  // Lines first: if the device hangs in the next call, its power is already switched off.
  progress_.enter(Callee::kLines);
  const Fault lines_fault = lines_.write({.healthy = false, .armed = false, .faulted = true});
  progress_.enter(Callee::kDevice);
  device_.permit(false);
  device_.set_grip_force(0.0);
  const Fault device_fault = device_.write(model::Wrench{});
  progress_.enter(Callee::kOwn);
  progress_.end();
  for (const Fault fault : {write_fault_, lines_fault, device_fault})
    if (fault != Fault::kNone) requests_.trip(fault);  // no tick follows that could latch it
}

void RtLoop::hear_requests() RT_SAFE {
  // Relaxed, as every request: it orders no other data. One that is read a tick later acts a tick
  // later.
  const Commands before = record_.input.commands;
  const std::uint32_t asked = requests_.asked.load(std::memory_order_relaxed);
  // Compares only numbers: a request that a tick has taken cannot be cancelled. The supervisor acts
  // on rising edges, so a tick without a request comes between two requests.
  answers_ = (asked ^ heard_) > 3U && !before.arm && !before.reset && !before.disarm;
  if (answers_) heard_ = asked;
  const auto request = answers_ ? static_cast<Request>(asked & 3U) : Request::kNone;
  if (request == Request::kDisarm) requests_.arm_at_start.store(false, std::memory_order_relaxed);
  record_.input.commands = {.arm = request == Request::kArm || arms_at_start(),
                            .stop = requests_.stop.load(std::memory_order_relaxed),
                            .reset = request == Request::kReset,
                            .disarm = request == Request::kDisarm};
}

// Answers a person's request in the tick that took it: done or refused.
void RtLoop::answer_requests() RT_SAFE {
  const State state = record_.output.state;
  if (answers_) {
    // Not from the commands: arm_at_start may add an arm command to a person's request.
    const auto request = static_cast<Request>(heard_ & 3U);
    const bool done = request == Request::kArm ? state == State::kArmed
                      : request == Request::kReset
                          ? state == State::kReady
                          : request == Request::kDisarm && state != State::kArmed;
    if (request == Request::kArm && !done)
      requests_.refused.fetch_add(1, std::memory_order_relaxed);
    requests_.echo(heard_, done);
  }
  if (state == State::kArmed || state == State::kStopped)
    requests_.arm_at_start.store(false, std::memory_order_relaxed);
}

// Every second tick, as arming needs a rising edge.
bool RtLoop::arms_at_start() const RT_SAFE {
  return requests_.arm_at_start.load(std::memory_order_relaxed) &&
         record_.output.state == State::kReady && !record_.input.commands.arm;
}

// Returns the first of the faults of watch, lines, device and last write. The watch's fault is read
// last, because it may concern the calls just made.
Fault RtLoop::read(std::int64_t now_ns) RT_SAFE {
  progress_.enter(Callee::kLines);
  const Fault lines_fault = lines_.read(now_ns);
  record_.event_word = lines_.event_word();
  // A device without new data leaves the sample unchanged (hal/device.h): it must not stay fresh.
  hal::Sample& sample = record_.input.sample;
  sample.fresh = false;
  sample.tool.grip_ratio = device_grip_ratio_;
  progress_.enter(Callee::kDevice);
  const Fault read_fault = device_.read(sample, now_ns);
  device_grip_ratio_ = sample.tool.grip_ratio;
  sample.tool.grip_ratio = grip_.step(device_grip_ratio_, lines_.grip());
  if (const auto pressed = lines_.clutch()) use_clutch(*pressed);
  progress_.enter(Callee::kOwn);
  const Fault watch_fault = requests_.fault.load(std::memory_order_relaxed);
  // bound: 4 (faults)
  for (const Fault fault : {watch_fault, lines_fault, read_fault, write_fault_})
    if (fault != Fault::kNone) return fault;
  return Fault::kNone;
}

void RtLoop::use_clutch(bool pressed) RT_SAFE {
  const TickOutput& before = record_.output;
  const bool has_force = before.written != model::Wrench{} || before.written_grip_N != 0.0;
  TickInput& input = record_.input;
  input.clutch = clutch_.step(pressed, has_force, input.sample);
  input.clutch_shift_m = clutch_.shift_m();
  device_.shift_tool(input.clutch_shift_m);
  input.clutches = statistics_.clutches = clutch_.count();
}

// In state Stopped the drives lose power permission before zero force is written. The heartbeat
// toggles if the previous tick met its deadline.
void RtLoop::write() RT_SAFE {
  const TickOutput& output = record_.output;
  const bool stopped = output.state == State::kStopped;
  progress_.enter(Callee::kLines);
  const Fault lines_fault = lines_.write({.healthy = !stopped && record_.margin_ns > 0,
                                          .armed = output.state == State::kArmed,
                                          .faulted = stopped,
                                          .sync = record_.sync});
  progress_.enter(Callee::kDevice);
  device_.permit(lines_.enabled());
  device_.set_grip_force(output.written_grip_N);
  const Fault device_fault = device_.write(output.written);
  progress_.enter(Callee::kOwn);
  write_fault_ = lines_fault != Fault::kNone ? lines_fault : device_fault;
}

// If the ring is full, the record is dropped.
void RtLoop::publish() RT_SAFE {
  statistics_.max_force_N = std::max(statistics_.max_force_N, norm(record_.output.written.force_N));
  statistics_.max_torque_Nm =
      std::max(statistics_.max_torque_Nm, norm(record_.output.written.torque_Nm));
  statistics_.max_grip_force_N =
      std::max(statistics_.max_grip_force_N, std::abs(record_.output.written_grip_N));
  statistics_.max_rms_force_N = std::max(statistics_.max_rms_force_N, record_.output.rms_force_N);
  statistics_.max_given_energy_J =
      std::max(statistics_.max_given_energy_J, record_.output.given_energy_J);
  statistics_.contact_losses = record_.output.contact_losses;
  if (controller_.is_inside()) ++statistics_.inside_ticks;
  record_.late_ticks = statistics_.late_ticks;
  record_.skipped_ticks = statistics_.skipped_ticks;
  record_.contacts.assign(controller_.contacts());
  ring_.push(record_);
  if (settings_.ticks_per_shape != 0 && record_.tick % settings_.ticks_per_shape == 0)
    controller_.publish_shape();
}

bool RtLoop::may_run() const RT_SAFE {
  if (requests_.stop.load(std::memory_order_relaxed)) return false;
  const std::uint64_t periods = statistics_.ticks + statistics_.skipped_ticks;
  return (settings_.max_ticks == 0 || statistics_.ticks < settings_.max_ticks) &&
         (settings_.max_periods == 0 || periods < settings_.max_periods);
}

std::int64_t RtLoop::now_ns() RT_SAFE {
  const std::int64_t now_ns = clock_.now_ns();
  marked_.set(now_ns, clock_.mark());
  return now_ns;
}

std::int64_t RtLoop::end_phase(Phase phase, std::int64_t since_ns) RT_SAFE {
  const std::int64_t now_ns = marked_ns();
  record_phase(phase, now_ns - since_ns);
  return now_ns;
}

void RtLoop::record_phase(Phase phase, std::int64_t duration_ns) RT_SAFE {
  const auto i = static_cast<std::size_t>(phase);
  // The histogram has 64 bits; the record has 32 and saturates at 2.1 s.
  statistics_.phase[i].record(duration_ns, record_.tick);
  constexpr std::int64_t kMax = std::numeric_limits<std::int32_t>::max();
  record_.phase_ns[i] = static_cast<std::int32_t>(std::clamp<std::int64_t>(duration_ns, 0, kMax));
}

}  // namespace tact::firmware::loop
