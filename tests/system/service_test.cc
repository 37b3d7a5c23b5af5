// SPDX-License-Identifier: Apache-2.0
// tactd as systemd starts it: NOTIFY_SOCKET, runtime and state folder, no terminal.
#include <gtest/gtest.h>

#include "tests/support/device_scene.h"
#include "tests/system/tactd_fixture.h"

namespace tact::tests::service_test {

class ServiceProgram : public Tactd {
 protected:
  /// What the manager has heard, then what tactd has said, and its report.
  Outcome run(const std::string& acts, const std::string& options = "") {
    const std::string script = in_folder("service.sh");
    std::ofstream(script)
        << "cd " << folder << "\nexport NOTIFY_SOCKET=" << in_folder("n")
        << " XDG_RUNTIME_DIR=" << folder << " XDG_STATE_HOME=" << folder << "\n"
        << "python3 -c 'import socket\ns = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)\n"
        << "s.bind(\"n\")\nwhile True: print(s.recv(999).decode(), flush=True)' > heard & "
        << "manager=$!\nuntil [ -S n ]; do sleep .05; done\n"
        << program_path("tactd") << " " << kLiver << " --json report.json --set rate_Hz=500 "
        << options << " >log 2>&1 & tactd=$!\n"
        << "for i in {1..100}; do grep -qs READY heard && break; sleep .1; done\n"
        << acts << "\nkill -TERM $tactd; wait $tactd; status=$?\nsleep .1; kill $manager\n"
        << "cat heard log; exit $status\n";
    return run_command("bash " + script);
  }
  nlohmann::json report() const {
    std::ifstream file(in_folder("report.json"));
    return nlohmann::json::parse(file, nullptr, false);
  }
};

TEST_F(ServiceProgram, NeverArmsItselfNotEvenOnTheSimulatedDevice) {
  const Outcome out = run("sleep 1.5");
  ASSERT_TRUE(has(out, "READY=1")) << out.output;
  EXPECT_TRUE(has(out, "ready, force is off")) << out.output;
  EXPECT_TRUE(has(out, "WATCHDOG=1")) << out.output;
  EXPECT_TRUE(has(out, "STOPPING=1")) << out.output;
  ASSERT_FALSE(report().is_discarded()) << out.output;
  EXPECT_FALSE(has(out, "armed, force is on")) << out.output;
  EXPECT_EQ(report().at("force_max_N"), 0.0);
}

TEST_F(ServiceProgram, IsArmedByAPerson) {
  const Outcome out = run(program_path("tactctl") + " " + kLiver + " arm; sleep .3");
  EXPECT_TRUE(has(out, "armed, force is on")) << out.output;
}

TEST_F(ServiceProgram, RefusesToArmAtItsStart) {
  const Outcome out = run_command("NOTIFY_SOCKET=" + in_folder("n") + " " + program_path("tactd") +
                                  " " + kLiver + " --arm --ticks 10");
  EXPECT_EQ(out.status, 2);
  EXPECT_TRUE(has(out, "a service never arms")) << out.output;
}

TEST_F(ServiceProgram, DoesNotHomeOnAJigWithoutAPerson) {
  const std::string scene = in_folder("jig.toml");
  std::ofstream(scene) << scene_on_real_devices();
  const Outcome out = run_command("NOTIFY_SOCKET=" + in_folder("n") + " " + program_path("tactd") +
                                  " " + scene + " --ticks 10");
  EXPECT_EQ(out.status, 2);
  EXPECT_TRUE(has(out, "start tactd by hand")) << out.output;
}

TEST_F(ServiceProgram, WaitsForTheBusOfItsDeviceAndEndsByASignal) {
  const std::string scene = in_folder("bus.toml");
  std::ofstream(scene) << scene_on_real_devices();
  const Outcome out = run_command(
      "export NOTIFY_SOCKET=" + in_folder("n") + "; " + program_path("tactd") + " " + scene +
      " --set 'device.can.homing=\"absolute\"' --set 'device.can.interface=\"tact-none\"' >" +
      in_folder("log") + " 2>&1 & tactd=$!; until grep -qs 'waiting for' " + in_folder("log") +
      "; do kill -0 $tactd || break; sleep .05; done; kill -TERM $tactd; wait $tactd; "
      "status=$?; cat " +
      in_folder("log") + "; exit $status");
  EXPECT_EQ(out.status, 0) << out.output;
  EXPECT_TRUE(has(out, "tactd: waiting for tact-none: it is not there, or not up")) << out.output;
}

}  // namespace tact::tests::service_test
