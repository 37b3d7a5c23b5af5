// SPDX-License-Identifier: Apache-2.0
// The history of a PC: what goes in comes out, a torn record loses itself alone, 2 MB are a year.
#include "firmware/telemetry/year_history.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>

namespace tact::firmware::telemetry::year_history_test {

namespace fs = std::filesystem;

class YearHistoryTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "/tact_history_" + std::to_string(getpid());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path() const { return folder_ + "/a/year.tacthistory"; }

  YearHistory open() const {
    auto history = YearHistory::open(path());
    if (!history) throw std::runtime_error(history.error().message);
    return std::move(*history);
  }
  /// As the file holds it.
  std::optional<Interval> read(std::uint32_t interval) const {
    std::ifstream file(path(), std::ios::binary);
    file.seekg(static_cast<std::streamoff>(kHistoryHead_bytes +
                                           kHistoryRecord_bytes * (interval % kHistoryRecords)));
    HistoryRecord record{};
    file.read(reinterpret_cast<char*>(record.data()), record.size());
    return unpack(record, interval);
  }

  std::string folder_;
};

loop::TickRecord tick(std::int32_t wake_ns, std::int32_t write_ns, std::int32_t total_ns) {
  loop::TickRecord record;
  record.phase_ns[static_cast<std::size_t>(loop::Phase::kWake)] = wake_ns;
  record.phase_ns[static_cast<std::size_t>(loop::Phase::kWrite)] = write_ns;
  record.phase_ns[static_cast<std::size_t>(loop::Phase::kTotal)] = total_ns;
  return record;
}

constexpr std::int64_t kAny_s = 1'800'000'000;

TEST_F(YearHistoryTest, KeepsTheLargestAndTheCountsOfAnInterval) {
  YearHistory history = open();
  EXPECT_EQ(history.work(kAny_s), std::nullopt);
  history.add(tick(4'000, 1'000, 9'000));
  loop::TickRecord late = tick(70'123, 2'000, 3'000);
  late.late_ticks = 2;
  late.skipped_ticks = 3;
  late.output.limit = model::Fault::kForceLimited;
  late.output.fault = model::Fault::kLoopLate;
  history.add(late);
  history.add(late);  // the counters are of the run, and the fault is latched
  EXPECT_EQ(history.work(kAny_s + kHistoryInterval_s), std::nullopt);
  const auto kept = read(kAny_s / kHistoryInterval_s);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->wake_max_ns, 70'200) << "rounded up";
  EXPECT_EQ(kept->tick_max_ns, 9'000);
  EXPECT_EQ(kept->deadline_to_force_max_ns, 72'200);
  EXPECT_EQ(kept->late, 2u);
  EXPECT_EQ(kept->skipped, 3u);
  EXPECT_EQ(kept->limits, 1u << 5);
  EXPECT_EQ(kept->fault, 105);
}

TEST_F(YearHistoryTest, ARunInTheSameIntervalAddsToIt) {
  for (const std::int32_t wake_ns : {9'000, 5'000}) {
    YearHistory history = open();
    ASSERT_EQ(history.work(kAny_s), std::nullopt);
    loop::TickRecord record = tick(wake_ns, 0, 0);
    record.skipped_ticks = 2;
    history.add(record);
    ASSERT_EQ(history.finish(), std::nullopt);
  }
  const auto kept = read(kAny_s / kHistoryInterval_s);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->wake_max_ns, 9'000);
  EXPECT_EQ(kept->skipped, 4u);
}

TEST_F(YearHistoryTest, OfRandomRunsHoldsEachIntervalOfTheLastYearIn2MB) {
  std::mt19937 random(1);
  std::map<std::uint32_t, std::int32_t> wanted;  // by a plain list
  YearHistory history = open();
  std::int64_t utc_s = kAny_s;
  for (int i = 0; i < 600; ++i) {
    const auto interval = static_cast<std::uint32_t>(utc_s / kHistoryInterval_s);
    ASSERT_EQ(history.work(utc_s), std::nullopt);
    const auto wake_ns = static_cast<std::int32_t>(100 * (random() % 60'000));
    history.add(tick(wake_ns, 0, 0));
    wanted[interval] = std::max(wanted[interval], wake_ns);
    utc_s += random() % 150'000;  // 500 days in all
  }
  ASSERT_EQ(history.finish(), std::nullopt);
  const auto newest = wanted.rbegin()->first;
  for (const auto& [interval, wake_ns] : wanted) {
    const auto kept = read(interval);
    if (newest - interval >= kHistoryRecords) continue;  // may have been written over
    ASSERT_TRUE(kept) << interval;
    EXPECT_EQ(kept->wake_max_ns, wake_ns);
  }
  EXPECT_GT(newest - wanted.begin()->first, kHistoryRecords) << "no record was written over";
  EXPECT_LE(fs::file_size(path()), 2'000'000u);
}

TEST_F(YearHistoryTest, ATornRecordLosesItselfAlone) {
  {
    YearHistory history = open();
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(history.work(kAny_s + k * kHistoryInterval_s), std::nullopt);
      history.add(tick(5'000, 0, 0));
    }
    ASSERT_EQ(history.finish(), std::nullopt);
  }
  const std::uint32_t first = kAny_s / kHistoryInterval_s;
  for (std::size_t byte = 0; byte < kHistoryRecord_bytes; ++byte) {
    std::fstream file(path(), std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(
        kHistoryHead_bytes + kHistoryRecord_bytes * ((first + 1) % kHistoryRecords) + byte);
    file.seekg(at);
    const int before = file.get();
    file.seekp(at);
    file.put(static_cast<char>(before ^ 0x40));
    file.flush();
    EXPECT_FALSE(read(first + 1)) << byte;
    EXPECT_TRUE(read(first));
    EXPECT_TRUE(read(first + 2));
    file.seekp(at);
    file.put(static_cast<char>(before));
  }
}

TEST_F(YearHistoryTest, AnotherFileIsRefusedAndLeftAsItIs) {
  fs::create_directories(folder_ + "/a");
  std::ofstream(path()) << "a letter to a friend, longer than the head";
  const auto refused = YearHistory::open(path());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(path() + ": is no history of this version"),
            std::string::npos)
      << refused.error().message;
  EXPECT_EQ(fs::file_size(path()), 42u);
}

TEST_F(YearHistoryTest, ADiskThatTakesNoMoreIsReportedOnce) {
  YearHistory history = open();
  ASSERT_EQ(history.work(kAny_s), std::nullopt);
  history.add(tick(5'000, 0, 0));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{.rlim_cur = kHistoryHead_bytes, .rlim_max = before.rlim_max};
  const auto signal_before = signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto failed = history.work(kAny_s + kHistoryInterval_s);
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, signal_before);
  ASSERT_TRUE(failed);
  EXPECT_EQ(*failed, path() + ": File too large: the history of this PC ends here");
  history.add(tick(5'000, 0, 0));
  EXPECT_EQ(history.finish(), std::nullopt);
}

}  // namespace tact::firmware::telemetry::year_history_test
