// SPDX-License-Identifier: Apache-2.0
#include "model/io/nesting.h"

#include <gtest/gtest.h>

#include "model/io/json.h"
#include "model/io/toml.h"

namespace tact::model::io::nesting_test {

constexpr std::size_t kMany = 400'000;

std::string times(std::string_view word, std::size_t count) {
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += word;
  return out;
}

template <typename T>
std::string refusal(const Result<T>& result) {
  return result ? std::string() : result.error().message;
}

TEST(Nesting, TooDeepNestingIsRefusedWithItsLine) {
  const std::string deep[] = {"a = " + times("[", kMany),
                              "a = " + times("{a=", kMany),
                              times("a.", kMany) + "a = 1",
                              "[" + times("a.", kMany) + "a]",
                              times("\"a\" . ", kMany) + "a = 1",
                              "[[" + times("'a'.", kMany) + "a]]",
                              "a = " + times("[", kMany) + times("]", kMany)};
  for (const std::string& text : deep)
    EXPECT_EQ(refusal(parse_toml("x = 1\n" + text, "s.toml")),
              "s.toml:2: nested deeper than 64 levels; write it flatter")
        << text.substr(0, 20);
  for (const std::string word : {"[", "{\"a\":", "[{\"a\":"})
    EXPECT_EQ(refusal(parse_json("\n\n" + times(word, kMany), "s.json")),
              "s.json:3: nested deeper than 64 levels");
  EXPECT_NE(refusal(parse_json(times("[", kMany) + times("]", kMany), "s.json")), "");
}

TEST(Nesting, AsDeepAsAllowedIsParsed) {
  EXPECT_EQ(refusal(parse_json(times("[", kDeepest) + times("]", kDeepest), "s")), "");
  EXPECT_EQ(refusal(parse_toml("a = " + times("[", kDeepest) + times("]", kDeepest), "s")), "");
  EXPECT_EQ(refusal(parse_toml(times("a.", kDeepest) + "a = 1", "s")), "");
}

TEST(Nesting, IsNotCountedInStringsCommentsOrNumbers) {
  const std::string brackets = times("[{", 100);
  EXPECT_EQ(too_deep_json("{\"a\": \"" + brackets + "\\\"" + brackets + "\"}"), std::nullopt);
  for (const std::string& text :
       {"# " + brackets, "a = \"" + brackets + "\\\"" + brackets + "\"", "a = '" + brackets + "\\'",
        "a = \"\"\"\n" + brackets + "\n\"" + brackets + "\"\"\"\"\"\nb = 1",
        "a = '''\n" + brackets + "''\n'''", "a = [" + times("1.5, ", 200) + "]",
        times("a.b = 1.5\n", 100)}) {
    EXPECT_EQ(too_deep_toml(text), std::nullopt) << text;
    if (text[0] != 'a' || text.find("a.b") != 0)
      EXPECT_EQ(refusal(parse_toml(text, "s")), "") << text;
  }
}

TEST(Nesting, BehindAStringIsCountedAgain) {
  for (const std::string& text : {std::string("a = \"\\\\\"\n"), std::string("a = '\\'\n"),
                                  std::string("a = \"\"\"x\"\"\"\n"), std::string("a = \"\"\n"),
                                  std::string("# it's\n"), std::string("a = ''''x'''''\n")})
    EXPECT_NE(refusal(parse_toml(text + "b = " + times("[", kMany), "s")).find("nested deeper"),
              std::string::npos)
        << text;
}

TEST(Json, ParseErrorIsReportedWithItsLine) {
  EXPECT_EQ(
      refusal(parse_json("{\n\"a\": }", "s.json")).find("s.json: not JSON: parse error at line 2"),
      0u);
  EXPECT_NE(refusal(read_json("/tmp", "name a file")), "");
}

TEST(Toml, ParseErrorIsReportedWithItsLine) {
  EXPECT_EQ(refusal(parse_toml("a = 1\nb = \n", "s.toml")).find("s.toml:2: not TOML: "), 0u);
}

TEST(Json, BytesThatAreNoTextAreReplacedAndNotThrownAt) {
  EXPECT_EQ(text_of(nlohmann::json{{"device", "Touch \xff"}}), "{\"device\":\"Touch \uFFFD\"}");
}

}  // namespace tact::model::io::nesting_test
