// SPDX-License-Identifier: Apache-2.0
#include "firmware/telemetry/frame_builder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "tests/support/shapes.h"

namespace tact::firmware::telemetry::frame_builder_test {

using model::ContactState;
using model::Vec3;
using model::contact::Indentation;

/// A law whose indentations lean, the more the deeper.
class LeaningLaw final : public model::contact::ContactLaw {
 public:
  model::contact::ContactLawResponse respond(const Indentation&) RT_SAFE override { return {}; }
  void leave(std::size_t) RT_SAFE override {}
  void advance() RT_SAFE override {}
  std::size_t profile(const Indentation&, std::span<double>) const RT_SAFE override { return 1; }
  double ring_pitch_m() const RT_SAFE override { return 0.002; }
  Vec3 tilt(const Indentation& in) const RT_SAFE override {
    return in.indentation_m * Vec3{10, -20, 30};
  }
};

TEST(FrameBuilder, CarriesTheTiltOfTheIndentation) {
  const LeaningLaw law;
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  FrameBuilder builder(law, *shapes, false);
  std::array<model::contact::SphereContact, 2> contacts;
  contacts[0].state = ContactState::kInContact;
  for (auto& sphere_contact : contacts) sphere_contact.indentation_m = 0.004;
  loop::TickRecord record;
  record.contacts.assign(contacts);
  builder.add(record);
  const Frame frame = builder.take(0);
  EXPECT_FLOAT_EQ(frame.contact[0].tilt[0], 0.04F);
  EXPECT_FLOAT_EQ(frame.contact[0].tilt[1], -0.08F);
  EXPECT_FLOAT_EQ(frame.contact[0].tilt[2], 0.12F);
  for (const float of_a_free_one : frame.contact[1].tilt) EXPECT_EQ(of_a_free_one, 0.0F);
}

TEST(FrameBuilder, CarriesLossesOfContactAndASphereInsideWithoutIndentation) {
  const LeaningLaw law;
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  FrameBuilder builder(law, *shapes, false);
  std::array<model::contact::SphereContact, 1> contacts;
  contacts[0].state = ContactState::kInside;
  contacts[0].indentation_m = 0.004;
  loop::TickRecord record;
  record.contacts.assign(contacts);
  record.output.contact_losses = 7;
  builder.add(record);
  const Frame frame = builder.take(0);
  EXPECT_EQ(frame.contact_losses, 7u);
  EXPECT_EQ(frame.contact[0].state, model::ContactState::kInside);
  EXPECT_EQ(frame.contact[0].tilt[0], 0.0F);
  record.output.contact_losses = 5'000'000'000;
  const LoggedTick tick = LoggedTick::of(record, false);
  EXPECT_EQ(frame_of_tick(frame, tick, 0).contact_losses, 4'294'967'295u);
}

TEST(FrameBuilder, CountsEveryTickByWakeUpLatencyAndDuration) {
  const LeaningLaw law;
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  FrameBuilder builder(law, *shapes, false);
  loop::TickRecord record;
  const auto add = [&](std::int32_t wake_ns, std::int32_t total_before_ns) {
    record.phase_ns.front() = wake_ns;
    record.phase_ns.back() = total_before_ns;
    builder.add(record);
    ++record.tick;
  };
  add(1'000, 0);  // before the first tick there was none
  add(1'001, 20'000);
  const Frame first = builder.take(0);
  add(6'000'000, 20'001);
  const Frame second = builder.take(0);
  EXPECT_EQ(first.wake.ticks[0], 1u) << "the bound belongs to its bucket";
  EXPECT_EQ(first.wake.ticks[1], 1u);
  EXPECT_EQ(first.duration.ticks[4], 1u);
  EXPECT_EQ(second.wake.ticks[0], 1u) << "since the start, not since the last frame";
  EXPECT_EQ(std::accumulate(std::begin(second.wake.ticks), std::end(second.wake.ticks), 0u), 3u);
  EXPECT_EQ(second.wake.ticks[protocol::FrameDurations::kBound_us.size()], 1u);
  EXPECT_EQ(second.duration.ticks[5], 1u);
  EXPECT_EQ(second.wake.sum_ns, 6'002'001u);
  EXPECT_EQ(second.duration.sum_ns, 40'001u);
}

TEST(FrameBuilder, NamesTheBoundsOfItsHistograms) {
  const auto& bound_us = protocol::FrameDurations::kBound_us;
  const auto names = protocol::FrameDurations::fields().front().components;
  ASSERT_EQ(names.size(), bound_us.size() + 1);
  for (std::size_t i = 0; i < bound_us.size(); ++i)
    EXPECT_EQ(names[i], std::to_string(bound_us[i]) + "us");
}

TEST(FrameBuilder, CarriesTheTemperatureOfADeviceThatReportsOne) {
  const LeaningLaw law;
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  FrameBuilder builder(law, *shapes, false);
  loop::TickRecord record;
  builder.add(record);
  EXPECT_TRUE(std::isnan(builder.take(0).temperature_C));
  record.input.sample.temperature_C = 41.0;
  builder.add(record);
  EXPECT_EQ(builder.take(0).temperature_C, 41.0F);
}

TEST(FrameBuilder, KeepsTheNewestEvent) {
  const LeaningLaw law;
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  FrameBuilder builder(law, *shapes, false);
  loop::TickRecord record;
  record.due_ns = 5;
  record.event = 4;
  builder.add(record);
  record.due_ns = 6;
  record.event = 0;
  builder.add(record);
  for (int frames = 0; frames < 2; ++frames) {
    const Frame frame = builder.take(0);
    EXPECT_EQ(frame.event.number, 4);
    EXPECT_EQ(frame.event.due_ns, 5);
  }
}

TEST(FrameBuilder, TheMeshesEndWithTheColoursOfTheOrgansVertices) {
  model::scene::Scene scene;
  scene.organ_mesh = tests::make_plate(0.1, 1);
  const std::size_t plain = mesh_bytes(scene).size();
  scene.look.vertex_color.assign(scene.organ_mesh.vertex_m.size(), {1, 2, 3});
  scene.look.vertex_color.back() = {7, 8, 9};
  const std::vector<std::byte> bytes = mesh_bytes(scene);
  EXPECT_EQ(bytes.size(), plain + 3 * scene.organ_mesh.vertex_m.size());
  EXPECT_EQ(bytes.back(), std::byte{9});
  EXPECT_EQ(bytes[bytes.size() - 3], std::byte{7});
}

}  // namespace tact::firmware::telemetry::frame_builder_test
