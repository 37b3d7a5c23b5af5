// SPDX-License-Identifier: Apache-2.0
#include "host/server/scene_wish.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/sentence.h"

namespace tact::host::server::scene_wish_test {

constexpr const char* kOffer = R"({"format":"tactd-parameters","version":1,"scene":"heart",
  "law":"disc_stack","simulated":true,"parameters":[
  {"key":"disc_stack.layers","unit":"","value":20,"low":1,"high":31,"whole":true,"meaning":"discs"},
  {"key":"disc_stack.poisson_ratio","unit":"","value":0.3,"low":0,"high":0.495,"whole":false,
   "meaning":"mu"}]})";

std::vector<OfferedScene> offers() { return {*parse_offer(kOffer, "heart.json")}; }

TEST(SceneWish, HasASceneAndNumbersByKey) {
  const auto wish =
      parse_scene_wish(R"({"wish":{"scene":"heart","set":{"disc_stack.layers":12}}})");
  ASSERT_TRUE(wish);
  EXPECT_EQ(wish->scene, "heart");
  EXPECT_EQ(wish->set.at("disc_stack.layers"), 12.0);
  EXPECT_TRUE(parse_scene_wish(R"({"wish":{"scene":"heart"}})")->set.empty());
}

TEST(SceneWish, OfAnotherFormIsNone) {
  for (const char* text :
       {"", "{", "[]", "null", R"({"hand":{}})", R"({"wish":7})", R"({"wish":[]})",
        R"({"wish":{"scene":7}})", R"({"wish":{"scene":"heart","set":[1]}})",
        R"({"wish":{"scene":"heart","set":{"disc_stack.layers":"12"}}})",
        R"({"wish":{"scene":"heart","set":{"disc_stack.layers":null}}})",
        R"({"wish":{"scene":"heart","arm":true}})"})
    EXPECT_FALSE(parse_scene_wish(text)) << text;
}

TEST(SceneWish, IsGoodWithinWhatIsOffered) {
  for (const double layers : {1.0, 12.0, 31.0})
    EXPECT_EQ(why_not({"heart", {{"disc_stack.layers", layers}}}, offers()), "");
  EXPECT_EQ(why_not({"heart", {}}, offers()), "");
}

TEST(SceneWish, OfAnUnknownSceneOrKeyIsRefusedByName) {
  EXPECT_EQ(why_not({"liver", {}}, offers()), "there is no scene \"liver\" here");
  EXPECT_EQ(why_not({"", {}}, offers()), "there is no scene \"\" here");
  EXPECT_EQ(why_not({"heart", {{"limits.force_N", 8.0}}}, offers()),
            "heart has no parameter limits.force_N");
  EXPECT_EQ(why_not({"heart", {{"device.kind", 1.0}}}, offers()),
            "heart has no parameter device.kind");
}

TEST(SceneWish, OutOfItsRangeIsRefusedWithTheRange) {
  EXPECT_EQ(why_not({"heart", {{"disc_stack.layers", 32.0}}}, offers()),
            "disc_stack.layers = 32 is out of range; allowed: 1 .. 31");
  EXPECT_EQ(why_not({"heart", {{"disc_stack.poisson_ratio", -0.001}}}, offers()),
            "disc_stack.poisson_ratio = -0.001 is out of range; allowed: 0 .. 0.495");
  for (const double none :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_NE(why_not({"heart", {{"disc_stack.poisson_ratio", none}}}, offers()), "");
  EXPECT_EQ(why_not({"heart", {{"disc_stack.layers", 2.5}}}, offers()),
            "disc_stack.layers = 2.5 must be whole");
}

TEST(SceneWish, BecomesWordsThatAShellReads) {
  EXPECT_EQ(line_of({"heart", {{"disc_stack.layers", 12.0}, {"disc_stack.poisson_ratio", 1e-5}}}),
            "wish heart disc_stack.layers=12 disc_stack.poisson_ratio=1e-05");
}

TEST(SceneOffer, OfADeviceThatIsNotSimulatedIsNone) {
  std::string hardware = kOffer;
  hardware.replace(hardware.find("true"), 4, "false");
  EXPECT_NE(tests::sentence_of(parse_offer(hardware, "heart.json")).find("not simulated"),
            std::string::npos);
}

TEST(SceneOffer, ThatIsNotTactdsOrNamesNoPlainWordIsNone) {
  const std::string good = kOffer;
  for (const auto& [what, instead] : {std::pair{"\"heart\"", "\"../heart\""},
                                      {"\"heart\"", "\"heart -c\""},
                                      {"\"heart\"", "7"},
                                      {"tactd-parameters", "tactd-faults"},
                                      {"\"version\":1", "\"version\":2"},
                                      {"disc_stack.layers", "--arm"},
                                      {"\"low\":1", "\"low\":\"1\""},
                                      {"\"simulated\":true,", ""},
                                      {"\"low\":1,", ""},
                                      {"}]}", ""}}) {
    std::string bad = good;
    bad.replace(bad.find(what), std::string_view(what).size(), instead);
    EXPECT_FALSE(parse_offer(bad, "heart.json")) << what << " " << instead;
  }
}

TEST(SceneOffer, OfAFolderWithoutScenesIsToldWithTheCure) {
  const std::string sentence = tests::sentence_of(load_offers("/nowhere"));
  EXPECT_NE(sentence.find("--parameters --json"), std::string::npos) << sentence;
}

}  // namespace tact::host::server::scene_wish_test
