// SPDX-License-Identifier: Apache-2.0
// Is this PC good enough for the rate? What tact-jitter answers by default.
#include <gtest/gtest.h>

#include "tests/support/program.h"
#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter::answer_test {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A second at 1 kHz on a PC with one red row; the last wake-up takes 2 ms.
JitterResult stalled_once() {
  JitterResult result;
  result.rate_Hz = 1000.0;
  result.measured_s = 1.0;
  result.non_rt = true;
  result.sink = std::make_unique<TickSink>(SinkSettings{});
  for (std::uint64_t i = 0; i < 1000; ++i) {
    firmware::loop::TickRecord record;
    record.tick = i;
    record.due_ns = 1'000'000'000 + static_cast<std::int64_t>(i) * 1'000'000;
    record.phase_ns = {i == 999 ? 2'000'000 : 5'000, 100, 200, 300, 400, 500, 600, 2'100};
    result.sink->add(record);
  }
  firmware::pc::PcRow kernel;
  kernel.name = "kernel";
  kernel.verdict = firmware::pc::Verdict::kRed;
  result.pc.push_back(kernel);
  return result;
}

TEST(Answer, SaysWhetherThePcIsGoodEnoughAndWhy) {
  JitterResult result = stalled_once();
  EXPECT_EQ(
      answer_of(result).message,
      "this PC is not good enough for 1000 Hz, because in 1 s without load the latest wake-up was "
      "2000 us, above 500 us, half a period; it gives no hard real time, so tactd caps the force "
      "to "
      "a quarter; 1 red rows of tact-doctor say what to change");
  EXPECT_STREQ(answer_of(result).verdict, "fail");
  EXPECT_TRUE(has(make_summary(result), answer_of(result).message));
  result.rate_Hz = 200.0;  // 2 ms of 2.5
  EXPECT_FALSE(has(answer_of(result).message, "half a period"));
  EXPECT_TRUE(has(answer_of(result).message, "because in 1 s without load it gives no hard"));
  result.non_rt = false;
  EXPECT_TRUE(has(answer_of(result).message, "this PC is good enough for 200 Hz, because in 1 s"));
  EXPECT_TRUE(has(answer_of(result).message, "before a person holds a device: --duration 3600"));
  EXPECT_STREQ(answer_of(result).verdict, "pass");
  result.load = "cpu";
  result.measured_s = 3600.0;
  EXPECT_FALSE(has(answer_of(result).message, "before a person holds a device"));
}

TEST(Answer, IsGivenWithoutASceneAndWithoutAnyOption) {
  const auto run = tests::run_program("tact-jitter", "--duration 0.5");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_TRUE(has(run.output, "\nthis PC is ")) << run.output;
  EXPECT_TRUE(has(run.output, "good enough for 1000 Hz, because in 0.5 s without load "))
      << run.output;
}

}  // namespace tact::tools::jitter::answer_test
