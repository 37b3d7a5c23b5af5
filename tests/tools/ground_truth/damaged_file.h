// SPDX-License-Identifier: Apache-2.0
// damaged_file.h - the text of a reference as its reader takes it, whole or with one thing changed.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "model/result.h"

namespace tact::tests {

template <typename Data>
using ReferenceReader = model::Result<Data> (*)(const std::string& path);

template <typename Data>
model::Result<Data> read_text(ReferenceReader<Data> read, const std::string& text) {
  const auto* const test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string path = testing::TempDir() + test->test_suite_name() + test->name() + ".json";
  std::ofstream(path) << text;
  auto data = read(path);
  std::filesystem::remove(path);
  return data;
}

/// The error names `what` and the command that is the remedy.
template <typename Data>
void expect_error(ReferenceReader<Data> read, std::string text, const std::string& from,
                  const std::string& to, const std::string& what, const std::string& remedy) {
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from;
  const auto data = read_text(read, text.replace(at, from.size(), to));
  ASSERT_FALSE(data) << "with " << to;
  EXPECT_NE(data.error().message.find(what), std::string::npos) << data.error().message;
  EXPECT_NE(data.error().message.find(remedy), std::string::npos) << data.error().message;
}

}  // namespace tact::tests
