// SPDX-License-Identifier: Apache-2.0
// One thread of tactd waits, as for a disk that hangs or a core that is taken: what tactctl says is
// what the loop does.
#include "tests/system/tactd_fixture.h"

namespace tact::tests::held_threads_test {

class HeldThreads : public Tactd {
 protected:
  /// Bash, in which `hold NAME` lets that thread of a tactd that pushes sleep, and `ctl` asks it.
  Outcome in_bash(const std::string& acts) const {
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "cd " << folder << "\nexport XDG_RUNTIME_DIR=" << folder << "\nctl() { "
        << program_path("tactctl") << " " << kLiver << " $1 2>&1; echo \"$1 $?\"; }\n"
        << "hold() { for t in /proc/$tactd/task/*; do grep -qx $1 $t/comm && thread=${t##*/}; "
           "done\n"
        << "timeout -s INT 20 strace -qq -o /dev/null -p $thread -e "
           "inject=clock_nanosleep:delay_exit=30000000 >/dev/null 2>&1 & sleep 1; }\n"
        << program_path("tactd") << " " << kLiver << " --set rate_Hz=500 --no-black-box --record "
        << "log --socket t.sock >out 2>&1 & tactd=$!\n"
        << "for i in {1..200}; do ctl status | grep -q ': armed' && break; sleep .05; done\n"
        << acts << "\nkill -KILL $tactd; kill %1 %2 2>/dev/null\n";
    return run_command("timeout -s KILL 60 bash " + script);
  }
};

TEST_F(HeldThreads, AStoppedLoopGetsNoAnswerInItsName) {
  const Outcome out = in_bash("ctl status; hold tact-loop; ctl status");
  EXPECT_TRUE(has(out, "status 0\n")) << out.output;
  EXPECT_TRUE(has(out, "not answered: the loop has stopped; ")) << out.output;
  EXPECT_TRUE(has(out, "status 1\n")) << out.output;
}

TEST_F(HeldThreads, ARecorderThatWaitsHidesNoFault) {
  const Outcome out = in_bash(
      "hold tact-telemetry; kill -STOP $tactd; sleep .5; kill -CONT $tactd; sleep .5\n"
      "ctl status; ctl reset; ctl status");
  EXPECT_TRUE(has(out, ": stopped, 0.000 N, fault 105, ")) << out.output;
  EXPECT_TRUE(has(out, "reset, ready; arm it\nreset 0\n")) << out.output;
  EXPECT_TRUE(has(out, ": ready, 0.000 N")) << out.output;
}

}  // namespace tact::tests::held_threads_test
