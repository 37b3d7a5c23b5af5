// SPDX-License-Identifier: Apache-2.0
// A computer that has run out of something: the loop goes on, and what is lost is reported.
#include <gtest/gtest.h>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::scarce_test {

class Scarce : public Tactd {
 protected:
  /// Bash, in which `start` runs tactd on its simulated device and `begun` waits until it pushes.
  Outcome in_bash(const std::string& before, const std::string& options,
                  const std::string& acts) const {
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "cd " << folder << "\nexport XDG_RUNTIME_DIR=" << folder << "\n"
        << "start() { " << program_path("tactd") << " " << kLiver
        << " --set rate_Hz=500 --json report.json " << options << " >out 2>notes & tactd=$!; }\n"
        << "begun() { for i in {1..200}; do " << program_path("tactctl") << " " << kLiver
        << " status 2>&1 | grep -q armed && break; sleep .05; done; }\n"
        << "logged() { for i in {1..100}; do grep -qs \"$1\" notes && break; sleep .05; done; }\n"
        << before << "\nstart\n"
        << acts << "\n";
    return run_command("timeout -s KILL 60 bash " + script);
  }
  nlohmann::json report() const {
    std::ifstream file(in_folder("report.json"));
    return nlohmann::json::parse(file, nullptr, false);
  }
  static std::size_t times(const std::string& words, const std::string& text) {
    std::size_t n = 0;
    for (auto at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++n;
    return n;
  }
};

TEST_F(Scarce, AFileSizeLimitEndsTheRecordAndNotTheLoop) {
  const Outcome out =
      in_bash("ulimit -f 64", "--no-black-box --no-telemetry --record log --seconds 3",
              "begun; logged 'goes on without its record'; kill -0 $tactd && echo "
              "lives\nwait $tactd; echo status $?; cat notes");
  EXPECT_TRUE(has(out, "lives\n")) << out.output;
  EXPECT_TRUE(has(out, "status 1\n")) << out.output;
  EXPECT_TRUE(has(out, "what was written before is kept")) << out.output;
  EXPECT_EQ(times("log: cannot be written: File too large", out.output), 2u)
      << "at once and at the end: " << out.output;
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_GT(report().at("ticks"), 100) << out.output;
}

TEST_F(Scarce, TicksReportedAsKeptAreInTheFile) {
  for (const char* limit : {"0", "4", "100", "300"}) {
    const Outcome out = run_command(
        "cd " + folder + "; rm -f log; (ulimit -f " + limit + "; exec " + program_path("tactd") +
        " " + kLiver + " --free-run --seconds 3 --no-telemetry --no-black-box --record log)");
    const Outcome kept = run_program("tactd", kLiver + " --replay " + in_folder("log"));
    const bool is_promised = has(out, "what was written before is kept");
    EXPECT_EQ(out.status, is_promised ? 1 : 2) << limit << " " << out.output;
    EXPECT_EQ(is_promised, has(kept, "good ticks were read")) << limit << out.output << kept.output;
  }
}

TEST_F(Scarce, AFullDiskEndsTheRecordAndNotTheLoop) {
  const Outcome can = run_command("unshare -rm sh -c 'mount -t tmpfs -o size=64k none /mnt'");
  if (can.status != 0) GTEST_SKIP() << "no file system of one's own here: " << can.output;
  const Outcome out = run_command(
      "cd " + folder + " && mkdir disk && XDG_RUNTIME_DIR=" + folder +
      " timeout -s KILL 60 unshare -rm sh -c 'mount -t tmpfs -o size=16k none disk && " +
      program_path("tactd") + " " + kLiver +
      " --set rate_Hz=500 --no-black-box --no-telemetry --record disk/log --seconds 2 --json "
      "report.json'");
  EXPECT_EQ(times("disk/log: cannot be written: No space left on device", out.output), 2u)
      << out.output;
  EXPECT_TRUE(has(out, "goes on without its record")) << out.output;
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_GT(report().at("ticks"), 100) << out.output;
}

TEST_F(Scarce, ThreadThatCannotStartEndsTheProgramBeforeTheLoop) {
  const std::string start = program_path("tactd") + " " + kLiver + " --seconds 1 --socket " +
                            in_folder("t.sock") + " --black-box " + in_folder("kept");
  // Root has no such limit.
  const std::string user = geteuid() == 0 ? "setpriv --reuid 65534 --clear-groups " : "";
  const Outcome out = run_command("chmod 777 " + folder + "; timeout -s KILL 60 " + user +
                                  "bash -c 'ulimit -u 1; exec " + start + "'");
  EXPECT_TRUE(out.status == 1 || out.status == 2) << out.status << ": " << out.output;
  EXPECT_TRUE(has(out, "cannot be started")) << out.output;
  EXPECT_FALSE(has(out, "terminate called")) << out.output;
}

TEST_F(Scarce, WithoutMemoryAFaultStillLeavesItsBlackBox) {
  for (const std::string kind : {"VmSize --as", "VmData --data"}) {
    const auto gap = kind.find(' ');
    const Outcome out = in_bash(
        "", "--black-box kept --record log --socket t.sock",
        "begun; k=$(awk '/" + kind.substr(0, gap) + "/ {print $2}' /proc/$tactd/status)\n" +
            "prlimit --pid $tactd " + kind.substr(gap + 1) + "=$((k * 1024)):$((k * 1024))\n" +
            "kill -XCPU $tactd; wait $tactd; echo status $?; cat notes; stat -c '%s B' kept/*\n"
            "rm -r kept log");
    EXPECT_TRUE(has(out, "status 1\n")) << kind << out.output;
    EXPECT_TRUE(has(out, "black box of fault 122")) << kind << out.output;
    EXPECT_FALSE(has(out, "terminate called")) << kind << out.output;
    EXPECT_FALSE(has(out, "\n0 B")) << kind << out.output;
    EXPECT_FALSE(report().is_discarded()) << kind << out.output;
  }
}

TEST_F(Scarce, WithoutAFreeDescriptorTheLoopGoesOnAndItsPersonIsHeard) {
  const Outcome out =
      in_bash("", "--no-black-box --socket t.sock",
              "begun; last=$(ls /proc/$tactd/fd | sort -n | tail -1); prlimit --pid $tactd "
              "--nofile=$((last + 1)):$((last + 1))\n"
              "sleep .3\n" +
                  program_path("tactctl") + " " + kLiver + " status; " + program_path("tactctl") +
                  " " + kLiver + " stop; wait $tactd; echo status $?; cat notes out");
  EXPECT_TRUE(has(out, "simulated delta")) << out.output;
  EXPECT_TRUE(has(out, "force to zero, then tactd ends")) << out.output;
  EXPECT_TRUE(has(out, "status 0")) << "no fault: " << out.output;
}

}  // namespace tact::tests::scarce_test
