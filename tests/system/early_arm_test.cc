// SPDX-License-Identifier: Apache-2.0
// A person who arms too early, at every moment of the start, and one who waits for the words.
#include <gtest/gtest.h>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::early_arm_test {

class Arming : public Tactd {
 protected:
  /// tactd on the stand-in for Force Dimension's library, which waits for a person; `acts` is bash
  /// with $tactd in it.
  /// A machine that is busy with other work may stop such a loop by itself: then once more.
  Outcome run(const std::string& acts) const {
    Outcome out = run_once(acts);
    for (int i = 0; i < 5 && stopped_itself(); ++i) out = run_once(acts);
    return out;
  }
  bool stopped_itself() const {
    const nlohmann::json told = report();
    return told.is_discarded() || told.at("fault").at("number") != 0;
  }
  Outcome run_once(const std::string& acts) const {
    std::filesystem::remove(told());
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << program_path("tactd") << " " << kLiver
        << " --no-black-box --no-seccomp --seconds 1 --set rate_Hz=250 --set limits.energy_J=0.2"
        << " --socket " << in_folder("t.sock") << " --set 'device.kind=\"force-dimension\"'"
        << " --set 'device.force_dimension.library=\"" << TACT_BINARY_DIR
        << "/libtact-stub-dhd.so\"' --json " << in_folder("report.json") << " 2>" << told()
        << " & tactd=$!\nready() { for i in {1..100}; do grep -q 'ready, force is off' " << told()
        << " && break; sleep .05; done; }\n"
        << "blocked() { while kill -0 $tactd && "
           "! (( 0x0$(awk '/SigBlk/ {print $2}' /proc/$tactd/status) & 0x800 )); do :; done; }\n"
        // USR2, by the first line of main
        << acts << "\nwait $tactd; cat " << told() << "\n";
    return run_command("bash " + script);
  }
  std::string told() const { return in_folder("told"); }
  nlohmann::json report() const {
    std::ifstream file(in_folder("report.json"));
    return nlohmann::json::parse(file, nullptr, false);
  }
};

TEST_F(Arming, BeforeTheWordsIsRefusedWhenEverItComesAndLeavesNothingBehind) {
  for (const char* delay_s : {"0", "0.02", "0.05", "0.08"}) {
    const Outcome out =
        run(std::string("blocked; sleep ") + delay_s + "; kill -USR2 $tactd; ready");
    ASSERT_TRUE(has(out, "ready, force is off")) << delay_s << out.output;
    EXPECT_TRUE(has(out, "not armed")) << delay_s << out.output;
    ASSERT_FALSE(report().is_discarded()) << out.output;
    EXPECT_EQ(report().at("state"), "ready") << delay_s;
    EXPECT_EQ(report().at("refused_requests"), 1) << delay_s;
  }
}

TEST_F(Arming, AfterTheWordsArmsAtOnce) {
  const Outcome out = run("ready; sleep .1; kill -USR2 $tactd");
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_EQ(report().at("state"), "armed") << out.output;
  EXPECT_EQ(report().at("refused_requests"), 0) << out.output;
}

TEST_F(Arming, SignalsByMistakeEndNothing) {
  const Outcome out =
      run("ready; for s in XFSZ ALRM IO PROF VTALRM PWR RTMIN RTMAX; do kill -$s $tactd; done\n"
          "sleep .2; kill -USR2 $tactd");
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_EQ(report().at("state"), "armed") << out.output;
}

}  // namespace tact::tests::early_arm_test
