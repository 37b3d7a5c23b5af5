// SPDX-License-Identifier: Apache-2.0
// The row that a person sends for the table of PCs.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tools/jitter/report/jitter_report.h"

namespace tact::tools::jitter::submission_test {

using tests::content;

TEST(SubmissionRow, HasACellForEachColumnAndNoNameOfThePC) {
  const std::string path = testing::TempDir() + "tact-row-" + std::to_string(getpid());
  const auto run =
      tests::run_program("tact-jitter", "--bare --duration 0.5 --no-pictures --submit " + path);
  EXPECT_EQ(run.status, 0) << run.output;
  const std::string row = content(path);
  std::filesystem::remove(path);
  const std::string head(kSubmissionHead);
  EXPECT_EQ(std::ranges::count(row, '|'), std::ranges::count(head.substr(0, head.find('\n')), '|'));
  EXPECT_EQ(std::ranges::count(row, '\n'), 1) << row;
  EXPECT_NE(row.find("bare loop, 1000 Hz, core "), std::string::npos) << row;
  std::array<char, 256> name{};
  ASSERT_EQ(gethostname(name.data(), name.size() - 1), 0);
  const std::string_view host(name.data());
  // A short name may be a word of the row by chance.
  if (host.size() > 8) EXPECT_EQ(row.find(host), std::string::npos) << row;
}

TEST(SubmissionRow, IsOfTheTableThatIsPublished) {
  EXPECT_NE(content(TACT_SOURCE_DIR "/tools/deploy/PCS.md").find(kSubmissionHead),
            std::string::npos);
}

TEST(SubmissionRow, ReplacesTheRowOfAnEarlierMeasurement) {
  const std::string path = testing::TempDir() + "tact-row-twice-" + std::to_string(getpid());
  const std::string once = "--bare --duration 0.2 --no-pictures --submit " + path;
  for (int run = 0; run < 2; ++run) {
    const auto outcome = tests::run_program("tact-jitter", once);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
  }
  EXPECT_EQ(std::ranges::count(content(path), '\n'), 1);
  std::filesystem::remove(path);
}

TEST(SubmissionRow, ReplacesNoFileOfAnotherKind) {
  const std::string path = testing::TempDir() + "tact-row-" + std::to_string(getpid()) + ".md";
  std::ofstream(path) << "# notes\n";
  const auto run = tests::run_program("tact-jitter", "--bare --duration 0.5 --submit " + path);
  EXPECT_EQ(run.status, 2) << run.output;
  EXPECT_EQ(content(path), "# notes\n");
  std::filesystem::remove(path);
}

}  // namespace tact::tools::jitter::submission_test
