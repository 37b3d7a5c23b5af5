// SPDX-License-Identifier: Apache-2.0
// tact-rig-falcon - an emulated Falcon on a port of the kernel's virtual USB host controller.
//
// USB adapter, boot ROM, upload, homing and one report per command, with the exact manipulator and
// a hand behind it. It commits faults to order and reports what the controller did.
#include <cmath>
#include <cstdio>

#include "tests/rig/emulators/falcon/falcon_usb.h"
#include "tests/rig/emulators/mechanics/falcon_mechanism.h"
#include "tests/rig/emulators/run/emulator_options.h"
#include "tests/rig/emulators/run/real_time.h"
#include "tests/rig/emulators/run/run_record.h"
#include "tests/rig/emulators/self_check/self_check.h"

namespace {

using namespace tact::rig;

constexpr const char* kProgram = "tact-rig-falcon";
constexpr std::int64_t kTick_ns = 1'000'000;
constexpr double kPullOut_m = 0.020, kPushIn_m = -0.015;

struct Options : EmulatorOptions {
  int port = 0, frame_us = 125;
  bool no_nulls = false;
  double middle_m = 0.120, weighing_kg = 0.0;
  FalconSettings falcon{};
};

void add_own(CLI::App& app, Options& options) {
  app.add_option("--port", options.port, "Port of vhci_hcd")->capture_default_str();
  app.add_option("-f,--frame-us", options.frame_us,
                 "Transfers complete on this grid: 1000 frames, 125 microframes, 0 at once")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_flag("--running", options.falcon.runs_already, "Firmware runs from before");
  app.add_option("--image-bytes", options.falcon.image_bytes, "Size of the image it waits for")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  app.add_option("--homing-ms", options.falcon.homing_ms, "How long the hand pulls out and in")
      ->check(CLI::Range(0, 60'000))
      ->capture_default_str();
  app.add_option("--watchdog-ms", options.falcon.watchdog_ms,
                 "Motors drop this long after the last command; 0: they hold it");
  app.add_option("--torque-per-word", options.falcon.torque_per_word_Nm, "N m")
      ->check(CLI::Range(1e-6, 1e-2))
      ->capture_default_str();
  app.add_option("--middle", options.middle_m, "Origin of W on the device's axis, m")
      ->check(CLI::Range(0.07, 0.17))
      ->capture_default_str();
  app.add_option("--weight-kg", options.weighing_kg,
                 "What gravity pulls, and the host is expected to carry")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_flag("--no-null-bytes", options.no_nulls,
               "Changing the speed leaves no extra null byte, as it does about every second time");
}

class Falcon {
 public:
  Falcon(const Options& options, FaultPlan& faults, UsbipPort& port)
      : options_(options),
        faults_(faults),
        port_(port),
        mechanism_(options.middle_m, options.weighing_kg),
        platform_(mechanism_, options.hand, monotonic_ns()),
        record_(options.room_s(), !options.record.empty()),
        firmware_(options.falcon, faults),
        chip_(firmware_, !options.no_nulls),
        usb_(port, chip_, faults, options.frame_us, [this](std::int64_t now_ns) {
          if (firmware_.is_homed()) record_.cycle_begins(now_ns);
          if (command_ns_ != 0) record_.answer_sent(command_ns_, now_ns);
          command_ns_ = 0;
        }) {}

  void run() {
    std::int64_t next_ns = (monotonic_ns() / kTick_ns + 1) * kTick_ns;
    const std::int64_t end_ns =
        next_ns +
        static_cast<std::int64_t>(1e9 * (options_.seconds > 0.0 ? options_.seconds : 1e8));
    while (!stop_asked() && next_ns < end_ns) {
      wait_readable(port_.descriptor(), std::min(next_ns, usb_.next_ns()));
      const std::int64_t now_ns = monotonic_ns();
      move(now_ns);
      usb_.serve(now_ns);
      if (firmware_.took_command()) {
        command_ns_ = now_ns;
        if (firmware_.is_homed())
          record_.commanded(-1, platform_, firmware_.torque_Nm(), faults_, now_ns);
      }
      if (now_ns < next_ns) continue;
      tick(now_ns);
      next_ns = std::max(next_ns + kTick_ns, now_ns - now_ns % kTick_ns);
    }
    port_.detach();
  }

  const RunRecord& record() const { return record_; }
  std::string json() const { return record_.json("falcon", platform_, faults_, watchdog_trips_); }

 private:
  void move(std::int64_t now_ns) {
    platform_.advance(now_ns, firmware_.torque_Nm());
    firmware_.set_joints(platform_.pose().theta_rad);
  }

  void tick(std::int64_t now_ns) {
    const bool homed = firmware_.is_homed();
    if (homed || options_.faults_start_at_once()) faults_.start(now_ns);
    if (homed) platform_.release(now_ns);
    // Out in the first half of the homing motion, in during the second, and back.
    const double share = firmware_.homing_share(now_ns);
    const double pull_m = share < 0.5 ? kPullOut_m : kPushIn_m;
    platform_.pull({pull_m * std::pow(std::sin(2.0 * M_PI * share), 2.0), 0.0, 0.0});
    faults_.tick(now_ns);
    firmware_.tick(now_ns);
    if (firmware_.tripped()) {
      ++watchdog_trips_;
      faults_.watchdog_tripped();
    }
    record_.tick(platform_, firmware_.torque_Nm(), homed, faults_, now_ns);
    plug(now_ns);
  }

  void plug(std::int64_t now_ns) {
    if (faults_.once(FaultKind::kUnplug, -1, now_ns)) {
      usb_.unplugged();
      for (const Fault& fault : faults_.faults())
        if (fault.kind == FaultKind::kUnplug && fault.injected_ns != 0 && fault.duration_ns > 0)
          replug_ns_ = now_ns + fault.duration_ns;
    }
    if (replug_ns_ == 0 || now_ns < replug_ns_) return;
    std::string error;  // the port needs a moment to be free: it is tried again
    replug_ns_ = port_.attach(options_.port, error) ? 0 : now_ns + 10 * kTick_ns;
  }

  const Options& options_;
  FaultPlan& faults_;
  UsbipPort& port_;
  FalconMechanism mechanism_;
  Platform platform_;
  RunRecord record_;
  FalconFirmware firmware_;
  FtdiChip chip_;
  FalconUsb usb_;
  std::int64_t command_ns_ = 0, replug_ns_ = 0;
  int watchdog_trips_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("An emulated Falcon on vhci_hcd, with its manipulator and a hand", kProgram);
  Options options;
  options.hand.top_m = 0.030;  // its workspace is a ball of 40 mm
  add_options(app, options, FaultSide::kFalcon);
  add_own(app, options);
  CLI11_PARSE(app, argc, argv);
  if (!options.self_check.empty()) return check_falcon(options.self_check);

  std::string error;
  FaultPlan faults;
  if (!parse_faults(options, FaultSide::kFalcon, faults, error)) return refuse(kProgram, error);
  UsbipPort port;
  Falcon falcon(options, faults, port);
  if (!enter_real_time(options.priority, error)) return refuse(kProgram, error);
  if (!port.attach(options.port, error)) return refuse(kProgram, error);
  catch_stop_signals();
  std::fprintf(stderr, "%s: ready\n", kProgram);
  falcon.run();
  leave_real_time();
  return finish(kProgram, options, falcon.record(), falcon.json());
}
