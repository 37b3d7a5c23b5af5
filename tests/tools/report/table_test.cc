// SPDX-License-Identifier: Apache-2.0
#include "tools/report/table.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace tact::tools::report::table_test {

TEST(Table, WritesOneRowPerJobWithSixDigits) {
  Table table("t");
  table.add({{"a_m", 1.0 / 3.0}, {"word", "x"}});
  table.add({{"a_m", -0.0}, {"word", "y z"}});
  table.add({{"a_m", std::numeric_limits<double>::infinity()}, {"word", ""}});
  EXPECT_EQ(table.to_csv(), "job,a_m,word\n0,0.333333,x\n1,0,y z\n2,inf,\n");
  const auto json = nlohmann::json::parse(table.to_json());
  EXPECT_EQ(json.at("rows").at(0).at("a_m"), 0.333333) << "JSON says what the CSV says";
  EXPECT_EQ(json.at("rows").at(1).at("word"), "y z");
}

}  // namespace tact::tools::report::table_test
