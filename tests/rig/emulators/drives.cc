// SPDX-License-Identifier: Apache-2.0
// tact-rig-drives - three emulated motor drives of a delta on a CAN bus, with its arms and a hand.
//
// The other side of the cable: it speaks ODrive CANSimple 0.5, 0.6, CiA 402 over CANopen or moteus
// over CAN FD, turns torques into motion of the example delta and counts into samples, and commits
// faults to order.
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "tests/rig/emulators/cia402/cia402_drive.h"
#include "tests/rig/emulators/mechanics/delta_mechanism.h"
#include "tests/rig/emulators/moteus/moteus_drive.h"
#include "tests/rig/emulators/odrive/odrive_drive.h"
#include "tests/rig/emulators/run/emulator_options.h"
#include "tests/rig/emulators/run/real_time.h"
#include "tests/rig/emulators/run/run_record.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace {

using namespace tact::rig;

constexpr const char* kProgram = "tact-rig-drives";
constexpr std::int64_t kTick_ns = 1'000'000;
constexpr int kFramesPerTurn = 64;  // of the loop, at most

struct Options : EmulatorOptions {
  std::string protocol = "odrive06", interface = "can1";
  std::vector<int> nodes{1, 2, 3};
  double gear = 10.0;
  std::vector<double> zero_turns{0.0, 0.0, 0.0};
  std::vector<int> direction{1, 1, 1};
  int phase_us = 0;
  OdriveSettings odrive{};
  Cia402Settings cia402{};
  MoteusSettings moteus{};

  bool is_cia402() const { return protocol == "cia402"; }
  bool is_moteus() const { return protocol == "moteus"; }
  /// Estimates leave every millisecond, for any host.
  bool has_own_clock() const { return !is_cia402() && !is_moteus(); }
};

void add_odrive(CLI::App& app, OdriveSettings& odrive) {
  app.add_option("--watchdog-ms", odrive.watchdog_ms, "ODrive; 0: off")->capture_default_str();
  app.add_flag("--watchdog-in-idle", odrive.watchdog_in_idle,
               "ODrive 0.6: it runs in idle too, as in 0.5");
  app.add_option("--heartbeat-ms", odrive.heartbeat_ms, "ODrive")->capture_default_str();
  app.add_option("--error-ms", odrive.error_ms, "ODrive 0.6: period of Get_Error; 0: on request");
  app.add_option("--power-on-turns", odrive.power_on_turns,
                 "ODrive: added to the position until the index is found; 0: it is absolute");
  app.add_flag("--estimates-from-power-on", odrive.estimates_from_power_on,
               "ODrive 0.5: without waiting for closed loop, unlike firmware 0.5.6");
  app.add_flag("--torque-velocity-limit", odrive.torque_velocity_limit,
               "ODrive: velocity cuts the torque, the vendor's default");
  app.add_option("--velocity-limit-turns-per-s", odrive.velocity_limit_turns_per_s,
                 "ODrive; the vendor's default is 2")
      ->capture_default_str();
}

void add_cia402(CLI::App& app, Cia402Settings& cia402) {
  app.add_option("--rated-torque-Nm", cia402.rated_torque_Nm, "CiA 402, object 6076, to the mN m")
      ->check(CLI::Range(0.001, 100.0))
      ->capture_default_str();
  app.add_flag("--no-request-stays", cia402.habits.no_request_stays,
               "CiA 402: bit 30 of 1800:01 may not be cleared");
  app.add_flag("--watch-off-first", cia402.habits.watch_off_first,
               "CiA 402: 1016:01 is not written again while it is on");
  app.add_flag("--sizes-unsaid", cia402.habits.sizes_unsaid, "CiA 402: uploads without their size");
  app.add_option("--absent", cia402.habits.absent,
                 "CiA 402: indices of objects that it does not have")
      ->delimiter(',');
  app.add_option("--guard-time-ms", cia402.habits.guard_time_ms, "CiA 402: 100C as stored")
      ->check(CLI::Range(0, 65535));
  app.add_option("--life-time-factor", cia402.habits.life_time_factor, "CiA 402: 100D as stored")
      ->check(CLI::Range(0, 255));
  app.add_flag("--life-hides-host", cia402.habits.life_hides_host,
               "CiA 402: with a life time a host that falls silent is not missed");
  app.add_flag("--life-from-boot", cia402.habits.life_from_boot,
               "CiA 402: the life time counts from boot-up, not from the first guard request");
  app.add_option("--enable-ms", cia402.enable_ms, "CiA 402: until the power stage is on")
      ->capture_default_str();
}

void add_own(CLI::App& app, Options& options) {
  app.add_option("--protocol", options.protocol)
      ->check(CLI::IsMember({"odrive05", "odrive06", "cia402", "moteus"}))
      ->capture_default_str();
  app.add_option("--interface", options.interface)->capture_default_str();
  app.add_option("--nodes", options.nodes, "Node numbers of the axes")
      ->expected(3)
      ->delimiter(',')
      ->check(CLI::Range(1, 62))
      ->capture_default_str();
  app.add_option("--gear", options.gear, "Turns of the motor per turn of the joint")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  app.add_option("--zero-turns", options.zero_turns, "Position of the motor at theta = 0, turns")
      ->expected(3)
      ->delimiter(',');
  app.add_option("--direction", options.direction, "1, or -1 where the motor turns the other way")
      ->expected(3)
      ->delimiter(',')
      ->check(CLI::IsMember({-1, 1}));
  app.add_option("--phase-us", options.phase_us,
                 "Shift of the drives' clock within the millisecond")
      ->check(CLI::Range(0, 999));
  add_odrive(app, options.odrive);
  add_cia402(app, options.cia402);
  app.add_option("--timeout-mode", options.moteus.timeout_mode,
                 "moteus: what its watchdog does; 0: lets go, 12: damps")
      ->check(CLI::IsMember({0, 12}))
      ->capture_default_str();
}

class Drives {
 public:
  Drives(const Options& options, FaultPlan& faults, CanBus& bus)
      : options_(options),
        faults_(faults),
        bus_(bus),
        platform_(delta_, options.hand, monotonic_ns()),
        record_(options.room_s(), !options.record.empty()) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      if (options.is_cia402()) {
        drives_[i] = std::make_unique<Cia402Drive>(axis, options.nodes[i], options.cia402, bus,
                                                   motors_[i], faults);
      } else if (options.is_moteus()) {
        drives_[i] = std::make_unique<MoteusDrive>(axis, options.nodes[i], options.moteus, bus,
                                                   motors_[i], faults);
      } else {
        drives_[i] = std::make_unique<OdriveDrive>(axis, options.nodes[i], options.odrive, bus,
                                                   motors_[i], faults);
      }
    }
  }

  void run() {
    std::int64_t next_ns = (monotonic_ns() / kTick_ns + 1) * kTick_ns + phase_ns_;
    const std::int64_t end_ns =
        next_ns +
        static_cast<std::int64_t>(1e9 * (options_.seconds > 0.0 ? options_.seconds : 1e8));
    while (!stop_asked() && next_ns < end_ns) {
      const bool woken = wait_readable(bus_.descriptor(), next_ns);
      int taken = 0;
      for (; taken < kFramesPerTurn; ++taken) {
        const auto frame = bus_.receive();
        if (!frame) break;
        receive(*frame, monotonic_ns());
      }
      // A link that is down makes the socket readable without a frame: never spin at this priority.
      if (woken && taken == 0) wait_readable(-1, next_ns);
      const std::int64_t now_ns = monotonic_ns();
      if (now_ns < next_ns) continue;
      tick(now_ns);
      next_ns = std::max(next_ns + kTick_ns, now_ns - now_ns % kTick_ns + phase_ns_);
    }
  }

  const RunRecord& record() const { return record_; }
  std::string json() const {
    return record_.json(options_.protocol, platform_, faults_, watchdog_trips_);
  }

 private:
  double to_motor(std::size_t i, double joint_rad) const {
    return options_.direction[i] * joint_rad * options_.gear / (2.0 * M_PI);
  }
  /// The motors as they are now, from the torques up to now.
  void move(std::int64_t now_ns) {
    platform_.advance(now_ns, tau_Nm_);
    const Joints rate_radps = platform_.joint_velocity_radps();
    for (std::size_t i = 0; i < 3; ++i) {
      motors_[i].position_turns =
          options_.zero_turns[i] + to_motor(i, platform_.pose().theta_rad[i]);
      motors_[i].velocity_turns_per_s = to_motor(i, rate_radps[i]);
    }
  }
  void take_torques() {
    for (std::size_t i = 0; i < 3; ++i)
      tau_Nm_[i] = options_.direction[i] * options_.gear * drives_[i]->torque_Nm();
  }
  bool all_enabled() const {
    return drives_[0]->is_enabled() && drives_[1]->is_enabled() && drives_[2]->is_enabled();
  }

  void receive(const canfd_frame& frame, std::int64_t now_ns) {
    move(now_ns);
    const bool is_sync = options_.is_cia402() && (frame.can_id & CAN_SFF_MASK) == 0x080;
    if (is_sync) record_.cycle_begins(now_ns);
    for (int axis = 0; axis < 3; ++axis) {
      if (!drives_[static_cast<std::size_t>(axis)]->receive(frame, now_ns)) continue;
      take_torques();
      record_.commanded(axis, platform_, tau_Nm_, faults_, now_ns);
      if (!options_.is_moteus() || axis != 2) continue;
      // The last command of a tick has asked for the positions of the next one.
      record_.cycle_begins(now_ns);
      record_.answer_sent(now_ns, monotonic_ns());
    }
    take_torques();
    // A frame that stops commands no torque; no torque at all is no middle of a batch.
    if (tau_Nm_ == Joints{}) record_.watch(platform_, tau_Nm_, faults_, now_ns);
    if (is_sync) record_.answer_sent(now_ns, monotonic_ns());
  }

  void tick(std::int64_t now_ns) {
    move(now_ns);
    if (all_enabled() || options_.faults_start_at_once()) faults_.start(now_ns);
    if (all_enabled()) platform_.release(now_ns);
    faults_.tick(now_ns);
    bus_.tick(now_ns);
    take_torques();
    record_.tick(platform_, tau_Nm_, all_enabled(), faults_, now_ns);
    if (options_.has_own_clock()) record_.cycle_begins(now_ns);
    for (int axis = 0; axis < 3; ++axis) {
      Drive& drive = *drives_[static_cast<std::size_t>(axis)];
      if (faults_.once(FaultKind::kDriveFault, axis, now_ns)) drive.fail(now_ns);
      if (faults_.once(FaultKind::kEmcy, axis, now_ns)) drive.warn(now_ns);
      drive.tick(now_ns);
      if (!drive.tripped()) continue;
      ++watchdog_trips_;
      faults_.watchdog_tripped();
    }
    take_torques();
    if (options_.has_own_clock()) record_.answer_sent(now_ns, monotonic_ns());
  }

  const Options& options_;
  const std::int64_t phase_ns_ = options_.phase_us * std::int64_t{1000};
  FaultPlan& faults_;
  CanBus& bus_;
  DeltaMechanism delta_;
  Platform platform_;
  RunRecord record_;
  std::array<Motor, 3> motors_{};
  std::array<std::unique_ptr<Drive>, 3> drives_{};
  Joints tau_Nm_{};
  int watchdog_trips_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Three emulated motor drives of a delta on CAN, with its arms and a hand", kProgram);
  Options options;
  add_options(app, options, FaultSide::kDrives);
  add_own(app, options);
  CLI11_PARSE(app, argc, argv);
  if (!options.self_check.empty()) return check_drives(options.self_check);
  options.odrive.generation =
      options.protocol == "odrive05" ? OdriveGeneration::k05 : OdriveGeneration::k06;

  std::string error;
  FaultPlan faults;
  if (!parse_faults(options, FaultSide::kDrives, faults, error)) return refuse(kProgram, error);
  for (const Fault& fault : faults.faults())
    if (fault.kind == FaultKind::kEmcy && !options.is_cia402())
      return refuse(kProgram, "these drives send no emergency frames: take drive-fault, or cia402");
  CanBus bus(faults,
             options.is_cia402()   ? 1
             : options.is_moteus() ? 0x100
                                   : 32,
             options.is_moteus());
  if (!bus.open(options.interface, error)) return refuse(kProgram, error);
  Drives drives(options, faults, bus);
  if (!enter_real_time(options.priority, error)) return refuse(kProgram, error);
  catch_stop_signals();
  std::fprintf(stderr, "%s: ready\n", kProgram);
  drives.run();
  leave_real_time();
  return finish(kProgram, options, drives.record(), drives.json());
}
