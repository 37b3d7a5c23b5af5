// SPDX-License-Identifier: Apache-2.0
// tactctl and the tactds of one computer.
#include <gtest/gtest.h>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::control_test {

class Control : public Tactd {
 protected:
  void SetUp() override {
    Tactd::SetUp();
    std::filesystem::create_directory(in_folder("run"));
  }
  /// Bash, in which `start NAME SCENE` runs tactd on a stand-in for hardware of its own, `ready
  /// NAME` waits for its words, and `ctl` is tactctl.
  Outcome in_bash(const std::string& acts) const {
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "export TACT_STUB_DHD_NO_WATCHDOG=1 XDG_RUNTIME_DIR=" << in_folder("run") << "\ncd "
        << in_folder("") << "\nln -sf " << TACT_SOURCE_DIR "/model/scenes/* .\n"
        << "start() { " << program_path("tactd") << " $2 --no-telemetry --no-black-box"
        << kStubDevice << " --json $1.json 2>$1.log & }\n"
        << "ready() { for i in {1..200}; do grep -qs 'ready, force is off' $1.log && break; sleep "
           ".05; done; }\n"
        << "ctl() { " << program_path("tactctl") << " \"$@\"; echo \"status $?\"; }\n"
        << acts << "\n";
    return run_command("timeout -s KILL 60 bash " + script);
  }
  nlohmann::json report(const std::string& name) const {
    std::ifstream file(in_folder(name + ".json"));
    return nlohmann::json::parse(file, nullptr, false);
  }
};

TEST_F(Control, ArmsTheTactdOfItsSceneAloneAndStopsIt) {
  const Outcome out = in_bash(
      "start a ./liver.toml; a=$!; start b skin.toml; b=$!; ready a; ready b\n"
      "ctl liver.toml arm; sleep .2; ctl ./skin.toml status; ctl liver.toml status\n"
      "ctl liver.toml stop; wait $a; ctl liver.toml status; ctl skin.toml stop; wait $b\n"
      "ls run/tact; cat a.log");
  EXPECT_TRUE(has(out, "armed, force is on\nstatus 0")) << out.output;
  // Where the stand-in's tool is by then depends on how long the start took: it may say more.
  EXPECT_TRUE(has(out, ": ready, 0.000 N")) << out.output;
  EXPECT_TRUE(has(out, "force to zero, then tactd ends\nstatus 0")) << out.output;
  EXPECT_TRUE(has(out, "tactctl: no tactd runs liver.toml")) << out.output;
  EXPECT_TRUE(has(out, "status 2")) << out.output;
  EXPECT_TRUE(has(out, "then arm it (tactctl ./liver.toml arm)")) << out.output;
  EXPECT_FALSE(has(out, "control-")) << "nothing is left: " << out.output;
  ASSERT_FALSE(report("b").is_discarded()) << out.output;
  EXPECT_EQ(report("b").at("force_max_N"), 0.0);
}

TEST_F(Control, DisarmsWithoutEndingItAndItCanBeArmedAgain) {
  const Outcome out = in_bash(
      "start a liver.toml; a=$!; ready a; ctl liver.toml arm; ctl liver.toml disarm\n"
      "until ctl liver.toml status | grep -q ': ready, 0.000 N'; do sleep .1; done\n"
      "ctl liver.toml arm; ctl liver.toml stop; wait $a");
  EXPECT_TRUE(has(out, "no force; arm it again when it shall have one\nstatus 0")) << out.output;
  EXPECT_FALSE(has(out, "status 1")) << out.output;
  ASSERT_FALSE(report("a").is_discarded()) << out.output;
  EXPECT_EQ(report("a").at("refused_requests"), 0);
}

TEST_F(Control, SetsNumbersOfTheLawWhileItRunsAndTheRecordReplays) {
  const Outcome out = in_bash(
      program_path("tactd") +
      " liver.toml --seconds 20 --no-telemetry --no-black-box --record run.tactlog "
      "--json a.json 2>a.log & a=$!\n"
      "until ctl liver.toml status | grep -q armed; do sleep .1; done\n"
      "ctl liver.toml set elastic.youngs_modulus_Pa 4800 rhombus.growth=6.5\n"
      "until grep -q 'elastic.youngs_modulus_Pa=4800 rhombus.growth=6.5: set' a.log; do sleep .1; "
      "done\n"
      "ctl liver.toml set elastic.youngs_modulus_Pa=4500\n"
      "until grep -q 'tactd: elastic.youngs_modulus_Pa=4500: set' a.log; do sleep .1; "
      "done\n"
      "ctl liver.toml set elastic.youngs_modulus_Pa=9e8; ctl liver.toml set limits.force_N=4\n"
      "ctl liver.toml stop; wait $a; " +
      program_path("tactd") + " liver.toml --replay run.tactlog");
  EXPECT_TRUE(has(out, " 0 differ")) << out.output;
  EXPECT_TRUE(has(out, "not set: limits.force_N cannot change while the scene runs")) << out.output;
  ASSERT_FALSE(report("a").is_discarded()) << out.output;
  EXPECT_EQ(report("a").at("variants"), 2);
  EXPECT_EQ(report("a").at("refused_requests"), 2);
}

TEST_F(Control, AnEventIsInTheRecordOfTheTickThatTheAnswerNames) {
  const std::string tactd = program_path("tactd");
  const Outcome out = in_bash(
      tactd +
      " liver.toml --seconds 20 --no-telemetry --no-black-box --record run.tactlog 2>a.log & "
      "a=$!\n"
      "until ctl liver.toml status | grep -q armed; do sleep .1; done\n"
      "ctl liver.toml event 7 | tee answer; ctl liver.toml event 0; ctl liver.toml event\n"
      "ctl liver.toml stop; wait $a; " +
      tactd +
      " --replay run.tactlog --csv run.csv; grep -v '^#' run.csv | awk -F, 'NR == 1 { for (i = 1; "
      "i "
      "<= NF; ++i) if ($i == \"event\") c = i; next } $c != 0 { print \"event \" $c \" in tick \" "
      "$1 }' >found; grep '^event' answer | diff - found && echo equal");
  EXPECT_TRUE(has(out, "event 7 in tick ")) << out.output;
  EXPECT_TRUE(has(out, "\nequal\n")) << out.output;
  EXPECT_TRUE(has(out, "event takes a number from 1 to 255\nstatus 1")) << out.output;
  EXPECT_TRUE(has(out, "event needs a number from 1 to 255; see tactctl --help\nstatus 2"))
      << out.output;
}

TEST_F(Control, OnHardwareSetsOnlyWhatTheSceneDeclaresLive) {
  const Outcome out = in_bash(
      "cp liver.toml live.toml; printf '\\n[[live]]\\nkey = \"elastic.youngs_modulus_Pa\"\\n' "
      ">> live.toml\n"
      "start a live.toml; a=$!; ready a; ctl live.toml set rhombus.growth=6.5\n"
      "ctl live.toml set elastic.youngs_modulus_Pa=4800; ctl live.toml stop; wait $a");
  EXPECT_TRUE(has(out,
                  "not set: the device is hardware, and the scene has no [[live]] with key = "
                  "\"rhombus.growth\"\nstatus 1"))
      << out.output;
  ASSERT_FALSE(report("a").is_discarded()) << out.output;
  EXPECT_EQ(report("a").at("variants"), 1) << out.output;
}

TEST_F(Control, RefusesWithTheReason) {
  const Outcome out = in_bash(
      "start a liver.toml; a=$!; ready a; ctl liver.toml reset\n"
      "ctl liver.toml stop; wait $a");
  EXPECT_TRUE(has(out, "not reset: it is ready, not stopped\nstatus 1")) << out.output;
  ASSERT_FALSE(report("a").is_discarded()) << out.output;
  EXPECT_EQ(report("a").at("refused_requests"), 1);
}

TEST_F(Control, TwoControllersOfASceneNeedPidAndAKilledOneIsIgnored) {
  const Outcome out = in_bash(
      "start a liver.toml; a=$!; start b liver.toml; b=$!; ready a; ready b; ctl liver.toml arm\n"
      "ctl liver.toml status --pid $b; kill -KILL $a; wait $a; ctl liver.toml status\n"
      "start c skin.toml; c=$!; ready c; ls run/tact | wc -l\n"
      "ctl liver.toml stop; ctl skin.toml stop; wait $b $c");
  EXPECT_TRUE(has(out, "say which one by --pid\nstatus 2")) << out.output;
  EXPECT_TRUE(has(out, ": ready, 0.000 N")) << out.output;
  EXPECT_FALSE(has(out, "status 1")) << out.output;
  EXPECT_TRUE(has(out, "\n2\n")) << "what the killed one left is gone: " << out.output;
}

TEST_F(Control, ReportsBadUsageAndATactdThatHangs) {
  const Outcome out = in_bash(
      "ctl --help | tail -1; ctl; ctl liver.toml; ctl liver.toml fire\n"
      "start a liver.toml; a=$!; ready a; kill -STOP $a; ctl liver.toml stop; kill -CONT $a; wait "
      "$a");
  EXPECT_TRUE(has(out, "status 0\ntactctl: ")) << out.output;
  EXPECT_FALSE(has(out, "status 1")) << out.output;
  EXPECT_TRUE(has(out, "fire")) << out.output;
  EXPECT_TRUE(has(out, "does not answer")) << out.output;
}

TEST_F(Control, WhereNoSocketCanBeTheReasonIsReportedAndThereIsNoForce) {
  const Outcome out = in_bash(
      "chmod 755 run; mkdir -m 777 run/tact; start a ./liver.toml; a=$!; ready a\n"
      "sleep .3; kill -INT $a; wait $a; cat a.log");
  EXPECT_TRUE(has(out, "tactctl does not reach this tactd, so it cannot be armed: ")) << out.output;
  EXPECT_TRUE(has(out, "remove it and start again")) << out.output;
  ASSERT_FALSE(report("a").is_discarded()) << out.output;
  EXPECT_EQ(report("a").at("force_max_N"), 0.0);
}

}  // namespace tact::tests::control_test
