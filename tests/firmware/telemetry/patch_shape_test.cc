// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "firmware/loop/rt_loop.h"
#include "firmware/telemetry/telemetry.h"
#include "hal/registry/open_device.h"
#include "host/server/frame_json.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::telemetry::patch_shape_test {

using tests::message_of;

// The whole way of a patch: springs, shape, slot, frame, text for the page. One thread steps, the
// other publishes; what arrives names only what the organ has. (That no shape is half of another is
// for latest_slot_test and, here, the thread sanitizer.)
TEST(Telemetry, TheShapeOfAPatchReachesThePageWhole) {
  const auto scene = hal::registry::load_scene(TACT_SOURCE_DIR "/model/scenes/gum.toml", {});
  ASSERT_TRUE(scene) << scene.error().message;
  const auto tissue = std::move(*model::scene::make_tissue(*scene));
  const auto device = std::move(*hal::registry::open_device(*scene));
  loop::Controller controller(tissue->contact_scene(), gate::Gate(scene->limits, 0.001, 1.0),
                              /*hard_real_time=*/true);
  loop::SimulatedClock clock;
  hal::NoSafetyLines lines;
  loop::Requests requests;
  requests.arm_at_start.store(true);
  const auto ring = std::make_unique<loop::TickRing>();
  loop::RtLoop loop({.period_ns = 1'000'000, .ticks_per_shape = 4}, *device, lines, controller,
                    clock, requests, *ring);
  Telemetry telemetry(*ring, FrameBuilder(tissue->law().contact_law(), controller.shapes(), false),
                      {.frame_rate_Hz = 1000.0}, Sinks{});
  const RunHeader header = header_of(*scene, *tissue);
  ASSERT_FALSE(telemetry.start());
  std::uint32_t displaced = 0;
  for (int i = 0; i < 8000; ++i) {
    loop.step();
    if (i % 50 != 0) continue;
    const Frame frame = telemetry.newest_frame();
    ASSERT_EQ(message_of(host::record::check_frame(frame, header)), "") << "tick " << frame.tick;
    const auto patch = nlohmann::json::parse(host::server::frame_json(frame, header)).at("patch");
    ASSERT_EQ(patch.at("count"), frame.patch.vertex_count);
    ASSERT_EQ(patch.at("cut").size(), frame.patch.cut_count);
    displaced = std::max(displaced, frame.patch.vertex_count);
    usleep(500);
  }
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  EXPECT_GT(displaced, 10u);
  EXPECT_GT(telemetry.newest_frame().patch.cut_total, 5u);
  EXPECT_EQ(telemetry.newest_frame().fault, 0);
}

}  // namespace tact::firmware::telemetry::patch_shape_test
