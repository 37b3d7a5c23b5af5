// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/emulators/cia402/cia402_drive.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tact::rig {
namespace {

constexpr double kEncoderCountsPerTurn = 10'000.0;
constexpr std::int64_t kMs_ns = 1'000'000, kTorqueMode = 10;
constexpr std::uint16_t kHeartbeatLost = 0x8130, kSetPointsLost = 0x8250, kOverCurrent = 0x2310,
                        kOverTemperature = 0x4310, kSyncLost = 0x8100, kSyncLength = 0x8240;
constexpr std::uint16_t kFollows = 1u << 12u, kLimited = 1u << 11u;

}  // namespace

std::uint16_t cia402_statusword(Cia402State state) {
  constexpr std::uint16_t kRemote = 0x0200, kVoltage = 0x0010;
  constexpr std::uint16_t kWord[] = {0x40, 0x21, 0x23, 0x27, 0x07, 0x08};
  return static_cast<std::uint16_t>(kWord[static_cast<std::size_t>(state)] | kRemote | kVoltage);
}

Cia402State cia402_next(Cia402State state, std::uint16_t controlword, std::uint16_t previous) {
  using enum Cia402State;
  const unsigned word = controlword;
  if (state == kFault) {
    const bool edge = (word & 0x80u) != 0 && (previous & 0x80u) == 0;
    return edge ? kSwitchOnDisabled : kFault;
  }
  if ((word & 0x02u) == 0) return kSwitchOnDisabled;  // disable voltage
  if ((word & 0x06u) == 0x02u) {                      // quick stop
    const bool moves = state == kOperationEnabled || state == kQuickStop;
    return moves ? kQuickStop : kSwitchOnDisabled;
  }
  const unsigned asked = word & 0x0Fu;
  if (state == kQuickStop) return kQuickStop;
  if ((word & 0x07u) == 0x06u) return kReady;  // shutdown
  if (state == kReady) return kSwitchedOn;     // with 0x0F the next step follows by the next word
  if (state == kSwitchedOn && asked == 0x0Fu) return kOperationEnabled;
  if (state == kOperationEnabled && asked == 0x07u) return kSwitchedOn;
  return state;
}

std::array<std::uint8_t, 8> cia402_emergency(std::uint16_t code, std::uint8_t error_register,
                                             std::span<const std::uint8_t> manufacturer) {
  std::array<std::uint8_t, 8> payload{};
  put_raw(std::span(payload).first(2), code);
  payload[2] = error_register;
  std::copy_n(manufacturer.begin(), std::min<std::size_t>(manufacturer.size(), 5),
              payload.begin() + 3);
  return payload;
}

Cia402Drive::Cia402Drive(int axis, int node, const Cia402Settings& settings, CanBus& bus,
                         const Motor& motor, const FaultPlan& faults)
    : axis_(axis),
      node_(node),
      settings_(settings),
      bus_(bus),
      motor_(motor),
      faults_(faults),
      dictionary_(node, settings.rated_torque_Nm, settings.habits) {}

bool Cia402Drive::tripped() { return std::exchange(has_tripped_, false); }

double Cia402Drive::torque_Nm() const {
  if (state_ != Cia402State::kOperationEnabled || !is_operational() ||
      dictionary_.get(0x6060) != kTorqueMode)
    return 0.0;
  return 1e-3 * torque_permille_ * settings_.rated_torque_Nm;
}

void Cia402Drive::reset(std::int64_t now_ns) {
  dictionary_ = ObjectDictionary(node_, settings_.rated_torque_Nm, settings_.habits);
  watch_ = 0;
  nmt_ = Nmt::kBoot;
  state_ = Cia402State::kSwitchOnDisabled;
  previous_controlword_ = 0;
  waiting_size_ = 0;
  torque_permille_ = 0.0;
  guard_toggle_ = false;
  host_ns_ = set_point_ns_ = guard_ns_ = sync_ns_ = enable_ns_ = 0;
  misses_sync_ = false;
  boot_ns_ = now_ns + settings_.boot_ms * kMs_ns;
}

void Cia402Drive::network(std::span<const std::uint8_t> payload, std::int64_t now_ns) {
  if (payload.size() < 2 || (payload[1] != 0 && payload[1] != node_) || nmt_ == Nmt::kBoot) return;
  if (payload[0] == 0x01 && !is_barred()) nmt_ = Nmt::kOperational;
  if (payload[0] == 0x02) nmt_ = Nmt::kStopped;
  if (payload[0] == 0x80) nmt_ = Nmt::kPreOperational;
  if (payload[0] == 0x81 || payload[0] == 0x82) reset(now_ns);
  // Without set-points the torque of before must not stay.
  if (!is_operational() && state_ == Cia402State::kOperationEnabled)
    state_ = Cia402State::kSwitchOnDisabled;
}

bool Cia402Drive::receive(const canfd_frame& frame, std::int64_t now_ns) {
  if (faults_.active(FaultKind::kUnpowered, axis_, now_ns)) return false;
  const std::span<const std::uint8_t> payload(std::begin(frame.data), frame.len);
  const auto id = static_cast<std::int64_t>(frame.can_id & CAN_SFF_MASK);
  const std::int64_t consumer = dictionary_.get(0x1016, 1);
  if ((frame.can_id & CAN_RTR_FLAG) != 0) {
    if (nmt_ != Nmt::kBoot && id == 0x700 + node_) answer_guard(now_ns);
  } else if (id == 0) {
    network(payload, now_ns);
  } else if (nmt_ == Nmt::kBoot) {
    return false;
  } else if (id == (dictionary_.get(0x1005) & 0x7FF)) {
    take_sync(!payload.empty(), now_ns);
  } else if (id == 0x600 + node_ && nmt_ != Nmt::kStopped && payload.size() == 8) {
    measure();
    send(CanRole::kOther, 0x580, dictionary_.serve(payload, is_operational()), now_ns);
    const bool is_controlword = payload[0] != 0x40 && payload[1] == 0x40 && payload[2] == 0x60;
    if (is_controlword) obey(now_ns);
    const std::int64_t written = dictionary_.get(0x1016, 1);
    if (written == consumer) return false;
    const bool ends = (written & 0xFFFF) == 0 && dictionary_.get(0x1001) != 0;
    if (ends && !misses_sync_) emergency(0, now_ns);
    // A watch that was set again begins with the next heartbeat (CiA 301, 7.5.2.19).
    if (settings_.habits.watch_off_first && written == 0) return false;
    watch_ = written;
    host_ns_ = 0;
  } else if (watch_ != 0 && id == 0x700 + (watch_ >> 16 & 0x7F)) {
    host_ns_ = now_ns;
  } else if (id == dictionary_.get(0x1400, 1) && is_operational()) {
    return set_points(payload, now_ns);
  }
  return false;
}

bool Cia402Drive::is_barred() const {
  return settings_.habits.errors_bar_operational && (dictionary_.get(0x1001) & 0x10) != 0;
}

void Cia402Drive::take_sync(bool counts, std::int64_t now_ns) {
  if (dictionary_.get(0x1019) != 0 && !counts) {
    if (dictionary_.get(0x1001) == 0) emergency(kSyncLength, now_ns);
    return;
  }
  sync_ns_ = now_ns;
  if (misses_sync_) emergency(0, now_ns);
  misses_sync_ = false;
  if (is_operational()) synchronise(now_ns);
}

void Cia402Drive::answer_guard(std::int64_t now_ns) {
  guard_ns_ = now_ns;
  if (dictionary_.get(0x1017) != 0) return;  // its heartbeat has this identifier
  const std::uint8_t state[] = {
      static_cast<std::uint8_t>((guard_toggle_ ? 0x80u : 0u) | static_cast<unsigned>(nmt_))};
  guard_toggle_ = !guard_toggle_;
  send(CanRole::kOther, 0x700, state, now_ns);
}

bool Cia402Drive::set_points(std::span<const std::uint8_t> payload, std::int64_t now_ns) {
  if (dictionary_.get(0x1400, 2) <= 240) {  // they act at the next SYNC
    waiting_size_ = payload.size();
    std::copy(payload.begin(), payload.end(), waiting_.begin());
    set_point_ns_ = now_ns;
    return true;
  }
  if (!dictionary_.unpack(0x1600, payload)) return false;
  set_point_ns_ = now_ns;
  obey(now_ns);
  return true;
}

void Cia402Drive::obey(std::int64_t now_ns) {
  const auto word = static_cast<std::uint16_t>(dictionary_.get(0x6040));
  const auto largest = static_cast<double>(dictionary_.get(0x6072));
  const auto target = static_cast<double>(dictionary_.get(0x6071) + dictionary_.get(0x60B2));
  torque_permille_ = std::clamp(target, -largest, largest);
  is_limited_ = torque_permille_ != target;
  Cia402State next = cia402_next(state_, word, previous_controlword_);
  if (state_ == Cia402State::kFault && next != state_) {
    dictionary_.set(0x603F, 0, 0);
    emergency(0, now_ns);
  }
  previous_controlword_ = word;
  if (next == Cia402State::kOperationEnabled && state_ != next) {  // the power stage takes its time
    if (enable_ns_ == 0) enable_ns_ = now_ns + settings_.enable_ms * kMs_ns;
    if (now_ns < enable_ns_) next = state_;
  } else {
    enable_ns_ = 0;
  }
  // 605A of 0 to 2 and a motor without ramp: the stop ends at once.
  if (next == Cia402State::kQuickStop && dictionary_.get(0x605A) < 5)
    next = Cia402State::kSwitchOnDisabled;
  state_ = next;
}

void Cia402Drive::synchronise(std::int64_t now_ns) {
  if (waiting_size_ > 0 && dictionary_.unpack(0x1600, {waiting_.data(), waiting_size_}))
    obey(now_ns);
  waiting_size_ = 0;
  const std::int64_t cob_id = dictionary_.get(0x1800, 1);
  if ((cob_id & 0x8000'0000) != 0 || ++syncs_ < dictionary_.get(0x1800, 2)) return;
  syncs_ = 0;
  measure();
  std::array<std::uint8_t, 8> payload{};
  const std::size_t size = dictionary_.pack(0x1A00, payload);
  bus_.send(axis_, CanRole::kSample, static_cast<std::uint32_t>(cob_id & 0x7FF),
            std::span(payload).first(size), now_ns);
}

void Cia402Drive::measure() {
  unsigned status = cia402_statusword(state_);
  if (is_enabled() && dictionary_.get(0x6060) == kTorqueMode) status |= kFollows;
  if (is_enabled() && is_limited_) status |= kLimited;
  dictionary_.set(0x6041, 0, status);
  dictionary_.set(0x6064, 0, std::llround(motor_.position_turns * kEncoderCountsPerTurn));
  dictionary_.set(0x606C, 0, std::llround(motor_.velocity_turns_per_s * kEncoderCountsPerTurn));
  dictionary_.set(0x6077, 0, is_enabled() ? std::llround(torque_permille_) : 0);
}

void Cia402Drive::emergency(std::uint16_t code, std::int64_t now_ns) {
  const bool is_communication = code >> 12u == 8;
  const auto error_register = static_cast<std::uint8_t>(code == 0          ? 0
                                                        : is_communication ? 0x11
                                                                           : 0x01);
  dictionary_.set(0x1001, 0, error_register);
  if (code != 0) dictionary_.set(0x1003, 1, code);
  if (code != 0) noted_.push_back(code);
  send(CanRole::kOther, 0x080, cia402_emergency(code, error_register), now_ns);
}

void Cia402Drive::fail(std::int64_t now_ns) {
  state_ = Cia402State::kFault;
  torque_permille_ = 0.0;
  dictionary_.set(0x603F, 0, kOverCurrent);
  emergency(kOverCurrent, now_ns);
}

bool Cia402Drive::warn(std::int64_t now_ns) {
  emergency(kOverTemperature, now_ns);
  return true;
}

void Cia402Drive::lost(std::uint16_t code, std::int64_t now_ns) {
  emergency(code, now_ns);
  has_tripped_ |= is_enabled();
  // Without 6007 its own setting counts: a fault.
  const std::int64_t reaction = dictionary_.has(0x6007) ? dictionary_.get(0x6007) : 1;
  if (reaction == 1) {
    state_ = Cia402State::kFault;
    dictionary_.set(0x603F, 0, code);
  } else if (is_enabled() && reaction == 3) {
    state_ = dictionary_.get(0x605A) < 5 ? Cia402State::kSwitchOnDisabled : Cia402State::kQuickStop;
  } else if (reaction == 2) {
    state_ = Cia402State::kSwitchOnDisabled;
  }
}

void Cia402Drive::tick(std::int64_t now_ns) {
  if (faults_.active(FaultKind::kUnpowered, axis_, now_ns)) {
    reset(now_ns);
    return;
  }
  if (boot_ns_ == 0) boot_ns_ = now_ns + settings_.boot_ms * kMs_ns;
  if (nmt_ == Nmt::kBoot) {
    if (now_ns < boot_ns_) return;
    const std::uint8_t boot_up[] = {0};
    send(CanRole::kOther, 0x700, boot_up, now_ns);
    nmt_ = Nmt::kPreOperational;
    heartbeat_ns_ = now_ns;
    if (settings_.habits.life_from_boot) guard_ns_ = now_ns;
  }
  const std::int64_t period_ns = dictionary_.get(0x1017) * kMs_ns;
  if (period_ns > 0 && now_ns - heartbeat_ns_ >= period_ns) {
    // On the grid of its period, unless it was late by more than one.
    heartbeat_ns_ = std::max(heartbeat_ns_ + period_ns, now_ns - period_ns + 1);
    const std::uint8_t state[] = {static_cast<std::uint8_t>(nmt_)};
    send(CanRole::kHeartbeat, 0x700, state, now_ns);
  }
  const auto silent = [&](std::int64_t& heard_ns, std::int64_t limit_ms, std::uint16_t code) {
    if (limit_ms == 0 || heard_ns == 0 || now_ns - heard_ns <= limit_ms * kMs_ns) return;
    heard_ns = 0;  // said once; it starts again with the next that is heard
    lost(code, now_ns);
  };
  const std::int64_t life_ms = dictionary_.get(0x100C) * dictionary_.get(0x100D);
  if (life_ms == 0 || !settings_.habits.life_hides_host)
    silent(host_ns_, watch_ & 0xFFFF, kHeartbeatLost);
  silent(guard_ns_, life_ms, kHeartbeatLost);
  silent(set_point_ns_, dictionary_.get(0x1400, 5), kSetPointsLost);
  const std::int64_t most_ns = dictionary_.get(0x1006) * 1500;
  if (most_ns == 0 || sync_ns_ == 0 || now_ns - sync_ns_ <= most_ns) return;
  sync_ns_ = 0;
  misses_sync_ = true;
  emergency(kSyncLost, now_ns);
}

void Cia402Drive::send(CanRole role, std::uint32_t function, std::span<const std::uint8_t> payload,
                       std::int64_t now_ns) {
  bus_.send(axis_, role, function + static_cast<std::uint32_t>(node_), payload, now_ns);
}

}  // namespace tact::rig
