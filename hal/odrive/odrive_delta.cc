#include "hal/odrive/odrive_delta.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "hal/can/can_link.h"

namespace tact::hal {
namespace {

using model::Error;
using model::Result;

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::int64_t kSilence_ns = 350 * kMs_ns;      // three heartbeats of 100 ms and a little
constexpr std::int64_t kStartLimit_ns = 3000 * kMs_ns;  // until closed loop
constexpr int kFeedTicks = 5;      // of zero torque before closed loop is asked for
constexpr int kRepeatTicks = 100;  // a request may have been lost
constexpr std::uint32_t kWatchdog06 = 0x1000000, kWatchdog05 = 0x800;

bool is_in(const OdriveAxis& axis, OdriveAxisState state) RT_SAFE {
  return axis.state == static_cast<std::uint8_t>(state);
}

}  // namespace

OdriveDelta::OdriveDelta(std::unique_ptr<CanBus> bus, const model::DeviceSettings& settings,
                         double rate_Hz, const OdriveStart& start)
    : bus_(std::move(bus)),
      settings_(settings),
      delta_(settings.delta, settings.can),
      generation_(start.generation),
      period_ns_(std::llround(1e9 / rate_Hz)),
      gap_(1.0 / rate_Hz) {
  if (settings.can.homing == model::Homing::kJig) delta_.home_on_jig(start.motor_turns);
}

OdriveDelta::~OdriveDelta() { stop(); }

DeviceInfo OdriveDelta::info() const {
  // A position is up to a period old (the drive's own clock); then three positions and three
  // torques on the bus at 1 Mbit/s.
  const double delay_s =
      1e-9 * static_cast<double>(period_ns_) + 1e-6 * odrive_cycle_bits(settings_.can);
  return delta_.info("delta with three ODrives on CAN", settings_.delta.counts_per_turn, delay_s);
}

Fault OdriveDelta::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  sample.fresh = false;
  now_ns_ = now_ns;
  if (first_ns_ == 0) {
    first_ns_ = now_ns;
    for (OdriveAxis& axis : axes_) axis.heartbeat_ns = now_ns;
  }
  any_new_ = false;
  for (const CanReceived& one : bus_->receive()) take(one, now_ns);
  if (bus_->fault() != Fault::kNone) latch_.set(bus_->cause());
  if (phase_ == Phase::kStopped) return latch_.fault();
  watch(now_ns);
  follow_phase(now_ns);
  Tool tool;
  std::int64_t stamp_ns = 0;
  const bool measured = latch_.fault() == Fault::kNone && measure(tool, stamp_ns);
  judge_gap(measured);
  if (latch_.fault() != Fault::kNone || !measured) return latch_.fault();
  sample = {.tool = tool, .stamp_ns = stamp_ns, .sequence = ++sequence_, .fresh = true};
  return Fault::kNone;
}

void OdriveDelta::take(const CanReceived& received, std::int64_t now_ns) RT_SAFE {
  const OdriveAddress from = odrive_address(received.frame);
  const auto& nodes = settings_.can.node;
  const auto at =
      static_cast<std::size_t>(std::find(nodes.begin(), nodes.end(), from.node) - nodes.begin());
  if (at == nodes.size()) {
    ++counts_.strays;
    return;
  }
  const std::int64_t arrival_ns = now_ns - received.age_ns;
  if (from.command == OdriveCommand::kHeartbeat) {
    take_heartbeat(at, received.frame, arrival_ns);
    return;
  }
  const auto position = decode_odrive_estimates(received.frame, from.node);
  if (!position) {
    ++counts_.strays;
    return;
  }
  const OdriveNews news = axes_[at].take(*position, arrival_ns);
  any_new_ = any_new_ || news == OdriveNews::kNew;
  counts_.old += news == OdriveNews::kOld ? 1 : 0;
  counts_.stale += news == OdriveNews::kStale ? 1 : 0;
  counts_.jumped += news == OdriveNews::kJumped ? 1 : 0;
}

void OdriveDelta::take_heartbeat(std::size_t axis, const CanFrame& frame,
                                 std::int64_t arrival_ns) RT_SAFE {
  const int node = settings_.can.node[axis];
  const auto beat = decode_odrive_heartbeat(frame, node);
  if (!beat || arrival_ns < axes_[axis].heartbeat_ns) return;
  axes_[axis].heartbeat_ns = arrival_ns;
  axes_[axis].state = beat->axis_state;
  if (generation_ == OdriveGeneration::k06) {
    judge_error(axis, OdriveCause::kErrors06, beat->axis_error, arrival_ns);
    return;
  }
  judge_error(axis, OdriveCause::kErrors05, beat->axis_error, arrival_ns);
  const auto beat05 = decode_odrive_heartbeat_05(frame, node);
  if (beat05) judge_error(axis, OdriveCause::kParts05, odrive_parts_05(*beat05), arrival_ns);
}

void OdriveDelta::judge_error(std::size_t axis, OdriveCause kind, std::uint32_t code,
                              std::int64_t arrival_ns) RT_SAFE {
  if (code == 0) return;
  // Between opening and the first tick nobody fed the watchdogs; the first batch clears that.
  const bool was_silent = arrival_ns < first_ns_ + kSilence_ns && phase_ != Phase::kReady;
  if (was_silent && kind == OdriveCause::kErrors06 && code == kWatchdog06) return;
  if (was_silent && kind == OdriveCause::kErrors05 && code == kWatchdog05) return;
  latch(axis, kind, code);
}

void OdriveDelta::watch(std::int64_t now_ns) RT_SAFE {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t silent_ns = now_ns - axes_[i].heartbeat_ns;
    if (silent_ns > kSilence_ns && !bus_->cut()) {
      latch(i, OdriveCause::kSilent, static_cast<std::uint32_t>(silent_ns / kMs_ns),
            Fault::kDriveSilent);
    }
    if (axes_[i].untrusted()) latch(i, OdriveCause::kJumped, 0, Fault::kHomingLost);
  }
}

bool OdriveDelta::all_in_closed_loop() const RT_SAFE {
  return std::all_of(axes_.begin(), axes_.end(), [this](const OdriveAxis& axis) {
    return is_in(axis, OdriveAxisState::kClosedLoop) && axis.heartbeat_ns > asked_ns_;
  });
}

void OdriveDelta::follow_phase(std::int64_t now_ns) RT_SAFE {
  if (phase_ == Phase::kStarting && asked_ns_ != 0 && all_in_closed_loop()) {
    phase_ = Phase::kReady;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_in(axes_[i], OdriveAxisState::kClosedLoop)) continue;
    if (phase_ == Phase::kReady) latch(i, OdriveCause::kLeftClosedLoop, axes_[i].state);
    if (phase_ == Phase::kStarting && asked_ns_ != 0 && now_ns - asked_ns_ > kStartLimit_ns) {
      latch(i, OdriveCause::kNotStarted, axes_[i].state);
    }
  }
}

bool OdriveDelta::measure(Tool& tool, std::int64_t& stamp_ns) RT_SAFE {
  Joints turns{};
  stamp_ns = now_ns_;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!axes_[i].has_position()) return false;
    turns[i] = axes_[i].position_turns();
    stamp_ns = std::min(stamp_ns, axes_[i].arrival_ns());
  }
  if (!any_new_ || 2 * (now_ns_ - stamp_ns) > 3 * period_ns_) return false;
  if (const auto lost = delta_.measure(turns, stamp_ns, tool)) {
    latch_.set(*lost);
    return false;
  }
  return true;
}

void OdriveDelta::judge_gap(bool fresh) RT_SAFE {
  gap_.step(fresh);
  if (!gap_.lost()) return;
  std::size_t oldest = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (axes_[i].arrival_ns() < axes_[oldest].arrival_ns()) oldest = i;
  }
  latch(oldest, OdriveCause::kNoPosition,
        static_cast<std::uint32_t>(SampleGap::kMostMissing * period_ns_ / kMs_ns),
        Fault::kDeviceLost);
}

void OdriveDelta::latch(std::size_t axis, OdriveCause kind, std::uint32_t code,
                        Fault fault) RT_SAFE {
  latch_.set({.fault = fault,
              .axis = static_cast<std::uint8_t>(axis),
              .kind = static_cast<std::uint8_t>(kind),
              .code = code});
}

void OdriveDelta::push_torques(const Joints& torque_Nm) RT_SAFE {
  const auto length =
      settings_.can.short_torque ? OdriveTorqueLength::kShort : OdriveTorqueLength::kPadded;
  for (std::size_t i = 0; i < 3; ++i) {
    bus_->push(odrive_input_torque(settings_.can.node[i], torque_Nm[i], length));
  }
}

void OdriveDelta::push_state(OdriveAxisState state) RT_SAFE {
  for (const int node : settings_.can.node) bus_->push(odrive_axis_state(node, state));
}

Fault OdriveDelta::write(const Wrench& wrench) RT_SAFE {
  if (phase_ == Phase::kStopped) return latch_.fault();
  if (latch_.fault() != Fault::kNone) {
    if (stops_to_send_ <= 0) return latch_.fault();
    --stops_to_send_;
    push_torques({});
    for (const int node : settings_.can.node) bus_->push(odrive_estop(node));
    bus_->send();
    return latch_.fault();
  }
  push_phase(wrench);
  bus_->send();
  if (bus_->fault() != Fault::kNone) latch_.set(bus_->cause());
  if (latch_.fault() != Fault::kNone) return latch_.fault();
  return is_finite(wrench.force_N) ? Fault::kNone : Fault::kForceNotFinite;
}

void OdriveDelta::push_phase(const Wrench& wrench) RT_SAFE {
  if (phase_ != Phase::kOff && !permitted_) {
    push_torques({});
    push_state(OdriveAxisState::kIdle);
    phase_ = Phase::kOff;
    ticks_in_phase_ = 0;
    return;
  }
  if (phase_ == Phase::kReady) {
    push_torques(delta_.motor_torques_Nm(wrench.force_N, gap_.torque_ratio()));
    return;
  }
  push_torques({});
  if (!cleared_) {
    cleared_ = true;
    for (const int node : settings_.can.node) bus_->push(odrive_clear_errors(node, false));
  }
  ++ticks_in_phase_;
  if (phase_ == Phase::kOff) {
    const bool ignored = std::any_of(axes_.begin(), axes_.end(), [](const OdriveAxis& axis) {
      return is_in(axis, OdriveAxisState::kClosedLoop);
    });
    if (ignored && ticks_in_phase_ % kRepeatTicks == 0) push_state(OdriveAxisState::kIdle);
    if (!permitted_) return;
    phase_ = Phase::kStarting;
    ticks_in_phase_ = 0;
    asked_ns_ = 0;
    return;
  }
  if (ticks_in_phase_ % kRepeatTicks != kFeedTicks) return;
  push_state(OdriveAxisState::kClosedLoop);
  if (asked_ns_ == 0) asked_ns_ = now_ns_;
}

std::string OdriveDelta::trouble() const { return odrive_trouble(latch_.cause(), settings_); }

void OdriveDelta::stop() {
  if (phase_ == Phase::kStopped) return;
  phase_ = Phase::kStopped;
  for (int i = 0; i < 2; ++i) {
    push_torques({});
    bus_->send();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  push_state(OdriveAxisState::kIdle);
  bus_->send();
}

Result<std::unique_ptr<Device>> start_odrive_delta(std::unique_ptr<CanBus> bus,
                                                   const model::DeviceSettings& settings,
                                                   double rate_Hz) {
  const bool powered_by_lines = settings.lines.wired() && settings.lines.enable >= 0;
  if (settings.can.homing == model::Homing::kIndex && powered_by_lines) {
    return Error{
        "device.can.homing \"index\" turns the motors before the loop runs, but "
        "device.lines.enable gives them power only then: use \"absolute\" or \"jig\""};
  }
  auto start = bring_up_odrives(*bus, settings.can, rate_Hz);
  if (!start) return start.error();
  auto device = std::make_unique<OdriveDelta>(std::move(bus), settings, rate_Hz, *start);
  if (auto error = device->check_home(*start)) return *error;
  return std::unique_ptr<Device>(std::move(device));
}

Result<std::unique_ptr<Device>> open_can_odrive(const model::Scene& scene) {
  const model::CanSettings& can = scene.device.can;
  auto socket =
      open_checked_can(can.interface, odrive_cycle_bits(can), scene.rate_Hz, odrive_ids(can));
  if (!socket) return socket.error();
  return start_odrive_delta(std::make_unique<CanBus>(std::move(*socket)), scene.device,
                            scene.rate_Hz);
}

}  // namespace tact::hal
