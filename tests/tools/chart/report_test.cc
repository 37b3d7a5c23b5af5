// SPDX-License-Identifier: Apache-2.0
// The chart as files: read back as written, and with the peers that were measured before.
#include "tools/chart/report/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace tact::tools::chart::report_test {

TEST(ChartReport, ShowsThePeersThatWereMeasuredBefore) {
  const std::string file = TACT_SOURCE_DIR "/tools/results/peers.json";
  const auto peers = read_chart(file);
  ASSERT_TRUE(peers) << peers.error().message;
  const std::string truth = word(peers->rows()[0], "reference_hash");
  report::Table laws("chart");
  ChartRow law;
  law.timing.median_us = 2.0;
  law.errors.force_rms_ratio = 0.003;
  laws.add(table_row(law, {"scene", truth, "r1", "here"}));
  EXPECT_EQ(source_of_peers(laws), "");
  const auto both = with_peers(laws, file, truth);
  ASSERT_TRUE(both) << both.error().message;
  EXPECT_EQ(both->rows().size(), 1 + peers->rows().size());
  EXPECT_EQ(front_rows(*both), std::vector<std::size_t>{0});
  EXPECT_TRUE(peers_ahead(*both).empty()) << "the numbers of the README";
  for (const char* said : {"peers: measured before, by revision ", " of 2026-", "AMD EPYC"})
    EXPECT_NE(chart_text(*both).find(said), std::string::npos) << said;
  for (const char* family : {"fem", "spring_mesh", "bullet_surface", "bullet_volume"})
    EXPECT_NE(both->to_csv().find(std::string(",peer,") + family), std::string::npos) << family;
  const auto wrong = with_peers(laws, file, "another truth");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message.find(file + ": the row fem 12 mm "), 0U) << wrong.error().message;
}

TEST(ChartReport, IsReadBackAsItWasWritten) {
  const std::string folder = testing::TempDir() + "chart_json_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  const Provenance provenance{"scene", "truth", "r1", "here, now"};
  report::Table table("chart");
  ChartRow row;
  row.variant.sizes = {.law = "disc_stack", .size = 7, .disc_form = "linear"};
  row.errors.force_rms_ratio = 0.125;
  table.add(table_row(row, provenance));
  ASSERT_TRUE(write_chart(table, "tact-lab chart x", provenance, folder));
  const auto read = read_chart(folder + "/chart.json");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->to_csv(), table.to_csv());
  std::ifstream csv(folder + "/chart.csv");
  std::string head;
  std::getline(csv, head);
  EXPECT_EQ(head, "# command: tact-lab chart x");
  std::ofstream(folder + "/bad.json") << R"({"format": "tact-chart", "version": 4, "rows": [{}]})";
  EXPECT_FALSE(read_chart(folder + "/bad.json"));
  EXPECT_FALSE(read_chart(folder + "/none.json"));
}

}  // namespace tact::tools::chart::report_test
