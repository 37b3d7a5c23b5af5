// SPDX-License-Identifier: Apache-2.0
// tact-calibrate: what a device's motor commands are worth, from weights hung on it.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <vector>

#include "firmware/loop/clock.h"
#include "hal/falcon/falcon_balance.h"
#include "hal/falcon/falcon_calibration.h"
#include "hal/falcon/falcon_device.h"
#include "hal/falcon_usb/falcon_open.h"
#include "hal/registry/open_device.h"
#include "model/io/program/within.h"
#include "tools/calibrate/gated_run.h"
#include "tools/program/program.h"
#include "tools/program/run_program.h"

namespace {

using namespace tact::tools;
using tact::firmware::loop::MonotonicClock;
using tact::hal::Sample;
using tact::hal::falcon::FalconBalance;
using tact::hal::falcon::FalconBalanceRamp;
using tact::hal::falcon::FalconDevice;
using tact::model::Error;
using tact::model::Fault;
using tact::model::Result;

constexpr int kMaxMissed = 20;  // samples in a row

struct Options {
  std::string device;
  program::SceneArguments scene;
  std::vector<double> masses_kg{0.05, 0.1, 0.2, 0.3};
  int poses = 3;
};

void add_options(CLI::App& app, Options& o) {
  app.add_option("DEVICE", o.device, "falcon")->required()->check(CLI::IsMember({"falcon"}));
  o.scene.add_to(app, "[device.falcon]");
  app.add_option("--masses-kg", o.masses_kg, "what you hang on the grip, one after the other")
      ->expected(2, 20)
      ->check(tact::model::io::within(0.0, 0.5))
      ->capture_default_str();
  app.add_option("--poses", o.poses, "supports of different height and place")
      ->check(tact::model::io::within(2, 10))
      ->capture_default_str();
}

/// `tick` gives the force up and says whether to go on.
template <typename Tick>
Fault run(FalconDevice& device, Sample& sample, Tick tick) {
  MonotonicClock clock;
  return calibrate::run_gated(device, clock, sample, [&](double& up_N) {
    return tick(up_N) && !program::is_interrupted();
  });
}

void ask(const std::string& question) {
  fmt::print("{} ", question);
  std::fflush(stdout);
}

/// True for "yes", false for anything else, and for Ctrl-C.
bool read_yes() {
  std::string answer;
  return std::getline(std::cin, answer) && !program::is_interrupted() && answer == "yes";
}

/// Meanwhile the device is asked on, without force: one that is left alone stops answering.
bool agrees(FalconDevice& device, const std::string& question) {
  ask(question);
  Sample sample;
  const Fault fault = run(device, sample, [](double&) {
    pollfd terminal{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
    return poll(&terminal, 1, 0) == 0;
  });
  return fault == Fault::kNone && read_yes();
}

Error failed(const FalconDevice& device, Fault fault) {
  const std::string detail = device.fault_detail();
  return Error{detail.empty() ? tact::model::describe(fault).cause : detail};
}

Result<FalconBalance> balance(FalconDevice& device, double mass_kg) {
  Sample sample;
  FalconBalanceRamp ramp({});
  int missed = 0;
  const Fault fault = run(device, sample, [&, held_N = 0.0](double& up_N) mutable {
    missed = sample.fresh ? 0 : missed + 1;
    if (sample.fresh)
      held_N = ramp.step(sample.tool.position_m.z, norm(sample.tool.velocity_mps), device.words(),
                         1e-9 * calibrate::kPeriod_ns);
    up_N = held_N;
    return missed < kMaxMissed && !ramp.ended();
  });
  if (fault != Fault::kNone) return failed(device, fault);
  if (ramp.state() == FalconBalanceRamp::State::kBalanced)
    return FalconBalance{
        .position_m = device.position_D_m(), .mass_kg = mass_kg, .words = ramp.words()};
  return Error{ramp.ended() ? ramp.advice() : "the device did not answer: measure it again"};
}

std::optional<Error> home(FalconDevice& device) {
  fmt::print("{}\n", device.fault_detail());
  Sample sample;
  const Fault fault = run(device, sample, [&](double&) { return !sample.fresh; });
  if (fault != Fault::kNone) return failed(device, fault);
  if (!sample.fresh) return Error{"it is not homed"};
  return std::nullopt;
}

Result<std::vector<FalconBalance>> measure(FalconDevice& device, const Options& o) {
  std::vector<FalconBalance> samples;
  for (int pose = 1; pose <= o.poses; ++pose) {
    for (const double mass_kg : o.masses_kg) {
      if (!agrees(
              device,
              fmt::format("pose {} of {}: rest the grip on its support, hang {:.0f} g on it, hands "
                          "off. It will lift by 2 mm. Ready (yes)?",
                          pose, o.poses, 1000.0 * mass_kg)))
        return Error{device.fault_detail().empty() ? "not agreed to" : device.fault_detail()};
      const auto sample = balance(device, mass_kg);
      if (program::is_interrupted()) return program::interruption();
      if (!sample) {
        fmt::print("left out: {}\n", sample.error().message);
        if (device.fault_detail().empty()) continue;
        return sample.error();
      }
      fmt::print("balanced with the words {:.0f} {:.0f} {:.0f}\n", sample->words[0],
                 sample->words[1], sample->words[2]);
      samples.push_back(*sample);
    }
  }
  return samples;
}

Result<tact::hal::falcon::FalconCalibration> find_calibration(
    const Options& o, tact::hal::falcon::FalconSettings settings) {
  settings.moving_mass_kg = 0.0;  // the words shall be those of the load alone
  settings.dead_band_words = {};
  auto device = tact::hal::falcon_usb::open_falcon_device(settings);
  if (!device) return device.error();
  if (auto error = home(**device)) return std::move(*error);
  const auto samples = measure(**device, o);
  (*device)->stop();
  if (!samples) return samples.error();
  return tact::hal::falcon::fit_falcon(*samples);
}

}  // namespace

int main(int argc, char** argv) {
  program::Program program(
      "tact-calibrate",
      "Find what a Falcon's motor words are worth: hang known masses on its grip at several\n"
      "poses; prints the lines of [device.falcon] to paste into the scene.",
      "The device moves, by 2 mm and with at most 6 N: it asks before each motion, on a terminal.\n"
      "Masses in kg.");
  Options o;
  add_options(program.options(), o);
  if (const auto status = program.parse(argc, argv)) return *status;
  if (isatty(STDIN_FILENO) == 0 || isatty(STDOUT_FILENO) == 0)
    return program.fail({"asks before anything moves, so it needs a terminal: start it from one"});
  const auto scene = o.scene.load(tact::hal::registry::visit_device);
  if (!scene) return program.fail(scene.error());
  ask("The grip will move by itself, with at most 6 N. Keep faces and cups away. Go on (yes)?");
  if (!read_yes()) return program.fail({"not agreed to: nothing moved"});
  const auto found = find_calibration(o, scene->device.of<tact::hal::falcon::FalconSettings>());
  if (!found) return program.fail(found.error(), "no force is left");
  fmt::print("\n# {} masses at {} poses; the fit leaves {:.0f} words\n{}", o.masses_kg.size(),
             o.poses, found->residual_words, tact::hal::falcon::scene_lines(*found));
  return 0;
}
