// SPDX-License-Identifier: Apache-2.0
// A small PC made of files: sound in all rows, then spoilt one file at a time.
#include "firmware/pc/pc_check.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "firmware/pc/rt_setup.h"
#include "tests/support/program.h"

namespace tact::firmware::pc::pc_check_test {

namespace fs = std::filesystem;

std::string limits(const std::string& priority, const std::string& memory,
                   const std::string& timeout) {
  return "Limit                     Soft Limit           Hard Limit           Units     \n"
         "Max locked memory         " +
         memory +
         "            unlimited            bytes     \n"
         "Max realtime priority     " +
         priority +
         "                    99                   \n"
         "Max realtime timeout      " +
         timeout + "            unlimited            us        \n";
}

/// /proc/PID/stat of a thread whose name holds blanks and brackets, as it may.
std::string stat_of(const std::string& id, int real_time_priority) {
  std::string line = id + " (a) b (c) S";
  for (int field = 4; field < 40; ++field) line += " 0";
  return line + " " + std::to_string(real_time_priority) + " 1 0\n";
}

class PcCheck : public testing::Test {
 protected:
  PcCheck() {
    std::string path = (fs::temp_directory_path() / "tact-pc-XXXXXX").string();
    root = mkdtemp(path.data());
    put("/proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1.192-1\n");
    put("/proc/sys/kernel/osrelease", "6.1.0-rt-amd64\n");
    put("/proc/cpuinfo", "flags : fpu tsc\n");
    put("/sys/devices/system/clocksource/clocksource0/current_clocksource", "tsc\n");
    put("/proc/sys/kernel/sched_rt_runtime_us", "950000\n");
    put("/proc/sys/kernel/sched_rt_period_us", "1000000\n");
    put("/proc/self/status", "Name:\ta\nCapEff:\t0000000000000000\n");
    put("/proc/self/limits", limits("85", "unlimited", "unlimited"));
    put("/proc/self/comm", "a\n");
    put("/proc/swaps", "Filename Type Size Used Priority\n");
    put(cpus + "online", "0-3\n");
    put(cpus + "isolated", "2-3\n");
    put(cpus + "nohz_full", "2-3\n");
    put(cpus + "cpu3/cpufreq/scaling_governor", "performance\n");
    put(cpus + "cpu3/topology/thread_siblings_list", "3\n");
    put("/dev/cpu_dma_latency", "");
    put("/proc/irq/24/smp_affinity_list", "0-3\n");
    put("/proc/irq/24/effective_affinity_list", "0\n");  // where it really goes
    fs::create_directories(root + "/proc/irq/24/xhci_hcd");
    put("/proc/irq/25/smp_affinity_list", "0-3\n");  // no thread waits for it
    put("/proc/90/task/90/comm", "irq/24-xhci_hcd\n");
    put("/proc/90/task/90/stat", stat_of("90", 84));
    put("/proc/100/task/101/comm", "tact-loop\n");
    put("/proc/101/timerslack_ns", "1\n");
    put("/sys/class/net/eth0/type", "1\n");
  }
  ~PcCheck() override { fs::remove_all(root); }

  void put(const std::string& path, const std::string& text) const {
    fs::create_directories(fs::path(root + path).parent_path());
    std::ofstream(root + path) << text;
  }
  std::vector<PcRow> check(int core = -1) const {
    return check_pc({.files = PcFiles(root), .core = core});
  }
  PcRow row(const std::string& name, int core = -1) const {
    for (const PcRow& row : check(core))
      if (row.name == name) return row;
    ADD_FAILURE() << "no row " << name;
    return {};
  }
  /// The row turns red, says what was found, and its remedy is the one that is wanted.
  void expect_red(const std::string& name, const std::string& found,
                  const std::string& remedy) const {
    const PcRow spoilt = row(name);
    EXPECT_EQ(spoilt.verdict, Verdict::kRed) << name << ": " << spoilt.found;
    EXPECT_NE(spoilt.found.find(found), std::string::npos) << name << ": " << spoilt.found;
    EXPECT_NE(spoilt.remedy.find(remedy), std::string::npos) << name << ": " << spoilt.remedy;
    EXPECT_NE(name_red_rows(check()).find(name), std::string::npos);
  }

  std::string root;
  const std::string cpus = "/sys/devices/system/cpu/";
};

TEST_F(PcCheck, ASoundPcHasNoRedRowAndOnlyTheDevicesAreUnknown) {
  for (const PcRow& row : check()) {
    EXPECT_EQ(row.verdict, row.name == "devices" ? Verdict::kUnknown : Verdict::kGreen)
        << row.name << ": " << row.found;
    EXPECT_FALSE(row.found.empty()) << row.name;
    EXPECT_FALSE(row.why.empty()) << row.name;
  }
  EXPECT_EQ(name_red_rows(check()), "");
}

TEST_F(PcCheck, APcThatReportsNothingIsRedOnlyWhereTactdWouldBeRefused) {
  fs::remove_all(root + "/proc");
  fs::remove_all(root + "/sys");
  fs::remove_all(root + "/dev");
  for (const PcRow& row : check()) {
    EXPECT_EQ(row.verdict, row.name == "sleep states" ? Verdict::kRed : Verdict::kUnknown)
        << row.name << ": " << row.found;
    EXPECT_FALSE(row.remedy.empty() && row.name != "interrupts") << row.name;
  }
}

TEST_F(PcCheck, AStockKernelIsRed) {
  put("/proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian\n");
  expect_red("kernel", "not PREEMPT_RT", "linux-image-rt-amd64");
  put("/sys/kernel/realtime", "1\n");  // older real-time kernels report it here alone
  EXPECT_EQ(row("kernel").verdict, Verdict::kGreen);
}

TEST_F(PcCheck, AVirtualMachineIsRed) {
  put("/proc/cpuinfo", "flags : fpu tsc hypervisor lahf_lm\n");
  expect_red("machine", "virtual", "the PC itself");
}

TEST_F(PcCheck, AVirtualMachineIsNamedByItsMaker) {
  put("/proc/cpuinfo", "flags : fpu tsc hypervisor lahf_lm\n");
  put("/sys/class/dmi/id/sys_vendor", "innotek GmbH\n");
  expect_red("machine", "a virtual machine of innotek GmbH", "the PC itself");
  put("/proc/sys/kernel/osrelease", "5.15.153.1-microsoft-standard-WSL2\n");
  expect_red("machine", "WSL", "boot Debian on the PC itself");
}

TEST_F(PcCheck, AContainerGetsItsRightsFromItsEngineAndItsKernelFromTheHost) {
  put("/proc/self/limits", limits("0", "65536", "200000"));
  put("/proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian\n");
  put(cpus + "isolated", "\n");
  expect_red("kernel", "not PREEMPT_RT", "sudo apt install linux-image-rt-amd64");
  for (const auto& [mark, words] :
       {std::pair{"/.dockerenv",
                  "docker run --cap-add=SYS_NICE --ulimit rtprio=85 --ulimit memlock=-1 "
                  "--device /dev/cpu_dma_latency"},
        std::pair{"/run/.containerenv", "podman run --cap-add=SYS_NICE"},
        std::pair{"/run/systemd/container", "rtprio 85, memlock unlimited"}}) {
    put(mark, "1\n");
    expect_red("real-time priority", "up to 0 of 85", words);
    expect_red("locked memory", "65536 bytes", words);
    expect_red("kernel", "not PREEMPT_RT", "on the host: sudo apt install linux-image-rt-amd64");
    expect_red("isolated core", "not isolated", "on the host: ");
    EXPECT_EQ(row("real-time time limit").remedy.find("host"), std::string::npos);
    EXPECT_NE(row("machine").found.find("in a container: "), std::string::npos);
    fs::remove(root + mark);
  }
}

TEST_F(PcCheck, AClockBehindASystemCallIsRed) {
  const std::string path = "/sys/devices/system/clocksource/clocksource0/current_clocksource";
  put(path, "hpet\n");
  expect_red("clock source", "hpet", "tsc=reliable");
  put(path, "one-of-tomorrow\n");
  EXPECT_EQ(row("clock source").verdict, Verdict::kUnknown);
}

TEST_F(PcCheck, ThrottlingIsRedWhenTheLoopCouldMeetIt) {
  put("/proc/sys/kernel/sched_rt_runtime_us", "100000\n");
  expect_red("RT throttling", "100000 of 1000000 us", "sched_rt_runtime_us=950000");
  put("/proc/sys/kernel/sched_rt_runtime_us", "-1\n");
  EXPECT_EQ(row("RT throttling").verdict, Verdict::kGreen);
}

TEST_F(PcCheck, LimitsAreRedUnlessACapabilityFreesFromThem) {
  put("/proc/self/limits", limits("84", "8388608", "200000"));
  expect_red("real-time priority", "up to 84 of 85", "sudo adduser $USER haptics");
  expect_red("locked memory", "8388608 bytes", "sudo adduser $USER haptics");
  expect_red("real-time time limit", "200000 us", "ulimit -R unlimited");
  put("/proc/self/status", "CapEff:\t0000000000800000\n");  // CAP_SYS_NICE alone
  EXPECT_EQ(row("real-time priority").verdict, Verdict::kGreen);
  EXPECT_EQ(row("locked memory").verdict, Verdict::kRed);
  put("/proc/self/status", "CapEff:\t0000000000804000\n");  // and CAP_IPC_LOCK
  EXPECT_EQ(row("locked memory").verdict, Verdict::kGreen);
  EXPECT_EQ(row("real-time time limit").verdict, Verdict::kRed) << "nothing frees from it";
}

TEST_F(PcCheck, TheCoreOfTheLoopIsTheLastIsolatedOneUnlessAnotherIsAskedFor) {
  EXPECT_EQ(core_in_question({.files = PcFiles(root)}), 3);
  EXPECT_EQ(core_in_question({.files = PcFiles(root), .core = 1}), 1);
  EXPECT_EQ(row("isolated core", 1).verdict, Verdict::kRed);
  put(cpus + "isolated", "\n");
  expect_red("isolated core", "core 3 is not isolated",
             "tact-rt_*.deb and boot, or: add isolcpus=domain,managed_irq,3 nohz_full=3 "
             "rcu_nocbs=3 irqaffinity=0-2");
  put(cpus + "nohz_full", "1\n");
  expect_red("timer tick", "core 3", "nohz_full=3");
}

TEST_F(PcCheck, AnInterruptThatMayComeToTheLoopIsRedAndNamed) {
  put("/proc/irq/26/effective_affinity_list", "3\n");
  put("/proc/irq/26/smp_affinity_list", "0-3\n");
  fs::create_directories(root + "/proc/irq/26/eth0");
  expect_red("interrupts", "1 of 2 come to core 3: 26 eth0",
             "for i in 26; do echo 0-2 | sudo tee /proc/irq/$i/smp_affinity_list; done");
}

TEST_F(PcCheck, ACpuThatSlowsDownSleepsDeeplyOrIsSharedIsRed) {
  put(cpus + "cpu3/cpufreq/scaling_governor", "powersave\n");
  expect_red("CPU governor", "powersave", "echo performance");
  fs::remove(root + "/dev/cpu_dma_latency");
  put(cpus + "cpu3/cpuidle/state0/latency", "2\n");
  EXPECT_EQ(row("sleep states").verdict, Verdict::kGreen) << "a state this shallow does not count";
  put(cpus + "cpu3/cpuidle/state1/latency", "900\n");
  expect_red("sleep states", "wakes in 900 us", "sudo adduser $USER haptics");
  put(cpus + "cpu3/cpuidle/state1/disable", "1\n");
  EXPECT_EQ(row("sleep states").verdict, Verdict::kGreen);
  put(cpus + "cpu3/topology/thread_siblings_list", "1,3\n");
  expect_red("SMT sibling", "CPU 1 shares",
             "echo 0 | sudo tee /sys/devices/system/cpu/cpu1/online");
}

TEST_F(PcCheck, NeighboursThatDisturbAreRed) {
  put("/proc/swaps", "Filename Type Size Used Priority\n/dev/sda2 partition 1 0 -2\n");
  expect_red("swap", "1 in use", "swapoff -a");
  put("/proc/77/task/77/comm", "irqbalance\n");
  expect_red("irqbalance", "it runs", "systemctl disable --now irqbalance");
  put("/proc/101/timerslack_ns", "50000\n");
  expect_red("timer slack", "50000 ns of the loop 101", "/proc/101/timerslack_ns");
}

TEST_F(PcCheck, ABusThreadThatTheLoopHoldsUpIsRed) {
  put("/proc/90/task/90/stat", stat_of("90", 50));
  expect_red("bus interrupts", "irq/24-xhci_hcd at 50", "sudo chrt -f -p 84 90");
  put("/proc/90/task/90/comm", "irq/24-eth0\n");
  EXPECT_EQ(row("bus interrupts").verdict, Verdict::kUnknown) << "eth0 carries no haptic device";
}

TEST_F(PcCheck, ADeviceThatLacksSomethingIsRed) {
  put("/sys/class/net/can0/type", "280\n");
  put("/sys/class/net/can0/flags", "0x0\n");
  expect_red("device can0", "CAN interface, down", "can0 up");
}

TEST_F(PcCheck, JsonHasEveryRow) {
  const auto json = to_json(check());
  ASSERT_EQ(json.size(), check().size());
  EXPECT_EQ(json[0]["name"], "kernel");
  EXPECT_EQ(json[0]["verdict"], "green");
  EXPECT_EQ(json[0]["remedy"], "");
}

TEST(ShortForm, IsPrintedByTactdWhenItStartsInRealTime) {
  const auto red = name_red_rows(check_pc({.files = PcFiles{}, .core = choose_core(RtSettings{})}));
  const auto reports = [](const std::string& how) {
    const std::string said =
        tests::run_program("tactd", std::string(TACT_SOURCE_DIR) +
                                        "/model/scenes/liver.toml --no-telemetry --ticks 10" + how)
            .output;
    return said.find(" checks of this PC are red (") != std::string::npos &&
           said.find("); tact-doctor says why and names the remedy\n") != std::string::npos;
  };
  EXPECT_EQ(reports(""), !red.empty()) << red;
  EXPECT_FALSE(reports(" --free-run")) << "simulated time is never late";
}

TEST(CpuList, IsReadAndWrittenAsTheKernelDoes) {
  EXPECT_EQ(parse_cpu_list("0-2,5\n"), (std::vector<int>{0, 1, 2, 5}));
  EXPECT_EQ(make_cpu_list({0, 1, 2, 5}), "0-2,5");
  EXPECT_EQ(make_cpu_list({3}), "3");
  for (const char* bad : {"", "x", "1-", "-1", "1;2", "0-99999999"})
    EXPECT_TRUE(parse_cpu_list(bad).empty()) << bad;
}

}  // namespace tact::firmware::pc::pc_check_test
