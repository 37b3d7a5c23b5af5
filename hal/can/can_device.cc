// SPDX-License-Identifier: Apache-2.0
#include "hal/can/can_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "hal/can/foreign_commands.h"
#include "hal/can/sample_gap.h"
#include "hal/mounting.h"
#include "model/time_ns.h"

namespace tact::hal::can {
namespace {

// More than any queue of the kernel holds: 64 frames each.
constexpr int kStartReads = 256;
constexpr int kFaultBatches = 3;  // zero torque and disable are sent so often: one may be lost

template <class Frame>
class CanDevice final : public Device {
 public:
  CanDevice(std::unique_ptr<BasicCanBus<Frame>> bus, const model::DeviceSettings& settings,
            double rate_Hz, BasicCanStart<Frame> start)
      : bus_(std::move(bus)),
        delta_settings_(settings.of<DeltaSettings>()),
        can_(settings.of<CanSettings>()),
        delta_(delta_settings_, can_, mounting_of(settings).gravity_in_base_mps2()),
        start_(std::move(start)),
        drives_(*start_.drives),
        period_ns_(model::period_ns(rate_Hz)),
        gap_(rate_Hz),
        loop_{.bus = *bus_} {
    for (std::size_t i = 0; i < 3; ++i) loop_.axes[i].node = can_.node[i];
    if (can_.homing == Homing::kJig) delta_.home_on_jig(start_.motor_turns);
  }
  ~CanDevice() override { stop(); }

  std::optional<model::Error> check_home() const { return delta_.check_home(start_.motor_turns); }

  DeviceInfo info() const override {
    DeviceInfo info = delta_.info(start_.name, start_.counts_per_turn, start_.delay_s);
    info.caution = start_.caution;
    return info;
  }
  std::span<const int> loop_calls() const override { return CanSocket::kLoopCalls; }
  void permit(bool powered) RT_SAFE override { permitted_ = powered; }
  bool ready() const RT_SAFE override {
    return loop_.power == CanPower::kReady && permitted_ && fault() == Fault::kNone;
  }

  void catch_up(std::int64_t now_ns) RT_SAFE override {
    begin(now_ns);
    for (int reads = 0; reads < kStartReads; ++reads) {
      receive();
      if (!bus_->was_cut_short()) return;
    }
  }

  Fault read(Sample& sample, std::int64_t now_ns) RT_SAFE override {
    sample.fresh = false;
    begin(now_ns);
    receive();
    if (bus_->was_cut_short()) ++cut_reads_;
    if (loop_.power == CanPower::kStopped) return fault();
    watch();
    drives_.update_power(loop_);
    Tool tool;
    std::int64_t stamp_ns = 0;
    const bool measured = fault() == Fault::kNone && measure(tool, stamp_ns);
    check_gap(measured);
    if (fault() != Fault::kNone || !measured) return fault();
    sample = {.tool = tool, .stamp_ns = stamp_ns, .sequence = ++sequence_, .fresh = true};
    sample.temperature_C = loop_.hottest_C();
    return Fault::kNone;
  }

  Fault write(const Wrench& wrench) RT_SAFE override {
    if (loop_.power == CanPower::kStopped) return fault();
    if (fault() != Fault::kNone) {
      stop_drives();
      return fault();
    }
    follow_permission();
    const bool ready = loop_.power == CanPower::kReady;
    loop_.has_shown_force = loop_.has_shown_force || (ready && wrench.force_N != Vec3{});
    drives_.push(loop_, ready ? delta_.motor_torques_Nm(wrench.force_N, gap_.torque_ratio())
                              : delta::Joints{});
    bus_->send();
    ++requests_;
    if (bus_->fault() != Fault::kNone) loop_.latch.set(bus_->cause());
    if (fault() != Fault::kNone) return fault();
    return is_finite(wrench.force_N) ? Fault::kNone : Fault::kForceNotFinite;
  }

  void stop() override {
    if (loop_.power == CanPower::kStopped) return;
    loop_.power = CanPower::kStopped;
    bool more = true;
    for (int step = 0; more; ++step) {
      more = drives_.push_stop(loop_, step);
      bus_->send();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    drives_.push_leave(loop_);
    bus_->send();
  }

  std::optional<ShutdownFrames> shutdown_frames() override {
    ShutdownFrames frames{.fd = bus_->socket().fd()};
    bool more = true;
    for (int step = 0; more; ++step) {
      more = drives_.push_stop(loop_, step);
      if (!frames.add_step(bus_->take_batch())) return std::nullopt;
    }
    return frames;
  }

  std::string fault_detail() const override {
    const FaultCause cause = loop_.latch.cause();
    if (cause.fault == Fault::kNone) return wait_text();
    if (cause.axis > 2) return {};
    if (auto words = can_bus_fault_detail(cause, can_.interface, Frame::kLinkType); !words.empty())
      return words;
    if (auto words = homing_fault_detail(cause, delta_settings_); !words.empty()) return words;
    if (cause.kind == static_cast<std::uint8_t>(CanCause::kForeign))
      return foreign_commands_.text(cause.code, can_.interface);
    return fmt::format("{}: {}", can_arm_name(cause.axis, can_), text_of(cause));
  }

  std::vector<DeviceCount> counters() const override {
    const CanBusCounts& bus = bus_->counts();
    std::vector<DeviceCount> all{{"strays", unknown_frames_},
                                 {"foreign_commands", foreign_commands_.count()}};
    for (const DeviceCount& one : drives_.counters()) all.push_back(one);
    all.insert(all.end(), {{"missed_cycles", bus.missed_cycles},
                           {"error_frames", bus.error_frames},
                           {"unreadable", bus.unreadable},
                           {"cut_reads", cut_reads_}});
    return all;
  }

 private:
  Fault fault() const RT_SAFE { return loop_.latch.fault(); }

  void begin(std::int64_t now_ns) RT_SAFE {
    if (loop_.now_ns == 0) {
      loop_.now_ns = loop_.first_ns = now_ns;
      for (CanAxis& axis : loop_.axes) axis.heartbeat_ns = now_ns;
    }
    loop_.before_ns = loop_.now_ns;
    loop_.now_ns = now_ns;
    for (CanAxis& axis : loop_.axes) axis.sampled = false;
  }

  void receive() RT_SAFE {  // bound: kMaxReceived (frames)
    for (const auto& one : bus_->receive()) take(one.frame, loop_.now_ns - one.age_ns);
    if (bus_->fault() != Fault::kNone) loop_.latch.set(bus_->cause());
  }

  void take(const Frame& frame, std::int64_t arrival_ns) RT_SAFE {
    if (drives_.is_command(frame)) return on_foreign_command(frame);
    const int node = drives_.node_of(frame);
    std::size_t i = 0;
    while (i < 3 && loop_.axes[i].node != node) ++i;  // bound: 3 (axes)
    if (i == 3 || !drives_.take(loop_, i, frame, arrival_ns)) ++unknown_frames_;
  }

  // Zero torque and disable are sent again after each of them, also when the fault is latched.
  void on_foreign_command(const Frame& frame) RT_SAFE {
    foreign_commands_.add(frame);
    loop_.fail(0, CanCause::kForeign, frame.id, Fault::kForeignCommand);
    fault_batches_ = 0;
  }

  void watch() RT_SAFE {
    // After a read that was cut short the heartbeat may still lie in the kernel's queue.
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t silent_ns = loop_.now_ns - loop_.axes[i].heartbeat_ns;
      if (silent_ns > start_.most_silent_ns && !bus_->was_cut_short()) {
        loop_.fail(i, CanCause::kSilent,
                   static_cast<std::uint32_t>(silent_ns / model::kMillisecond_ns),
                   Fault::kDriveSilent);
      }
      if (loop_.axes[i].jumps) loop_.fail(i, CanCause::kJumped, 0, Fault::kHomingLost);
      if (!start_.one_sync) continue;
      loop_.axes[i].replies.step(requests_, !bus_->was_cut_short());
      if (loop_.axes[i].replies.is_exceeded()) loop_.fail(i, CanCause::kSharedNode, 0);
    }
    requests_ = 0;
  }

  bool measure(Tool& tool, std::int64_t& stamp_ns) RT_SAFE {
    delta::Joints turns{};
    bool any = false, all = true;
    stamp_ns = loop_.now_ns;
    for (std::size_t i = 0; i < 3; ++i) {
      const CanAxis& axis = loop_.axes[i];
      if (!axis.located) return false;
      any = any || axis.sampled;
      all = all && axis.sampled;
      turns[i] = axis.motor_turns;
      stamp_ns = std::min(stamp_ns, axis.arrival_ns);
    }
    // With SYNC all three were sampled at once. Without it they are as old as the oldest: more than
    // one and a half periods would make a velocity out of nothing.
    const bool fresh =
        start_.one_sync ? all : any && 2 * (loop_.now_ns - stamp_ns) <= 3 * period_ns_;
    if (!fresh) return false;
    const auto lost = delta_.measure(turns, stamp_ns, tool);
    if (lost) loop_.latch.set(*lost);
    return !lost;
  }

  void check_gap(bool fresh) RT_SAFE {
    gap_.step(fresh, loop_.now_ns - loop_.before_ns);
    if (!gap_.is_lost()) return;
    std::size_t oldest = 0;  // the drive that the words name
    for (std::size_t i = 1; i < 3; ++i)
      if (loop_.axes[i].arrival_ns < loop_.axes[oldest].arrival_ns) oldest = i;
    loop_.fail(
        oldest, CanCause::kNoPosition,
        static_cast<std::uint32_t>(SampleGap::kMaxMissing * period_ns_ / model::kMillisecond_ns),
        Fault::kDeviceLost);
  }

  void stop_drives() RT_SAFE {
    // After the stop frames only what the other drives monitor, such as the host's heartbeat: the
    // fault of one drive must cause none in the others.
    if (fault_batches_ < kFaultBatches) {
      ++fault_batches_;
      drives_.push_fault(loop_);
    } else if (bus_->fault() == Fault::kNone) {
      drives_.push_after_fault(loop_);
    }
    bus_->send();
  }

  /// Off at once; on again from the beginning, so that each drive confirms its state again.
  void follow_permission() RT_SAFE {
    if (!permitted_) loop_.power = CanPower::kOff;
    if (!permitted_ || loop_.power != CanPower::kOff) return;
    loop_.power = CanPower::kStarting;
    loop_.asked_ns = 0;
  }

  std::string wait_text() const {
    const FaultCause wait = loop_.waits.cause();
    if (wait.kind == 0 || wait.axis > 2) return {};
    return fmt::format("waiting for power of {}: {}", can_arm_name(wait.axis, can_),
                       drives_.text_of(wait));
  }

  std::string text_of(const FaultCause& cause) const {
    auto text = silence_fault_detail(cause, start_.position);
    return text.empty() ? drives_.text_of(cause) : text;
  }

  std::unique_ptr<BasicCanBus<Frame>> bus_;
  DeltaSettings delta_settings_;
  CanSettings can_;
  CanDelta delta_;
  BasicCanStart<Frame> start_;
  BasicCanDrives<Frame>& drives_;
  std::int64_t period_ns_;
  SampleGap gap_;
  BasicCanLoop<Frame> loop_;
  bool permitted_ = false;
  int fault_batches_ = 0;  // sent since the fault
  int requests_ = 0;       // of each drive since the last read
  std::uint64_t sequence_ = 0;
  std::uint64_t cut_reads_ = 0;       // the kernel may have had more than one call takes
  std::uint64_t unknown_frames_ = 0;  // frames of nodes or kinds that are not ours
  ForeignCommands foreign_commands_;
};

}  // namespace

template <class Frame>
model::Result<std::unique_ptr<Device>> start_can_device(std::unique_ptr<BasicCanBus<Frame>> bus,
                                                        const model::DeviceSettings& settings,
                                                        double rate_Hz,
                                                        BasicCanStart<Frame> start) {
  auto device =
      std::make_unique<CanDevice<Frame>>(std::move(bus), settings, rate_Hz, std::move(start));
  if (auto error = device->check_home()) return *error;
  return std::unique_ptr<Device>(std::move(device));
}

template model::Result<std::unique_ptr<Device>> start_can_device(std::unique_ptr<CanBus>,
                                                                 const model::DeviceSettings&,
                                                                 double, CanStart);
template model::Result<std::unique_ptr<Device>> start_can_device(std::unique_ptr<CanFdBus>,
                                                                 const model::DeviceSettings&,
                                                                 double, CanFdStart);

}  // namespace tact::hal::can
