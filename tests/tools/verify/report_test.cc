// SPDX-License-Identifier: Apache-2.0
// Runs tact-verify on the published vectors and on spoiled copies; the comparison rule by itself is
// compiled in, because it belongs to a program and to no library.
#include "tools/verify/report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/extent.h"
#include "tests/support/program.h"

namespace tact::tools::verify::report_test {

using nlohmann::json;
const std::string kVectors = TACT_SOURCE_DIR "/tests/data/vectors/";

using tests::Outcome;

Outcome run(const std::string& arguments) { return tests::run_program("tact-verify", arguments); }
json load(const std::string& name) { return json::parse(std::ifstream(kVectors + name)); }
std::string save(const std::string& name, const std::string& text) {
  const std::string path = testing::TempDir() + std::to_string(getpid()) + "-" + name;
  std::ofstream(path) << text;
  return path;
}

TEST(Verify, EveryPublishedCasePassesAndNoneIsMissing) {
  const std::map<std::string, int> published{{"000_rhombus_chain.json", 48},
                                             {"000_rhombus_paper.json", 41},
                                             {"000_rhombus_unit.json", 56},
                                             {"001_disc_constants.json", 19},
                                             {"001_disc_patent_printed.json", 1},
                                             {"001_disc_series.json", 200},
                                             {"001_disc_stack.json", 66},
                                             {"002_hex_energy.json", 30},
                                             {"002_hex_paper.json", 52},
                                             {"002_membrane.json", 16},
                                             {"003_ccd.json", 29},
                                             {"003_epnp.json", 25},
                                             {"003_leg_ik.json", 13},
                                             {"003_transform.json", 19},
                                             {"004_claims.json", 3},
                                             {"004_network.json", 11},
                                             {"004_oscillator.json", 39},
                                             {"004_stability.json", 42},
                                             {"can_cia402.json", 352},
                                             {"can_moteus.json", 25},
                                             {"can_odrive.json", 89},
                                             {"can_socketcan.json", 85},
                                             {"falcon_packets.json", 95},
                                             {"half_space_spheres.json", 20},
                                             {"kinematics_delta.json", 120},
                                             {"kinematics_falcon.json", 54},
                                             {"kinematics_trajectory.json", 250},
                                             {"kinematics_workspace.json", 121}};
  const Outcome out = run(kVectors + " --json");
  EXPECT_EQ(out.status, 0) << out.output;
  const json report = json::parse(out.output);
  EXPECT_EQ(report.at("passed"), 1921);
  EXPECT_EQ(report.at("failed"), 0);
  std::map<std::string, int> passed;
  for (const json& file : report.at("files"))
    passed[file.at("file").get<std::string>()] = file.at("passed").get<int>();
  EXPECT_EQ(passed, published);
}

TEST(Verify, NamesTheCaseTheFieldAndBothValuesOfAFailure) {
  json file = load("kinematics_delta.json");
  json& theta = file["devices"]["desktop_small"]["cases"][3]["theta"][1];
  theta = theta.get<double>() + 2e-9;
  const std::string path = save("wrong.json", file.dump());
  const Outcome out = run(path);
  EXPECT_EQ(out.status, 1) << out.output;
  EXPECT_NE(out.output.find("119 passed, 1 failed"), std::string::npos);
  EXPECT_NE(out.output.find("desktop_small/cases/3 theta[1]: got "), std::string::npos);

  const json report = json::parse(run(path + " --json").output);
  EXPECT_EQ(report.at("failed"), 1);
  EXPECT_EQ(report.at("files").at(0).at("law"), "kinematics_delta/1");
  EXPECT_EQ(report.at("files").at(0).at("failures").at(0).at("field"), "theta[1]");
  EXPECT_EQ(report.at("files").at(0).at("failures").at(0).at("tolerance"), 1e-9);
  std::filesystem::remove(path);
}

TEST(Verify, EveryFieldOfEveryKinematicsFileIsLookedAt) {
  // Each number spoiled by a part in a thousand must fail: no field is skipped. By default a tenth.
  std::uint64_t asked = 0;
  const auto fails = [&](const std::string& name, const json::json_pointer& where) {
    if (asked++ % (10 / tests::share_of(10, 10)) != 0) return true;
    json file = load(name);
    json& value = file.at(where);
    value =
        value.is_boolean() ? json(!value.get<bool>()) : json(value.get<double>() * 1.001 + 1e-3);
    const std::string path = save("spoiled.json", file.dump());
    const Outcome out = run(path);
    std::filesystem::remove(path);
    return out.status == 1;
  };
  for (const char* field : {"reachable", "theta/0", "fk_far/0", "K/0/1", "J/2/2", "tau/1",
                            "tau_gravity/0", "task_inertia/1/1"}) {
    const std::string at = "/devices/example_360x300/cases/2/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_delta.json", json::json_pointer(at))) << field;
  }
  for (const char* field : {"solvable", "fk_far/2"}) {
    const std::string at = "/devices/inverted_R/from_joints/1/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_delta.json", json::json_pointer(at))) << field;
  }
  for (const char* field : {"theta1/0", "theta2/1", "theta3/2", "K/0/0", "J/1/1", "tau/2",
                            "counts_rounded/0", "p_from_counts/2"}) {
    const std::string at = "/cases/7/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_falcon.json", json::json_pointer(at))) << field;
  }
  EXPECT_TRUE(fails("kinematics_falcon.json", json::json_pointer("/symmetric/3/p/2")));
  EXPECT_TRUE(fails("kinematics_falcon.json", json::json_pointer("/symmetric/3/theta_deg")));
  for (const char* field : {"a", "b", "c", "d", "e", "f", "r", "s", "phi/0", "phi/1", "phi/2",
                            "encoder_slots", "counts_per_motor_rev", "shaft_diameter",
                            "drum_diameter", "theta_at_zero_counts_deg", "rad_per_count"}) {
    const std::string at = "/constants/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_falcon.json", json::json_pointer(at))) << field;
  }
  for (const char* field : {"counts/1", "p_from_counts/0"}) {
    const std::string at = "/rows/9/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_trajectory.json", json::json_pointer(at))) << field;
  }
  for (const char* field : {"reachable", "theta/0", "sigma/0"}) {
    const std::string at = "/cases/0/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_workspace.json", json::json_pointer(at))) << field;
  }
  for (const char* field : {"sigma_max", "cond_max", "column_norm_max", "theta_min", "theta_max"}) {
    const std::string at = "/cylinder/" + std::string(field);
    EXPECT_TRUE(fails("kinematics_workspace.json", json::json_pointer(at))) << field;
  }
}

TEST(Verify, AFileItCannotCheckIsAnErrorThatSaysSo) {
  EXPECT_EQ(run("/nonexistent/file.json").status, 2);
  const Outcome option = run("--no-such-option");
  EXPECT_EQ(option.status, 2);
  EXPECT_EQ(option.output,
            "tact-verify: The following argument was not expected: --no-such-option; see "
            "tact-verify --help\n");
  EXPECT_EQ(run("--help").status, 0);

  const std::string unknown = save("unknown.json", R"({"law": "phlogiston", "cases": []})");
  const Outcome law = run(unknown);
  EXPECT_EQ(law.status, 2);
  EXPECT_NE(law.output.find("does not know the law \"phlogiston\""), std::string::npos);
  EXPECT_NE(law.output.find(unknown), std::string::npos);

  const std::string cut = save("cut.json", R"({"schema": "kinematics_delta/1", )");
  EXPECT_EQ(run(cut).status, 2);
  const std::string empty = save("empty.json", R"({"schema": "kinematics_delta/1"})");
  EXPECT_EQ(run(empty).status, 2);
  // A known law whose cases are gone, or are called otherwise, would pass all of nothing.
  const std::string none = save("none.json", R"({"law": "disc_stack", "cases": []})");
  const Outcome nothing = run(none);
  EXPECT_EQ(nothing.status, 2);
  EXPECT_EQ(nothing.output,
            "tact-verify: " + none + ": holds no case, so it proves nothing; take a fresh copy\n");
  for (const std::string& path : {unknown, cut, empty, none}) std::filesystem::remove(path);
}

TEST(Verify, AWordItDoesNotKnowIsDamage) {
  json file = load("004_oscillator.json");
  file["cases"][0]["inputs"]["method"] = "LEAPFROG";
  const std::string path = save("word.json", file.dump());
  const Outcome method = run(path);
  EXPECT_EQ(method.status, 2) << method.output;
  EXPECT_NE(method.output.find("LEAPFROG"), std::string::npos) << method.output;
  file = load("004_oscillator.json");
  file["cases"][0]["params"]["k"] = "stiff";
  std::ofstream(path) << file.dump();
  EXPECT_EQ(run(path).status, 2);
  file = load("004_claims.json");  // a step that is no number
  json& errors = file["cases"][0]["expect"]["errors"];
  errors = json{{"h=wide", errors.begin().value()}};
  std::ofstream(path) << file.dump();
  EXPECT_EQ(run(path).status, 2);
  std::filesystem::remove(path);
}

/// The rule on one field.
bool passes(const json& got, const json& want, const Tolerance& tolerance) {
  Report report;
  report.begin_case("only");
  report.compare_all({{"f", got}, {"extra", 1}}, {{"f", want}}, tolerance);
  EXPECT_EQ(report.passed() + report.failed(), 1);
  return report.failed() == 0;
}

TEST(VerifyReport, NumbersPassWithinTheLargerOfBothTolerances) {
  const Tolerance t{.rel = 1e-3, .abs = {{"force", 0.5}}, .kind_of = {{"f", "force"}}};
  EXPECT_TRUE(passes(10.4, 10.0, t));
  EXPECT_FALSE(passes(10.6, 10.0, t));
  EXPECT_TRUE(passes(1000.9, 1000.0, t));
  EXPECT_FALSE(passes(1001.1, 1000.0, t));
  const Tolerance no_abs{.rel = 1e-3, .abs = {}, .kind_of = {{"f", "any"}}};
  EXPECT_FALSE(passes(1e-9, 0.0, no_abs));  // a kind missing from abs means 0
}

TEST(VerifyReport, NanAndInfinityAreValues) {
  const Tolerance t{.rel = 1e-3, .abs = {{"force", 0.5}}, .kind_of = {{"f", "force"}}};
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(passes(nan, "NaN", t));
  EXPECT_TRUE(passes("NaN", "NaN", t));
  EXPECT_FALSE(passes(nan, 1.0, t));
  EXPECT_FALSE(passes(1.0, "NaN", t));
  EXPECT_TRUE(passes(-inf, "-Infinity", t));
  EXPECT_FALSE(passes(inf, "-Infinity", t));
  EXPECT_FALSE(passes(1e308, "Infinity", t));
  EXPECT_FALSE(passes(inf, 1.0, t));
}

TEST(VerifyReport, WordsIntegersAndBooleansMustBeEqual) {
  const Tolerance none{.rel = 0.5, .abs = {}, .kind_of = {}};
  EXPECT_TRUE(passes("FLAT", "FLAT", none));
  EXPECT_FALSE(passes("FLAT", "TIP", none));
  EXPECT_TRUE(passes(6, 6, none));
  EXPECT_FALSE(passes(6, 7, none));
  EXPECT_TRUE(passes(true, true, none));
  EXPECT_FALSE(passes(false, true, none));
  EXPECT_FALSE(passes(1, "OK", none));
}

TEST(VerifyReport, ListsNeedTheSameLengthAndEveryElement) {
  const Tolerance t{.rel = 1e-9, .abs = {}, .kind_of = {{"f", "length"}}};
  EXPECT_TRUE(passes({1.0, 2.0}, {1.0, 2.0}, t));
  EXPECT_FALSE(passes({1.0}, {1.0, 2.0}, t));
  EXPECT_FALSE(passes({1.0, 2.1}, {1.0, 2.0}, t));
  EXPECT_FALSE(passes("missing", {1.0, 2.0}, t));
}

TEST(VerifyReport, ACaseMayBringItsOwnTolerance) {
  const json file = {{"tolerance", {{"rel", 1e-9}, {"abs", {{"force", 1e-12}}}}},
                     {"field_kinds", {{"f", "force"}}}};
  const Tolerance t = Tolerance::of_file(file);
  EXPECT_EQ(t.rel, 1e-9);
  const Tolerance own = t.for_case({{"tolerance", {{"rel", 0.1}, {"abs", {{"force", 1e-3}}}}}});
  EXPECT_EQ(own.rel, 0.1);
  EXPECT_EQ(own.abs.at("force"), 1e-3);
  EXPECT_EQ(own.kind_of.at("f"), "force");
  EXPECT_EQ(t.for_case({{"id", "x"}}).rel, 1e-9);
}

TEST(VerifyReport, ACaseFailsOnceHoweverManyFieldsAreWrong) {
  Report report;
  report.begin_case("a");
  report.compare_all({{"x", 1}, {"y", 2}}, {{"x", 9}, {"y", 9}}, {});
  report.begin_case("b");
  EXPECT_EQ(report.failed(), 1);
  EXPECT_EQ(report.passed(), 1);
  EXPECT_EQ(report.failures().size(), 2u);
}

}  // namespace tact::tools::verify::report_test
