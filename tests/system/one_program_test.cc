// SPDX-License-Identifier: Apache-2.0
// A second program on a device that has one already.
#include <gtest/gtest.h>

#include "tests/system/tactd_fixture.h"

namespace tact::tests::one_program_test {

class OneProgram : public Tactd {
 protected:
  /// `second` is a command of bash with $tactd, which is tactd with a device that is taken.
  Outcome beside_another(const std::string& second) const {
    const std::string script = in_folder("run.sh");
    std::ofstream(script)
        << "export TACT_STUB_DHD_SERIAL=" << 1 + getpid() % 60'000 << "\n"
        << "tactd=\"" << program_path("tactd") << " " << kLiver
        << " --no-telemetry --no-black-box --no-seccomp --trust-library --set rate_Hz=250"
        << " --set limits.energy_J=0.2 --set device.kind=\\\"force-dimension\\\""
        << " --set device.force_dimension.library=\\\"" << TACT_BINARY_DIR
        << "/libtact-stub-dhd.so\\\"\"\n"
        << "$tactd 2>" << in_folder("log") << " & first=$!\n"
        << "for i in {1..100}; do grep -qs 'ready, force is off' " << in_folder("log")
        << " && break; sleep .05; done\n"
        << second << "\nstatus=$?; echo first=$first\n"
        << "kill -0 $first && echo lives; kill -KILL $first\nexit $status\n";
    return run_command("bash " + script);
  }
};

TEST_F(OneProgram, OpensADeviceAndNamesItsHolderToASecond) {
  const Outcome out = beside_another("$tactd --seconds 1");
  EXPECT_EQ(out.status, 2) << out.output;
  const std::string first = out.output.substr(out.output.rfind("first=") + 6);
  EXPECT_TRUE(has(out, "driven by process " + first.substr(0, first.find('\n')) + " (tactd)"))
      << out.output;
  EXPECT_TRUE(has(out, "lives")) << "the first goes on";
}

TEST_F(OneProgram, TheSimulatedDeviceBelongsToEveryProgram) {
  const Outcome out = beside_another(program_path("tactd") + " " + kLiver +
                                     " --no-telemetry --free-run --ticks 10");
  EXPECT_EQ(out.status, 0) << out.output;
}

}  // namespace tact::tests::one_program_test
