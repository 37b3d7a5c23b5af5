// SPDX-License-Identifier: Apache-2.0
#include "model/result.h"

#include <gtest/gtest.h>

#include <csignal>

namespace tact::model::result_test {

TEST(Result, HasAValueOrAMessage) {
  const Result<int> good = 7;
  ASSERT_TRUE(good);
  EXPECT_EQ(*good, 7);
  const Result<int> bad = Error{"scene.toml:3: no number"};
  ASSERT_FALSE(bad);
  EXPECT_EQ(bad.error().message, "scene.toml:3: no number");
}

TEST(Result, ReadingTheValueOfAnErrorAbortsWithItsMessage) {
  Result<std::string> bad = Error{"scene.toml:3: no number"};
  const auto ends = testing::KilledBySignal(SIGABRT);
  const char* message = "value\\(\\) of an error: scene.toml:3: no number";
  EXPECT_EXIT(static_cast<void>(bad.value()), ends, message);
  EXPECT_EXIT(static_cast<void>(std::as_const(bad)->size()), ends, message);
  const Result<int> good = 7;
  EXPECT_EXIT(static_cast<void>(good.error()), ends, "error\\(\\) of a value");
}

}  // namespace tact::model::result_test
