// SPDX-License-Identifier: Apache-2.0
// UTC by CLOCK_MONOTONIC: the pair is true, and each record has the newest one.
#include "firmware/telemetry/utc_clock.h"

#include <gtest/gtest.h>
#include <sys/timex.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <memory>

#include "firmware/protocol/tick_log.h"
#include "firmware/telemetry/telemetry.h"
#include "hal/monotonic.h"
#include "tests/support/message.h"
#include "tests/support/test_scene.h"

namespace tact::firmware::telemetry::utc_clock_test {

std::int64_t utc_ns() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return t.tv_sec * model::kSecond_ns + t.tv_nsec;
}

TEST(UtcClock, TheOffsetLiesBetweenReadingsBeforeAndAfter) {
  const std::int64_t utc_before_ns = utc_ns(), before_ns = hal::monotonic_ns();
  const protocol::UtcOffset utc = read_utc_offset();
  const std::int64_t after_ns = hal::monotonic_ns(), utc_after_ns = utc_ns();
  EXPECT_GE(utc.offset_ns, utc_before_ns - after_ns);
  EXPECT_LE(utc.offset_ns, utc_after_ns - before_ns);
  timex kernel{};
  ASSERT_GE(adjtimex(&kernel), 0);
  if ((kernel.status & STA_UNSYNC) != 0)
    EXPECT_EQ(utc.max_error_us, protocol::kMaxUtcError_us);
  else
    EXPECT_LT(utc.error_us, protocol::kMaxUtcError_us);
}

TEST(UtcClock, ADateHasItsNanoseconds) {
  EXPECT_EQ(date_of(0), "1970-01-01T00:00:00.000000000Z");
  EXPECT_EQ(date_of(1'769'860'800'000'001'234), "2026-01-31T12:00:00.000001234Z");
}

TEST(UtcClock, EachTickOfALogHasTheNewestPairAndItsContacts) {
  const std::string path = testing::TempDir() + "tact-utc-" + std::to_string(getpid()) + ".tactlog";
  const auto tissue = std::move(*model::scene::make_tissue(tests::make_plate_scene()));
  const auto ring = std::make_unique<loop::TickRing>();
  const auto shapes = std::make_unique<loop::ShapeSlot>();
  const protocol::FieldTable fields = LoggedTick::fields(2);
  Sinks sinks{.tick_fields = fields};
  sinks.log.emplace(std::move(*protocol::RunWriter::create(
      path, protocol::start_of_run({}, {}, {protocol::schema_of<LoggedTick>(fields)}))));
  Telemetry telemetry(*ring,
                      FrameBuilder(tissue->law().contact_law(), *shapes, false, {.offset_ns = 5}),
                      {.frame_rate_Hz = 200.0}, std::move(sinks));
  loop::TickRecord record;
  std::array<model::contact::SphereContact, 2> contacts;
  contacts[1].state = model::ContactState::kHeld;
  contacts[1].depth_m = -0.25;
  contacts[1].surface_point_m = {1.0, 2.0, 3.0};
  record.contacts.assign(contacts);
  record.event = 7, record.event_word = 255, record.sync = true;
  ring->push(record);  // before the thread runs, so that it comes with the pair of the start
  ASSERT_FALSE(telemetry.start());
  // Each frame has the newest pair; the thread reads it again once a second.
  for (int i = 0; i < 30'000 && telemetry.newest_frame().utc.offset_ns <= 5; ++i) {
    record.tick = static_cast<std::uint64_t>(1 + i);
    ring->push(record);
    usleep(1000);
  }
  ring->push(record);
  EXPECT_EQ(tests::message_of(telemetry.stop()), "");
  auto log = protocol::TickLog::open(path);
  std::remove(path.c_str());
  ASSERT_TRUE(log);
  LoggedTick first, last;
  ASSERT_TRUE(log->next(first) && log->next(last));
  while (log->next(last)) continue;
  EXPECT_EQ(first.utc.offset_ns, 5) << "as it was at the start";
  EXPECT_GT(last.utc.offset_ns, 1'700'000'000'000'000'000) << "read again after a second";
  EXPECT_EQ(first.contact[1].state, model::ContactState::kHeld);
  EXPECT_EQ(first.contact[1].depth_m, -0.25f);
  EXPECT_EQ(first.contact[1].surface_point_m[2], 3.0f);
  EXPECT_EQ(first.contact[0].state, model::ContactState::kFree);
  EXPECT_EQ(first.event, 7);
  EXPECT_EQ(first.event_word, 255);
  EXPECT_TRUE(first.sync);
  EXPECT_EQ(telemetry.newest_frame().utc.offset_ns, last.utc.offset_ns);
}

}  // namespace tact::firmware::telemetry::utc_clock_test
