// SPDX-License-Identifier: Apache-2.0
// A person who arms too early, at every moment of the start, and one who waits for the words.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "model/fault.h"
#include "tests/support/extent.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::early_arm_test {

class Arming : public Tactd {
 protected:
  /// tactd on the stand-in for Force Dimension's library, which waits for a person; `acts` is bash
  /// with $tactd in it, and `ctl` is tactctl.
  /// A machine that is busy with other work may stop such a loop by itself: then once more.
  Outcome run(const std::string& acts) const {
    Outcome out = run_once(acts);
    for (int i = 0; i < 5 && stopped_itself(); ++i) out = run_once(acts);
    return out;
  }
  bool stopped_itself() const {
    const nlohmann::json reported = report();
    return reported.is_discarded() || reported.at("fault").at("number") != 0;
  }
  Outcome run_once(const std::string& acts) const {
    std::filesystem::remove(reported());
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "export XDG_RUNTIME_DIR=" << in_folder("") << "\ncd " << in_folder("") << "\n"
        << program_path("tactd") << " " << kLiver << " --no-black-box --seconds 3 --socket "
        << in_folder("t.sock") << kStubDevice
        << " --set device.force_dimension.watchdog_s=0.0318 --json " << in_folder("report.json")
        << " 2>" << reported()
        << " & tactd=$!\nready() { while kill -0 $tactd && ! grep -qs 'ready, force is off' "
        << reported() << "; do sleep .05; done; }\n"
        << "ctl() { " << program_path("tactctl") << " " << kLiver << " --pid $tactd $1; }\n"
        << acts << "\nwait $tactd; cat " << reported() << "\n";
    return run_command("bash " + script);
  }
  /// tactd on its simulated device, which pushes by itself, until this signal.
  void run_until(const std::string& signal) const {
    std::filesystem::remove(in_folder("log"));
    std::filesystem::remove(in_folder("report.json"));
    const std::string script = in_folder("ends.sh");
    std::ofstream(script) << program_path("tactd") << " " << kLiver << " --no-black-box --json "
                          << in_folder("report.json") << " --set rate_Hz=500 --record "
                          << in_folder("log") << " --socket " << in_folder("t.sock")
                          << " & tactd=$!\nfor i in {1..200}; do [ -s " << in_folder("log")
                          << " ] && break; sleep .05; done; sleep .3; kill -" << signal
                          << " $tactd\n(sleep 8; kill -KILL $tactd) >/dev/null 2>&1 & late=$!\n"
                          << "wait $tactd; kill $late\n";
    run_command("bash " + script);
  }
  int fault() const {
    const nlohmann::json reported = report();
    return reported.is_discarded() ? -1 : reported.at("fault").at("number").get<int>();
  }
  std::string reported() const { return in_folder("log"); }
  nlohmann::json report() const {
    std::ifstream file(in_folder("report.json"));
    return nlohmann::json::parse(file, nullptr, false);
  }
};

// From the first instruction on: no socket yet, then refused, then the words, then armed.
TEST_F(Arming, ArmRequestsBeforeTheReadyMessageGiveNoForce) {
  const Outcome out =
      run("until ctl arm; do kill -0 $tactd || break; done\n"
          "grep -q 'ready, force is off' " +
          reported() +
          " || echo no words\n"
          "ctl arm");
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_FALSE(has(out, "no words")) << out.output;
  EXPECT_TRUE(has(out, "it is armed already")) << out.output;
  EXPECT_EQ(report().at("state"), "armed") << out.output;
}

// A sanitizer catches SEGV, BUS and FPE for its reports, and tactd leaves them to it.
TEST_F(Arming, SignalsByMistakeEndNothing) {
  const Outcome out =
      run("caught() { (( 0x$(awk '/SigCgt/ {print $2}' /proc/$tactd/status) >> ($1 - 1) & 1 )); }\n"
          // by number, as names cost a process each: all but HUP INT QUIT ABRT KILL TERM STOP
          // TSTP XCPU; BUS FPE SEGV
          "ready; for s in {1..64}; do case $s in 1|2|3|6|9|15|19|20|24) ;; "
          "7|8|11) caught $s || kill -$s $tactd;; *) kill -$s $tactd;; esac; done\n"
          "sleep .2; ctl arm");
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_EQ(report().at("state"), "armed") << out.output;
}

TEST_F(Arming, EverySignalThatAsksToEndOrHaltEndsWithAReportAndWithoutForce) {
  const std::vector<std::string> signals{"TERM", "XCPU", "INT", "HUP", "QUIT", "ABRT", "TSTP"};
  for (const std::string& signal :
       std::span(signals).first(std::max<std::size_t>(share_of(7, 7), 2))) {
    const int expected = signal == "XCPU" ? static_cast<int>(model::Fault::kLoopRanAway) : 0;
    for (int i = 0; i < 5 && (i == 0 || fault() != expected); ++i) run_until(signal);
    ASSERT_FALSE(report().is_discarded()) << signal;
    EXPECT_EQ(report().at("fault").at("number"), expected) << signal;
    EXPECT_EQ(report().at("state"), "stopped") << signal;
  }
}

}  // namespace tact::tests::early_arm_test
