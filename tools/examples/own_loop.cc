// SPDX-License-Identifier: Apache-2.0
// own_loop - tact's controller in a program with its own loop and its own device, for 1 s. Organ,
// law, tool and limits are those of a scene. Prints the largest force that the device got.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

#include "firmware/embed/haptics.h"

using namespace tact;
using Clock = std::chrono::steady_clock;

namespace {

hal::DeviceInfo handle_info() {
  return {.name = "handle",
          .max_force_N = 8.0,
          .workspace_radius_m = 0.1,
          .workspace_half_length_m = 0.1,
          .grip = hal::GripKind::kNone};
}

/// In place of your device. It follows a path: from 4 mm above the organ 8 mm in and out, in 1 s.
class Handle final : public hal::Device {
 public:
  explicit Handle(const model::scene::Scene& scene)
      : site_m_(scene.hand_site_m), inward_(scene.hand_inward) {
    for (const auto& sphere : scene.tool.spheres)
      reach_m_ = std::max(reach_m_, dot(sphere.offset_m, inward_) + sphere.radius_m);
  }
  hal::DeviceInfo info() const override { return handle_info(); }
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
  // The limits are the smaller ones of the scene and of the device.
  const auto made = Haptics::make(arguments[1], {.device = handle_info()});
  if (!made) return std::fprintf(stderr, "%s\n", made.error().message.c_str()), 2;
  Haptics& haptics = **made;
  const model::scene::Scene& scene = haptics.scene();
  Handle device(scene);

  const auto period = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(1.0 / scene.rate_Hz));
  firmware::loop::TickOutput out;
  hal::Sample sample;
  hal::Fault wrote = hal::Fault::kNone;
  const auto start = Clock::now();
  for (auto due = start; due < start + std::chrono::seconds(1) && out.fault == model::Fault::kNone;
       due += period) {
    std::this_thread::sleep_until(due);
    const auto now = Clock::now();
    // Passes to the controller how many periods a late loop has skipped.
    const auto skipped = static_cast<std::uint32_t>((now - due) / period);
    due += skipped * period;
    sample.fresh = false;
    const hal::Fault read = device.read(sample, now.time_since_epoch().count());
    // Example only: in your program, arm only on a person's request.
    if (out.state == firmware::loop::State::kReady) haptics.arm();
    out = haptics.tick(sample, skipped, model::latches(read) ? read : wrote);
    wrote = device.write(out.written);
  }
  device.stop();
  std::printf("largest force %.3f N, limit %.3f N, %s\n", device.largest_N, haptics.force_limit_N(),
              model::describe(out.fault).name);
  return out.fault == model::Fault::kNone && wrote == hal::Fault::kNone ? 0 : 1;
}
