// SPDX-License-Identifier: Apache-2.0
// tools/deploy/: the files that let a group of people use real devices.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

#include "hal/gpio/gpio_chips.h"
#include "hal/registry/open_device.h"
#include "tests/support/files.h"
#include "tests/support/program.h"

namespace {

namespace fs = std::filesystem;
using tact::tests::content;
using tact::tests::run_command;

const std::string kDeploy = TACT_SOURCE_DIR "/tools/deploy/";

/// What update-grub reads from the drop-in of tact-rt on a PC with these CPUs, after `before`.
std::string kernel_line(const std::string& online, const std::string& before = "quiet",
                        const std::string& core = "") {
  return run_command("env GRUB_CMDLINE_LINUX='" + before + "' TACT_ONLINE=" + online +
                     " TACT_CORE=" + core + " sh -euc '. " + kDeploy +
                     "rt/tact-rt.cfg; echo \"$GRUB_CMDLINE_LINUX\"'")
      .output;
}

class Deploy : public testing::Test {
 protected:
  Deploy()
      : folder(testing::TempDir() + "tact-deploy-" + std::to_string(getpid()) + "-" +
               testing::UnitTest::GetInstance()->current_test_info()->name()),
        said(folder + "/said") {
    fs::create_directories(folder);
  }
  ~Deploy() override { fs::remove_all(folder); }
  std::string folder, said;
};

TEST_F(Deploy, TheRulesAreThoseThatTheSentencesPrint) {
  const std::string rules = content(kDeploy + "60-tact.rules");
  const auto expect = [&](const std::string& rule) {
    EXPECT_NE(rules.find("\n" + rule + "\n"), std::string::npos) << rule;
  };
  for (const tact::hal::UsbPart& part : tact::hal::registry::usb_parts()) expect(part.rule);
  expect(tact::hal::gpio::kGpioRule);
  EXPECT_NE(rules.find("\nKERNEL==\"cpu_dma_latency\", GROUP=\"haptics\""), std::string::npos);
}

TEST_F(Deploy, NoRuleOpensADeviceToEverybody) {
  const std::string rules = content(kDeploy + "60-tact.rules");
  EXPECT_EQ(rules.find("0666"), std::string::npos);
  EXPECT_EQ(rules.find("TAG+=\"uaccess\""), std::string::npos);
}

TEST_F(Deploy, TheBusStaysDownAfterBusOff) {
  EXPECT_NE(content(kDeploy + "80-can0.network").find("\nRestartSec=0\n"), std::string::npos);
  EXPECT_NE(content(kDeploy + "can0.ifupdown").find("restart-ms 0"), std::string::npos);
}

TEST_F(Deploy, AnOlderDebianIsRefusedWithTheReleasesThatDo) {
  const auto checked = [this](const std::string& os) {
    std::ofstream(folder + "/os-release") << os;
    return std::system(("cmake -DTACT_OS_RELEASE=" + folder +
                        "/os-release -P " TACT_SOURCE_DIR "/tools/cmake/release.cmake >" + said +
                        " 2>&1")
                           .c_str());
  };
  EXPECT_NE(checked("ID=debian\nVERSION_ID=\"11\"\n"), 0);
  EXPECT_NE(content(said).find("This is Debian 11; tact needs Debian 12 or 13."), std::string::npos)
      << content(said);
  EXPECT_EQ(checked("ID=debian\nVERSION_ID=\"13\"\n"), 0) << content(said);
  EXPECT_EQ(checked("ID=debian\n"), 0) << "testing has no number: " << content(said);
  EXPECT_EQ(checked("ID=arch\nVERSION_ID=1\n"), 0) << content(said);
}

constexpr std::array kUnits{"tactd@.service", "tact-awake@.service", "tact-view.service",
                            "tact-metrics.service"};

TEST_F(Deploy, NoUnitArms) {
  for (const char* unit : kUnits) {
    std::istringstream lines(content(kDeploy + unit));
    int starts = 0;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("Exec")) continue;
      if (line.starts_with("ExecStart=")) ++starts;
      EXPECT_EQ(line.find("arm"), std::string::npos) << line;
      EXPECT_EQ(line.find("tactctl"), std::string::npos) << line;
      EXPECT_EQ(line.find("kill"), std::string::npos) << line;
    }
    EXPECT_EQ(starts, 1) << unit;
  }
}

std::string value_in(const std::string& unit, const std::string& key) {
  std::istringstream lines(content(kDeploy + unit));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with(key + "=")) return line.substr(key.size() + 1);
  return "";
}

// The socket of tactctl believes the user of tactd.
TEST_F(Deploy, TheViewerIsNotTheUserOfTheController) {
  const std::string controller = value_in("tactd@.service", "User");
  const std::string viewer = value_in("tact-view.service", "User");
  EXPECT_NE(viewer, controller);
  EXPECT_NE(content(kDeploy + "tact.sysusers").find("\nu " + controller + " "), std::string::npos);
  const std::string users = content(kDeploy + "tact-view.sysusers");
  EXPECT_NE(users.find("\nu " + viewer + " "), std::string::npos);
  EXPECT_NE(users.find("\nm " + viewer + " haptics\n"), std::string::npos);
  EXPECT_TRUE(value_in("tactd@.service", "ExecStart").ends_with(" --viewers haptics"));
  EXPECT_TRUE(value_in("tact-view.service", "ExecStart").ends_with(" --tactd-user " + controller));
  EXPECT_EQ(value_in("tactd@.service", "RuntimeDirectoryMode"), "0750");
  EXPECT_EQ(value_in("tact-view.service", "RuntimeDirectory"), "") << "it would become its owner's";
  EXPECT_EQ(value_in("tact-view.service", "PrivateDevices"), "yes") << "haptics may use devices";
}

TEST_F(Deploy, APcDoesNotSuspendWhileTheControllerRuns) {
  EXPECT_EQ(value_in("tactd@.service", "Wants"), "tact-awake@%i.service");
  EXPECT_EQ(value_in("tact-awake@.service", "BindsTo"), "tactd@%i.service") << "ends with it";
  EXPECT_EQ(value_in("tact-awake@.service", "After"), "tactd@%i.service");
  EXPECT_NE(value_in("tact-awake@.service", "ExecStart").find("systemd-inhibit --what=sleep "),
            std::string::npos);
}

// What the loop needs in a sandbox; where it is missing, tactd reports "no hard real time" alone.
TEST_F(Deploy, TheUnitLetsTheLoopBeHardRealTime) {
  const std::string unit = content(kDeploy + "tactd@.service");
  for (const char* line :
       {"LimitRTPRIO=85", "LimitMEMLOCK=infinity", "DeviceAllow=/dev/cpu_dma_latency rw",
        "SystemCallFilter=@system-service seccomp", "KillMode=mixed", "ExecStopPost=sleep 0.5",
        "SystemCallFilter=adjtimex clock_adjtime", "Type=notify", "CapabilityBoundingSet="})
    EXPECT_NE(unit.find("\n" + std::string(line) + "\n"), std::string::npos) << line;
  EXPECT_EQ(unit.find("\nRestrictRealtime=yes"), std::string::npos);
  EXPECT_EQ(unit.find("\nProtectClock=yes"), std::string::npos) << "adjtimex would be refused";
}

TEST_F(Deploy, AUnitIsExposedToNoMoreThanTwoOfTen) {
  if (std::system("command -v systemd-analyze >/dev/null") != 0) GTEST_SKIP() << "no systemd";
  for (const char* unit : kUnits) {
    const std::string command =
        "systemd-analyze security --offline=true --no-pager --threshold=20 " + kDeploy + unit +
        " >" + said + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << content(said);
    EXPECT_NE(content(said).find("Overall exposure level"), std::string::npos);
  }
}

// The parameters that tact-doctor advises (firmware_pc_test): the last core is the loop's.
TEST_F(Deploy, TheKernelKeepsTheLastCoreOfEachPc) {
  EXPECT_EQ(kernel_line("0-3"),
            "quiet isolcpus=domain,managed_irq,3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2\n");
  EXPECT_EQ(kernel_line("0-1"),
            "quiet isolcpus=domain,managed_irq,1 nohz_full=1 rcu_nocbs=1 irqaffinity=0\n");
  EXPECT_EQ(kernel_line("0-3", "quiet", "2"),
            "quiet isolcpus=domain,managed_irq,2 nohz_full=2 rcu_nocbs=2 irqaffinity=0-1,3-3\n");
  EXPECT_EQ(kernel_line("0"), "quiet\n") << "one core is not shared out";
  EXPECT_EQ(kernel_line("0-3", "isolcpus=1"), "isolcpus=1\n") << "another file has decided";
}

// Its commands on a small PC of files: the paths of /proc and /sys are the only change.
TEST_F(Deploy, TheUnitSetsTheGovernorAndMovesTheInterrupts) {
  const std::string cpus = folder + "/sys/devices/system/cpu/";
  const auto put = [](const std::string& path, const std::string& text) {
    fs::create_directories(fs::path(path).parent_path());
    std::ofstream(path) << text;
  };
  std::istringstream lines(content(kDeploy + "rt/tact-rt.service"));
  std::string script;
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with("ExecStart=")) script += line.substr(10) + "\n";
  for (const auto& [from, to] : {std::pair<std::string, std::string>{"$$", "$"},
                                 {"/sys/devices", folder + "/sys/devices"},
                                 {"/proc/irq", folder + "/proc/irq"}})
    for (std::size_t at = 0; (at = script.find(from, at)) != std::string::npos; at += to.size())
      script.replace(at, from.size(), to);
  put(folder + "/script", script);
  for (const char* core : {"cpu0", "cpu1", "cpu2"}) fs::create_directories(cpus + core);
  put(cpus + "cpu3/cpufreq/scaling_governor", "powersave\n");
  put(cpus + "online", "0-3\n");
  const std::string affinity = folder + "/proc/irq/36/smp_affinity_list";
  put(affinity, "0-3\n");
  for (const auto& [isolated, core, others] :
       {std::tuple{"\n", "", "0,1,2\n"}, {"1\n", "", "0,2,3\n"}, {"1\n", "0", "1,2,3\n"}}) {
    put(cpus + "isolated", isolated);
    const auto ended =
        run_command("TACT_CORE=" + std::string(core) + " sh -eu " + folder + "/script");
    EXPECT_EQ(ended.status, 0) << ended.output;
    EXPECT_EQ(content(affinity), others);
  }
  EXPECT_EQ(content(cpus + "cpu3/cpufreq/scaling_governor"), "performance\n");
}

// tactd-device.conf by systemctl itself, in a folder.
TEST_F(Deploy, AServiceThatFollowsItsDeviceIsWantedByItAlone) {
  if (run_command("command -v systemctl").status != 0) GTEST_SKIP() << "no systemd";
  const std::string units = folder + "/etc/systemd/system/";
  const std::string wants = units + "tact-falcon.device.wants/tactd@liver.service";
  fs::create_directories(units + "tactd@liver.service.d");
  fs::copy(kDeploy + "tactd@.service", units);
  const std::string text = content(kDeploy + "tactd-device.conf");
  for (const char* line : {"BindsTo=", "After=", "WantedBy="})
    EXPECT_NE(text.find("\n" + std::string(line) + "sys-subsystem-net-devices-can0.device\n"),
              std::string::npos)
        << line;
  ASSERT_EQ(run_command("sed 's/=sys-.*/=tact-falcon.device/' " + kDeploy + "tactd-device.conf >" +
                        units + "tactd@liver.service.d/device.conf")
                .status,
            0);
  const auto systemctl = [this](const std::string& word) {
    return run_command("systemctl --root=" + folder + " " + word + " tactd@liver");
  };
  const auto enabled = systemctl("enable");
  EXPECT_EQ(enabled.status, 0) << enabled.output;
  EXPECT_TRUE(fs::is_symlink(wants)) << enabled.output;
  EXPECT_FALSE(fs::exists(units + "multi-user.target.wants")) << "it would wait for it at boot";
  EXPECT_EQ(systemctl("disable").status, 0);
  EXPECT_FALSE(fs::is_symlink(wants));
}

// "/tact/falcon" of a rule is tact-falcon.device; each is named in the drop-in that a person edits.
TEST_F(Deploy, EveryUsbDeviceCanBeFollowed) {
  std::istringstream rules(content(kDeploy + "60-tact.rules"));
  std::string followed;
  for (std::string line; std::getline(rules, line);) {
    const auto alias = line.find("ENV{SYSTEMD_ALIAS}+=\"/tact/");
    if (alias == std::string::npos) continue;
    EXPECT_NE(line.find("TAG+=\"systemd\""), std::string::npos) << line;
    EXPECT_NE(line.find("ENV{DEVTYPE}==\"usb_device\""), std::string::npos) << line;
    const std::string name = line.substr(alias + 27, line.rfind('"') - alias - 27);
    EXPECT_NE(content(kDeploy + "tactd-device.conf").find("tact-" + name + ".device"),
              std::string::npos)
        << name;
    const auto ids = line.find("ATTR{idVendor}");
    followed += line.substr(ids, line.find(", TAG") - ids) + "\n";
  }
  EXPECT_EQ(followed,
            "ATTR{idVendor}==\"0403\", ATTR{idProduct}==\"cb48\"\nATTR{idVendor}==\"1451\"\n"
            "ATTR{idVendor}==\"2988\"\nATTR{idVendor}==\"0301\", ATTR{idProduct}==\"2988\"\n");
}

}  // namespace
