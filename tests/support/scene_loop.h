// SPDX-License-Identifier: Apache-2.0
// scene_loop.h - the whole controller of a shipped scene with its simulated device and hand, armed
// at the start, on a clock that the test moves.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "firmware/loop/rt_loop.h"
#include "firmware/pc/rt_setup.h"
#include "hal/registry/open_device.h"
#include "model/scene/tissue.h"
#include "model/time_ns.h"

namespace tact::tests {

inline model::scene::Scene shipped_scene(const std::string& name) {
  const auto scene =
      hal::registry::load_scene(TACT_SOURCE_DIR "/model/scenes/" + name + ".toml", {});
  EXPECT_TRUE(scene) << scene.error().message;
  return *scene;
}

inline bool any_in(const firmware::loop::TickRecord& record, model::ContactState state) {
  for (const auto& sphere_contact : record.contacts.all())
    if (sphere_contact.state == state) return true;
  return false;
}

/// The scene outlives it.
struct SceneLoop {
  explicit SceneLoop(const model::scene::Scene& scene, std::uint32_t ticks_per_shape = 0)
      : tissue(std::move(*model::scene::make_tissue(scene))),
        device(std::move(*hal::registry::open_device(scene))),
        controller(tissue->contact_scene(),
                   firmware::gate::Gate(scene.limits, 1.0 / scene.rate_Hz, 1.0),
                   /*hard_real_time=*/true),
        period_ns(model::period_ns(scene.rate_Hz)),
        loop({.period_ns = period_ns, .ticks_per_shape = ticks_per_shape}, *device, lines,
             controller, clock, requests, *ring) {
    firmware::pc::flush_denormals();
    requests.arm_at_start.store(true);
  }

  std::unique_ptr<model::scene::Tissue> tissue;
  hal::registry::OpenDevice device;
  firmware::loop::Controller controller;
  firmware::loop::SimulatedClock clock;
  firmware::loop::Requests requests;
  hal::NoSafetyLines lines;
  std::unique_ptr<firmware::loop::TickRing> ring = std::make_unique<firmware::loop::TickRing>();
  std::int64_t period_ns;
  firmware::loop::RtLoop loop;
};

}  // namespace tact::tests
