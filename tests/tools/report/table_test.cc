// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace tact::tools::report::table_test {

TEST(Table, WritesOneRowPerJobWithSixDigits) {
  Table table("t", {{"a_m"}, {"word", CellKind::kWord}});
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

}  // namespace tact::tools::report::table_test
