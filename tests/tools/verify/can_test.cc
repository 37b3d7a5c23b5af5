// SPDX-License-Identifier: Apache-2.0
// The published CAN frames, without the program around them.
#include "tools/verify/can.h"

#include <gtest/gtest.h>

#include <exception>
#include <fstream>
#include <map>
#include <set>

#include "tools/verify/report.h"

namespace tact::tools::verify::can_test {

using nlohmann::json;

/// Passed cases; 0 if any failed or the file was called damaged.
int passed(const json& file) {
  for (const Verifier& verifier : can_verifiers()) {
    if (file.at("schema") != verifier.law) continue;
    try {
      Report report;
      verifier.verify(file, report);
      return report.failed() == 0 && report.damage().empty() ? report.passed() : 0;
    } catch (const std::exception&) {
      return 0;
    }
  }
  return 0;
}

/// A value that is still of its kind, so that it is the comparison that has to find it.
json spoiled(const json& value) {
  if (value.is_boolean()) return !value.get<bool>();
  if (value.is_number_integer()) return value.get<long>() ^ 1;
  if (value.is_number()) return value.get<double>() + 0.1;
  if (value.is_array()) return json::array({"spoiled"});
  if (value.is_null()) return 1;
  std::string word = value;
  if (!word.empty()) word.back() = word.back() == '1' ? '2' : '1';
  return word.empty() ? "11" : word;
}

using Inputs = std::set<std::string>;

/// Every field of every case of a file, spoiled alone, must be seen, but for inputs by section.
void check_file(const std::string& name, int cases, const std::map<std::string, Inputs>& sections) {
  json file = json::parse(std::ifstream(TACT_SOURCE_DIR "/tests/data/vectors/" + name));
  ASSERT_EQ(passed(file), cases) << name;
  const json whole = file;
  for (const auto& [section, ignored] : sections) file[section] = json::array();
  const int rest = passed(file);  // of sections that only pass as a whole
  for (const auto& [section, inputs] : sections) {
    for (const json& one : whole.at(section)) {
      file[section] = json::array({one});
      if (rest > 0 && passed(file) == rest) continue;  // never used here; `cases` leaves it out
      ASSERT_EQ(passed(file), rest + 1) << name << " " << section << " " << one;
      const json flat = one.flatten();
      for (const auto& [where, value] : flat.items()) {
        if (where == "/args") continue;  // none
        if (inputs.contains(where.substr(1, where.find('/', 1) - 1))) continue;
        file[section][0][json::json_pointer(where)] = spoiled(value);
        EXPECT_EQ(passed(file), 0) << name << " " << section << " " << one << " " << where;
        file[section][0] = one;
      }
    }
    file[section] = json::array();
  }
}

TEST(VerifyCan, EveryPublishedFrameOfTheKernelPassesAndEveryFieldIsLookedAt) {
  // An error frame is what goes in; of its bytes not all have a meaning.
  check_file("can_socketcan.json", 85,
             {{"error_frames", {"can_frame"}}, {"bus_bits", {"id", "data", "bits"}}});
}

TEST(VerifyCan, EveryPublishedFrameOfOdrivePassesAndEveryFieldIsLookedAt) {
  check_file("can_odrive.json", 89,
             {{"encode", {}}, {"decode", {"data"}}, {"heartbeat_v0_5", {"data"}}});
}

TEST(VerifyCan, EveryCommandNumberOfOdriveIsLookedAtAndNoneMayBeMissing) {
  json file = json::parse(std::ifstream(TACT_SOURCE_DIR "/tests/data/vectors/can_odrive.json"));
  const json whole = file.at("commands");
  for (const auto& [name, value] : whole.items()) {
    file["commands"][name] = spoiled(value);
    EXPECT_EQ(passed(file), 0) << name;
    file["commands"].erase(name);
    EXPECT_EQ(passed(file), 0) << name;
    file["commands"] = whole;
  }
  file["commands"]["unheard_of"] = 5;
  EXPECT_EQ(passed(file), 0);
}

TEST(VerifyCan, EveryPublishedFrameOfCia402PassesAndEveryFieldIsLookedAt) {
  check_file("can_cia402.json", 352,
             {{"encode", {}},
              {"decode", {"data"}},
              {"states", {"statusword"}},
              {"torque_conversion", {"rated_mNm"}}});
}

TEST(VerifyCan, EveryPublishedFrameOfMoteusPassesAndEveryFieldIsLookedAt) {
  check_file("can_moteus.json", 25, {{"encode", {}}, {"decode", {"data"}}});
}

TEST(VerifyCan, ACaseOfMoteusThatCannotBeReadIsNamedAndTheOthersAreJudged) {
  json file = json::parse(std::ifstream(TACT_SOURCE_DIR "/tests/data/vectors/can_moteus.json"));
  file["encode"][2]["message"] = "dance";
  file["encode"][4]["args"].erase("torque");
  file["decode"][1]["data"] = "2g";
  file["decode"][3].erase("expect");
  file["decode"][5]["data"] = std::string(130, '5');
  Report report;
  for (const Verifier& verifier : can_verifiers())
    if (file.at("schema") == verifier.law) verifier.verify(file, report);
  EXPECT_EQ(report.damage(), "");
  EXPECT_EQ(report.passed(), 20);
  std::set<std::string> named;
  for (const Failure& one : report.failures()) {
    named.insert(one.id);
    EXPECT_EQ(one.field, "reads") << one.id;
  }
  EXPECT_EQ(named,
            (std::set<std::string>{"encode/2", "encode/4", "decode/1", "decode/3", "decode/5"}));
}

TEST(VerifyCan, EveryStepOfTheConfigurationIsLookedAtAndNoneMayBeMissing) {
  json file = json::parse(std::ifstream(TACT_SOURCE_DIR "/tests/data/vectors/can_cia402.json"));
  json& sequence = file["config_sequence_node5"];
  const json whole = sequence;
  const json flat = whole.flatten();
  for (const auto& [where, value] : flat.items()) {
    sequence[json::json_pointer(where)] = spoiled(value);
    EXPECT_EQ(passed(file), 0) << where;
    sequence = whole;
  }
  sequence.erase(sequence.size() - 1);
  EXPECT_EQ(passed(file), 0);
  sequence = whole;
  sequence.push_back(whole.back());
  EXPECT_EQ(passed(file), 0);
}

TEST(VerifyCan, InvalidHexIdentifierOrLengthIsDamage) {
  const auto damage_of = [](const auto& read) {
    Report report;
    read(report);
    return report.damage();
  };
  for (const char* digits : {"0", "0g"})
    EXPECT_NE(damage_of([&](Report& report) { from_hex(digits, report); }), "") << digits;
  EXPECT_NE(damage_of([](Report& report) { frame_of(0x800, "", report); }), "");
  EXPECT_NE(damage_of([](Report& report) { frame_of(1, "001122334455667788", report); }), "");
  Report report;
  EXPECT_EQ(to_hex(from_hex("00ff7a", report)), "00ff7a");
  EXPECT_EQ(report.damage(), "");
}

}  // namespace tact::tools::verify::can_test
