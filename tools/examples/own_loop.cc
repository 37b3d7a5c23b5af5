// SPDX-License-Identifier: Apache-2.0
// own_loop - tact's controller in a program with its own loop and its own device, for 1 s. Organ,
// law, tool and limits are those of a scene. Prints the largest force that the device got.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "firmware/gate/limits_for.h"
#include "firmware/loop/controller.h"
#include "hal/device.h"
#include "model/scene/scene.h"
#include "model/scene/tissue.h"

using namespace tact;
using Clock = std::chrono::steady_clock;

namespace {

/// In place of your device. It follows a path: from 4 mm above the organ 8 mm in and out, in 1 s.
class Handle final : public hal::Device {
 public:
  explicit Handle(const model::scene::Scene& scene)
      : site_m_(scene.hand_site_m), inward_(scene.hand_inward) {
    for (const auto& sphere : scene.tool.spheres)
      reach_m_ = std::max(reach_m_, dot(sphere.offset_m, inward_) + sphere.radius_m);
  }
  hal::DeviceInfo info() const override {
    return {.name = "handle",
            .max_force_N = 8.0,
            .workspace_radius_m = 0.1,
            .workspace_half_length_m = 0.1,
            .grip = hal::GripKind::kNone};
  }
  hal::Fault read(hal::Sample& sample, std::int64_t now_ns) RT_SAFE override {
    if (start_ns_ == 0) start_ns_ = now_ns;
    const double depth_m =
        -0.004 * std::cos(6.283 * 1e-9 * static_cast<double>(now_ns - start_ns_));
    sample.tool.position_m = site_m_ + (depth_m - reach_m_) * inward_;
    sample.stamp_ns = now_ns;
    ++sample.sequence;
    sample.fresh = true;
    return hal::Fault::kNone;
  }
  hal::Fault write(const model::Wrench& wrench) RT_SAFE override {
    largest_N = std::max(largest_N, norm(wrench.force_N));
    return hal::Fault::kNone;
  }
  void stop() override {}

  double largest_N = 0.0;

 private:
  model::Vec3 site_m_, inward_;
  double reach_m_ = 0.0;
  std::int64_t start_ns_ = 0;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::fputs("usage: own_loop SCENE.toml\n", stderr), 2;
  const auto scene = model::scene::load_scene(arguments[1], {});
  if (!scene) return std::fprintf(stderr, "%s\n", scene.error().message.c_str()), 2;
  const auto tissue = model::scene::make_tissue(*scene);
  if (!tissue) return std::fprintf(stderr, "%s\n", tissue.error().message.c_str()), 2;

  Handle device(*scene);
  const double period_s = 1.0 / scene->rate_Hz;
  const model::Limits limits = firmware::gate::limits_for(scene->limits, device.info());
  firmware::loop::Controller controller(
      (*tissue)->contact_scene(),
      firmware::gate::Gate(limits, period_s, firmware::gate::kNonRtForceShare), false);

  const auto period =
      std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s));
  firmware::loop::TickInput input;
  firmware::loop::TickOutput out;
  hal::Fault wrote = hal::Fault::kNone;
  const auto start = Clock::now();
  for (auto due = start; due < start + std::chrono::seconds(1) && out.fault == model::Fault::kNone;
       due += period) {
    std::this_thread::sleep_until(due);
    const auto now = Clock::now();
    // Tells the controller how many periods a late loop has skipped.
    input.skipped_periods = static_cast<std::uint32_t>((now - due) / period);
    due += input.skipped_periods * period;
    const hal::Fault read = device.read(input.sample, now.time_since_epoch().count());
    input.device_fault = model::latches(read) ? read : wrote;
    // Example only: in your program, arm only on a person's request.
    input.commands.arm = out.state == firmware::loop::State::kReady;
    out = controller.tick(input);
    wrote = device.write(out.written);
  }
  device.stop();
  std::printf("largest force %.3f N, limit %.3f N, %s\n", device.largest_N,
              controller.gate().force_limit_N(), model::describe(out.fault).name);
  return out.fault == model::Fault::kNone ? 0 : 1;
}
