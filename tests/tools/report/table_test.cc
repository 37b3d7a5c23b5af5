// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/support/files.h"

namespace tact::tools::report::table_test {

namespace fs = std::filesystem;
using tests::content;
constexpr std::size_t kJobs = 11;

const std::vector<Column> kColumns{{"depth_m"}, {"force_N"}, {"status", CellKind::kWord}};

Row row_of(std::size_t job) {
  const auto x = static_cast<double>(job);
  return {x / 3.0, job == 4 ? std::nan("") : std::exp(10.0 - 3.0 * x),
          std::string(job % 2 == 0 ? "ok" : "no contact")};
}

Table table_of(const program::Shard& shard) {
  Table table("forces", kColumns, kJobs, shard);
  for (std::size_t k = 0; k < shard.jobs_of(kJobs); ++k) table.add(row_of(shard.job(k)));
  return table;
}

class TableFiles : public testing::Test {
 protected:
  TableFiles() : folder_(testing::TempDir() + "tact-table-" + std::to_string(getpid())) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~TableFiles() override { fs::remove_all(folder_); }
  std::vector<std::string> write_shards(std::size_t count) {
    std::vector<std::string> files;
    for (std::size_t i = 0; i < count; ++i) {
      const auto written = table_of({.index = i, .count = count}).write(folder_);
      EXPECT_TRUE(written);
      files.push_back(written->front());
    }
    return files;
  }
  std::string complaint(const std::vector<std::string>& files) {
    const auto merged = merge_table(Table("forces", kColumns, kJobs), files);
    EXPECT_FALSE(merged);
    return merged ? "" : merged.error().sentence;
  }
  std::string folder_;
};

TEST(Table, WritesOneRowPerJobWithSixDigits) {
  Table table("t", {{"a_m"}, {"word", CellKind::kWord}}, 3);
  table.add({1.0 / 3.0, std::string("x")});
  table.add({-0.0, std::string("y z")});
  table.add({std::numeric_limits<double>::infinity(), std::string("")});
  EXPECT_EQ(table.to_csv(), "job,a_m,word\n0,0.333333,x\n1,0,y z\n2,inf,\n");
  const auto json = nlohmann::json::parse(table.to_json());
  EXPECT_EQ(json.at("rows").at(0).at("a_m"), 0.333333) << "JSON says what the CSV says";
  EXPECT_EQ(json.at("rows").at(1).at("word"), "y z");
  EXPECT_EQ(table.number(table.rows()[0], "a_m"), 1.0 / 3.0);
  EXPECT_EQ(table.word(table.rows()[1], "word"), "y z");
}

TEST_F(TableFiles, MergedShardsAreTheWholeTableByteForByte) {
  const Table whole = table_of({});
  for (const std::size_t count : {2u, 3u, 11u, 12u}) {
    std::vector<std::string> files = write_shards(count);
    std::reverse(files.begin(), files.end());  // any order
    const auto merged = merge_table(Table("forces", kColumns, kJobs), files);
    ASSERT_TRUE(merged) << merged.error().sentence;
    EXPECT_EQ(merged->to_csv(), whole.to_csv());
    EXPECT_EQ(merged->to_json(), whole.to_json());
  }
}

TEST_F(TableFiles, AShardSaysWhatItIs) {
  const auto files = write_shards(3);
  EXPECT_TRUE(files[1].ends_with("forces.shard-1-of-3.csv"));
  EXPECT_TRUE(content(files[1]).starts_with("# shard 1/3 of forces, 11 jobs\njob,depth_m"));
  EXPECT_EQ(*table_of_file(files[1]), "forces");
}

TEST_F(TableFiles, AMissingShardIsNamed) {
  auto files = write_shards(3);
  files.erase(files.begin() + 1);
  EXPECT_NE(complaint(files).find("job 1 is missing; run shard 1/3 again"), std::string::npos)
      << complaint(files);
}

TEST_F(TableFiles, ADoubledShardIsNamed) {
  auto files = write_shards(3);
  files.push_back(files[2]);
  EXPECT_NE(complaint(files).find("give shard 2/3 once"), std::string::npos) << complaint(files);
}

TEST_F(TableFiles, ATornRowIsNamed) {
  const auto files = write_shards(2);
  const std::string text = content(files[0]);
  for (const std::size_t lost : {1u, 2u, 8u, 12u}) {
    std::ofstream(files[0]) << text.substr(0, text.size() - lost);
    EXPECT_NE(complaint(files).find("damaged row; run shard 0/2 again"), std::string::npos)
        << lost << " " << complaint(files);
  }
  std::string spoiled = text;
  spoiled.replace(spoiled.find("0.666667"), 8, "0.66x667");
  std::ofstream(files[0]) << spoiled;
  EXPECT_NE(complaint(files).find(":4: damaged row; run shard 0/2 again"), std::string::npos)
      << complaint(files);
}

TEST_F(TableFiles, OtherGridsShardsAndFilesAreRefused) {
  const auto files = write_shards(2), thirds = write_shards(3);
  EXPECT_NE(complaint({files[0], thirds[1]}).find("one of 3 shards among files of 2"),
            std::string::npos);
  const auto other = merge_table(Table("forces", kColumns, 12), files);
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().sentence.find("11 jobs of forces, but 12 jobs"), std::string::npos);
  const auto columns = merge_table(Table("forces", {{"depth_m"}}, kJobs), files);
  ASSERT_FALSE(columns);
  EXPECT_NE(columns.error().sentence.find(":2: other columns"), std::string::npos);
  const auto whole = table_of({}).write(folder_);
  EXPECT_NE(complaint({whole->front()}).find("is not the CSV of a shard"), std::string::npos);
  EXPECT_NE(complaint({folder_ + "/none.csv"}).find("no such file"), std::string::npos);
}

}  // namespace tact::tools::report::table_test
