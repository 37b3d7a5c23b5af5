#include "hal/cia402/cia402_delta.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "hal/can/can_link.h"
#include "hal/cia402/canopen_frames.h"

namespace tact::hal {
namespace {

using model::Result;

constexpr std::int64_t kMs_ns = 1'000'000;
constexpr std::int64_t kHostHeartbeat_ns = 5 * kMs_ns;
constexpr std::int64_t kStartLimit_ns = 3000 * kMs_ns;  // from permission to operation enabled
constexpr int kMostIdleTicks = 20;

}  // namespace

Cia402Delta::Cia402Delta(std::unique_ptr<CanBus> bus, const model::DeviceSettings& settings,
                         double rate_Hz, const Cia402Start& start)
    : bus_(std::move(bus)),
      settings_(settings),
      delta_(settings.delta, settings.can),
      configuration_(cst_settings(settings.can, rate_Hz)),
      period_ns_(std::llround(1e9 / rate_Hz)),
      ticks_per_heartbeat_(
          static_cast<int>(std::max<std::int64_t>(1, kHostHeartbeat_ns / period_ns_))),
      gap_(1.0 / rate_Hz) {
  for (std::size_t i = 0; i < 3; ++i) {
    axes_[i].node = settings.can.node[i];
    axes_[i].rated_torque_Nm = start.rated_torque_Nm[i];
  }
  if (settings.can.homing == model::Homing::kJig) delta_.home_on_jig(start.motor_turns);
}

Cia402Delta::~Cia402Delta() { stop(); }

DeviceInfo Cia402Delta::info() const {
  // A sample is one period old when it is used; then three commands at 1 Mbit/s, and a period more
  // if they wait for SYNC.
  const int periods = settings_.can.command_at_sync ? 2 : 1;
  const int bits = 3 * can_bits_on_bus(make_can_frame(0, 4)).most;
  return delta_.info("delta with three CiA 402 drives on CAN",
                     settings_.can.counts_per_motor_turn * settings_.delta.gear_ratio,
                     1e-9 * static_cast<double>(periods * period_ns_) + 1e-6 * bits);
}

Fault Cia402Delta::read(Sample& sample, std::int64_t now_ns) RT_SAFE {
  sample.fresh = false;
  if (now_ns_ == 0) {
    now_ns_ = now_ns;
    for (Axis& axis : axes_) axis.heartbeat_ns = now_ns;
  }
  before_ns_ = now_ns_;
  now_ns_ = now_ns;
  for (Axis& axis : axes_) axis.sampled = false;
  for (const CanReceived& one : bus_->receive()) {
    const auto node = static_cast<int>(one.frame.id & 0x7Fu);
    std::size_t i = 0;
    while (i < 3 && axes_[i].node != node) ++i;
    if (i < 3) take(i, one, now_ns);
    counts_.strays += i < 3 ? 0 : 1;
  }
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

void Cia402Delta::take(std::size_t axis, const CanReceived& received, std::int64_t now_ns) RT_SAFE {
  const int node = axes_[axis].node;
  const std::int64_t arrival_ns = now_ns - received.age_ns;
  if (const auto sample = decode_cst_sample(received.frame, node)) {
    take_sample(axis, *sample, arrival_ns);
  } else if (const auto state = decode_canopen_heartbeat(received.frame, node)) {
    if (arrival_ns < axes_[axis].heartbeat_ns) return;  // from before the first tick
    axes_[axis].heartbeat_ns = arrival_ns;
    if (*state != NmtState::kOperational) {
      latch(axis, Cia402Cause::kLeftOperational, static_cast<std::uint32_t>(*state));
    }
  } else if (const auto emergency = decode_canopen_emergency(received.frame, node)) {
    if (emergency->code == 0) return;  // "errors are gone": what latched stays
    // The state may have come first, without a reason.
    const bool reason_follows =
        latch_.cause().kind == static_cast<std::uint8_t>(Cia402Cause::kStatus);
    if (reason_follows) {
      latch_.explain({.fault = Fault::kDriveFault,
                      .axis = static_cast<std::uint8_t>(axis),
                      .kind = static_cast<std::uint8_t>(Cia402Cause::kEmergency),
                      .code = emergency->code});
    }
    latch(axis, Cia402Cause::kEmergency, emergency->code);
  } else if (const auto reply = decode_canopen_sdo(received.frame, node)) {
    axes_[axis].guard.take(*reply);
  } else {
    ++counts_.strays;
  }
}

void Cia402Delta::take_sample(std::size_t axis, const CstSample& sample,
                              std::int64_t arrival_ns) RT_SAFE {
  Axis& a = axes_[axis];
  if (arrival_ns < before_ns_) {  // of an older SYNC: it lay in a queue
    ++counts_.old;
    return;
  }
  counts_.extra += a.sampled ? 1 : 0;
  a.sampled = true;
  a.arrival_ns = arrival_ns;
  a.turns = sample.position_increments / settings_.can.counts_per_motor_turn;
  a.state = cia402_state(sample.statusword);
  const bool lazy =
      a.state == Cia402State::kOperationEnabled && !cia402_flags(sample.statusword).following;
  a.idle_ticks = lazy ? a.idle_ticks + 1 : 0;
  if (a.state == Cia402State::kFault || a.state == Cia402State::kFaultReaction) {
    latch(axis, Cia402Cause::kStatus, static_cast<std::uint32_t>(a.state));
  }
}

void Cia402Delta::watch(std::int64_t now_ns) RT_SAFE {
  // Three heartbeats and half of one.
  const std::int64_t most_ns = kMs_ns * configuration_.drive_heartbeat_ms * 7 / 2;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t silent_ns = now_ns - axes_[i].heartbeat_ns;
    if (silent_ns > most_ns && !bus_->cut()) {
      latch(i, Cia402Cause::kSilent, static_cast<std::uint32_t>(silent_ns / kMs_ns),
            Fault::kDriveSilent);
    }
  }
}

bool Cia402Delta::all_sampled() const RT_SAFE {
  return axes_[0].sampled && axes_[1].sampled && axes_[2].sampled;
}

bool Cia402Delta::all_enabled() const RT_SAFE {
  return std::all_of(axes_.begin(), axes_.end(),
                     [](const Axis& axis) { return axis.state == Cia402State::kOperationEnabled; });
}

void Cia402Delta::follow_phase(std::int64_t now_ns) RT_SAFE {
  if (phase_ == Phase::kStarting && all_sampled() && all_enabled()) {
    phase_ = Phase::kReady;
    for (Axis& axis : axes_) axis.idle_ticks = 0;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Axis& axis = axes_[i];
    const auto state = static_cast<std::uint32_t>(axis.state);
    const bool enabled = axis.state == Cia402State::kOperationEnabled;
    if (phase_ == Phase::kReady && !enabled) latch(i, Cia402Cause::kLeftEnabled, state);
    if (phase_ == Phase::kReady && axis.idle_ticks >= kMostIdleTicks) {
      latch(i, Cia402Cause::kNotFollowing, 0);
    }
    if (phase_ == Phase::kStarting && !enabled && now_ns - started_ns_ > kStartLimit_ns) {
      latch(i, axis.guard.on() ? Cia402Cause::kNotStarted : Cia402Cause::kUnguarded, state);
    }
  }
}

bool Cia402Delta::measure(Tool& tool, std::int64_t& stamp_ns) RT_SAFE {
  if (!all_sampled()) return false;
  Joints turns{};
  stamp_ns = now_ns_;
  for (std::size_t i = 0; i < 3; ++i) {
    turns[i] = axes_[i].turns;
    stamp_ns = std::min(stamp_ns, axes_[i].arrival_ns);  // the first one is nearest to its SYNC
  }
  if (const auto lost = delta_.measure(turns, stamp_ns, tool)) {
    latch_.set(*lost);
    return false;
  }
  return true;
}

void Cia402Delta::judge_gap(bool fresh) RT_SAFE {
  gap_.step(fresh);
  if (!gap_.lost()) return;
  const auto oldest =
      std::min_element(axes_.begin(), axes_.end(),
                       [](const Axis& a, const Axis& b) { return a.arrival_ns < b.arrival_ns; });
  latch(static_cast<std::size_t>(oldest - axes_.begin()), Cia402Cause::kNoSample,
        static_cast<std::uint32_t>(SampleGap::kMostMissing * period_ns_ / kMs_ns),
        Fault::kDeviceLost);
}

void Cia402Delta::latch(std::size_t axis, Cia402Cause kind, std::uint32_t code,
                        Fault fault) RT_SAFE {
  latch_.set({.fault = fault,
              .axis = static_cast<std::uint8_t>(axis),
              .kind = static_cast<std::uint8_t>(kind),
              .code = code});
}

/// One step per statusword; a drive that said nothing in this tick hears the same again.
std::uint16_t Cia402Delta::controlword_of(const Axis& axis) const RT_SAFE {
  if (phase_ == Phase::kOff || !axis.guard.on()) return kControlDisableVoltage;
  if (!axis.sampled) return axis.controlword;
  const auto next = next_controlword(axis.state, axis.controlword);
  // A fault has latched before it comes to that; nothing here may reset it.
  if (!next || *next == kControlFaultReset) return axis.controlword;
  return *next;
}

void Cia402Delta::push_command(Axis& axis, std::uint16_t controlword, double torque_Nm) RT_SAFE {
  axis.controlword = controlword;
  const auto permille = cst_torque_permille(torque_Nm, axis.rated_torque_Nm);
  bus_->push(permille ? cst_command(axis.node, controlword, *permille) : std::nullopt);
}

void Cia402Delta::push_heartbeat() RT_SAFE {
  if (ticks_++ % static_cast<std::uint64_t>(ticks_per_heartbeat_) != 0) return;
  bus_->push(canopen_heartbeat(configuration_.host_node, NmtState::kOperational));
}

Fault Cia402Delta::write(const Wrench& wrench) RT_SAFE {
  if (phase_ == Phase::kStopped) return latch_.fault();
  if (latch_.fault() != Fault::kNone) {
    if (stops_to_send_ <= 0) return latch_.fault();
    --stops_to_send_;
    for (Axis& axis : axes_) push_command(axis, kControlQuickStop, 0.0);
    if (settings_.can.command_at_sync) bus_->push(canopen_sync());
    bus_->send();
    return latch_.fault();
  }
  if (!permitted_) phase_ = Phase::kOff;
  if (permitted_ && phase_ == Phase::kOff) {
    phase_ = Phase::kStarting;
    started_ns_ = now_ns_;
  }
  Joints torque_Nm{};
  if (phase_ == Phase::kReady) {
    torque_Nm = delta_.motor_torques_Nm(wrench.force_N, gap_.torque_ratio());
  }
  push_heartbeat();
  for (std::size_t i = 0; i < 3; ++i) {
    push_command(axes_[i], controlword_of(axes_[i]), torque_Nm[i]);
  }
  bus_->push(canopen_sync());
  // After SYNC, so that they delay nothing. The last write of a loop is one without permission.
  for (Axis& axis : axes_) {
    const auto question = axis.guard.step(permitted_, axis.node, configuration_);
    if (question) bus_->push(question);
  }
  bus_->send();
  if (bus_->fault() != Fault::kNone) latch_.set(bus_->cause());
  if (latch_.fault() != Fault::kNone) return latch_.fault();
  return is_finite(wrench.force_N) ? Fault::kNone : Fault::kForceNotFinite;
}

std::string Cia402Delta::trouble() const { return cia402_trouble(latch_.cause(), settings_); }

void Cia402Delta::stop() {
  if (phase_ == Phase::kStopped) return;
  phase_ = Phase::kStopped;
  for (const std::uint16_t word : {kControlQuickStop, kControlQuickStop, kControlDisableVoltage}) {
    for (Axis& axis : axes_) push_command(axis, word, 0.0);
    bus_->push(canopen_sync());
    bus_->send();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  for (const Axis& axis : axes_) {
    bus_->push(canopen_nmt(NmtCommand::kPreOperational, axis.node));
    // Nobody sends the host's heartbeat any more: that is no fault now.
    bus_->push(canopen_sdo_download(axis.node, {.index = 0x1016, .sub = 1, .value = 0, .size = 4}));
  }
  bus_->send();
}

Result<std::unique_ptr<Device>> start_cia402_delta(std::unique_ptr<CanBus> bus,
                                                   const model::DeviceSettings& settings,
                                                   double rate_Hz) {
  auto start = bring_up_cia402(*bus, settings.can, rate_Hz);
  if (!start) return start.error();
  auto device = std::make_unique<Cia402Delta>(std::move(bus), settings, rate_Hz, *start);
  if (auto error = device->check_home(*start)) return *error;
  return std::unique_ptr<Device>(std::move(device));
}

Result<std::unique_ptr<Device>> open_can_cia402(const model::Scene& scene) {
  const model::CanSettings& can = scene.device.can;
  auto socket =
      open_checked_can(can.interface, cia402_cycle_bits(), scene.rate_Hz, cia402_ids(can));
  if (!socket) return socket.error();
  return start_cia402_delta(std::make_unique<CanBus>(std::move(*socket)), scene.device,
                            scene.rate_Hz);
}

}  // namespace tact::hal
