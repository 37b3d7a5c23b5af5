// SPDX-License-Identifier: Apache-2.0
// tools/deploy/: the files that let a group of people use real devices.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>

#include "hal/udev_rules.h"
#include "tests/support/files.h"

namespace {

namespace fs = std::filesystem;
using tact::tests::content;

const std::string kDeploy = TACT_SOURCE_DIR "/tools/deploy/";

/// Status of the install script; what it said goes to `said`.
int install(const std::string& arguments, const std::string& said) {
  const int ended = std::system((kDeploy + "install " + arguments + " >" + said + " 2>&1").c_str());
  return WEXITSTATUS(ended);
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
  for (const char* rule :
       {tact::hal::kFalconRule, tact::hal::kForceDimensionRule, tact::hal::kPhantomRule,
        tact::hal::kOldPhantomRule, tact::hal::kGpioRule})
    EXPECT_NE(rules.find(std::string("\n") + rule + "\n"), std::string::npos) << rule;
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
  const auto judged = [this](const std::string& os) {
    std::ofstream(folder + "/os-release") << os;
    return std::system(("cmake -DTACT_OS_RELEASE=" + folder +
                        "/os-release -P " TACT_SOURCE_DIR "/tools/cmake/release.cmake >" + said +
                        " 2>&1")
                           .c_str());
  };
  EXPECT_NE(judged("ID=debian\nVERSION_ID=\"11\"\n"), 0);
  EXPECT_NE(content(said).find("This is Debian 11; tact needs Debian 12 or 13."), std::string::npos)
      << content(said);
  EXPECT_EQ(judged("ID=debian\nVERSION_ID=\"13\"\n"), 0) << content(said);
  EXPECT_EQ(judged("ID=debian\n"), 0) << "testing has no number: " << content(said);
  EXPECT_EQ(judged("ID=arch\nVERSION_ID=1\n"), 0) << content(said);
}

TEST_F(Deploy, NoUnitArms) {
  for (const char* unit : {"tactd@.service", "tact-view.service"}) {
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

// What the loop needs in a sandbox; where it is missing, tactd tells "no hard real time" alone.
TEST_F(Deploy, TheUnitLetsTheLoopBeHardRealTime) {
  const std::string unit = content(kDeploy + "tactd@.service");
  for (const char* line :
       {"LimitRTPRIO=85", "LimitMEMLOCK=infinity", "DeviceAllow=/dev/cpu_dma_latency rw",
        "SystemCallFilter=@system-service seccomp", "KillMode=mixed", "ExecStopPost=sleep 0.5",
        "Type=notify"})
    EXPECT_NE(unit.find("\n" + std::string(line) + "\n"), std::string::npos) << line;
  EXPECT_EQ(unit.find("\nRestrictRealtime=yes"), std::string::npos);
}

TEST_F(Deploy, AUnitIsExposedToNoMoreThanTwoOfTen) {
  if (std::system("command -v systemd-analyze >/dev/null") != 0) GTEST_SKIP() << "no systemd";
  for (const char* unit : {"tactd@.service", "tact-view.service"}) {
    const std::string command =
        "systemd-analyze security --offline=true --no-pager --threshold=20 " + kDeploy + unit +
        " >" + said + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << content(said);
    EXPECT_NE(content(said).find("Overall exposure level"), std::string::npos);
  }
}

TEST_F(Deploy, InstallCopiesEveryFileOnce) {
  EXPECT_EQ(install("--can --into " + folder + "/root", said), 0) << content(said);
  for (const char* path :
       {"/etc/udev/rules.d/60-tact.rules", "/etc/security/limits.d/haptics.conf",
        "/etc/systemd/network/80-can0.network", "/etc/systemd/network/80-can0.link"})
    EXPECT_EQ(content(folder + "/root" + path),
              content(kDeploy + fs::path(path).filename().string()))
        << path;
  EXPECT_EQ(install("--can --into " + folder + "/root", said), 0);
  EXPECT_EQ(content(said).find("install -D"), std::string::npos) << "the second time nothing";
}

TEST_F(Deploy, ADryRunOnlyTalks) {
  EXPECT_EQ(install("--dry-run --into " + folder + "/root", said), 0);
  EXPECT_NE(content(said).find("60-tact.rules"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder + "/root"));
}

class DeployService : public Deploy {
 protected:
  /// Installs for a scene of this device; what it wrote, as far as it is asked for.
  void install_for(const std::string& device, int status = 0) {
    fs::create_directories(root + "/etc/tact");
    std::ofstream(root + "/etc/tact/liver.toml") << "[contact]\nkind = \"none\"\n[device]\n"
                                                 << device;
    EXPECT_EQ(install("--service liver --into " + root, said), status) << content(said);
  }
  std::string drop_in() const {
    return content(root + "/etc/systemd/system/tactd@liver.service.d/device.conf");
  }
  std::string rules() const { return content(root + "/etc/udev/rules.d/61-tactd-liver.rules"); }
  std::string root = folder + "/root";
};

TEST_F(DeployService, WaitsForTheCanInterfaceOfItsSceneAndGoesWithIt) {
  install_for("kind = \"can-moteus\"  # three of them\n[device.can]\ninterface = \"can-left\"\n");
  const std::string unit = R"(sys-subsystem-net-devices-can\x2dleft.device)";
  EXPECT_EQ(drop_in(), "[Unit]\nBindsTo=" + unit + "\nAfter=" + unit + "\n");
  EXPECT_EQ(rules(),
            "SUBSYSTEM==\"net\", KERNEL==\"can-left\", TAG+=\"systemd\", "
            "ENV{SYSTEMD_WANTS}+=\"tactd@liver.service\"\n");
  install_for("kind = \"can-odrive\"\n");
  EXPECT_NE(rules().find("KERNEL==\"can0\""), std::string::npos) << "as the scene without the key";
}

TEST_F(DeployService, ReadsBothQuotesAndRefusesALineThatItCannotRead) {
  install_for("kind = 'can-moteus'  # \"three\"\n[ device.can ]\ninterface = 'can1'\n");
  EXPECT_NE(rules().find("KERNEL==\"can1\""), std::string::npos) << rules();
  for (const char* line : {"[device.can]\ninterface = can2", "[device.can]\ninterface = \"\"",
                           "\ncan.interface = 'can2'", "\ncan = {interface = \"can2\"}"}) {
    install_for("kind = \"can-moteus\"\n" + std::string(line) + "\n", 2);
    EXPECT_NE(content(said).find("liver.toml:6: this line cannot be read here; write interface = "
                                 "\"...\" below a line [device.can]"),
              std::string::npos)
        << content(said);
  }
  EXPECT_NE(rules().find("KERNEL==\"can1\""), std::string::npos) << "nothing was written";
}

TEST_F(DeployService, TakesEffectForWhatIsPluggedInAlready) {
  for (const auto& [device, there] :
       {std::pair{"kind = \\\"falcon\\\"", "--subsystem-match=usb"},
        std::pair{"kind = \\\"can-odrive\\\"", "--subsystem-match=net --sysname-match=can0"}}) {
    if (std::system("unshare -rm mount -t tmpfs none /etc 2>/dev/null") != 0)
      GTEST_SKIP() << "no user namespaces, so no /etc of its own";
    const std::string command =
        "unshare -rm env -u SUDO_USER bash -c 'AWK=$(readlink -f $(command -v awk)) "
        "&& mount -t tmpfs none /etc && mkdir /etc/tact /etc/alternatives && "
        "ln -s $AWK /etc/alternatives/awk "
        "&& printf \"[device]\n" +
        std::string(device) + "\n\" >/etc/tact/liver.toml && " + kDeploy +
        "install --service liver --dry-run' >" + said + " 2>&1";
    EXPECT_EQ(std::system(command.c_str()), 0) << content(said);
    EXPECT_NE(content(said).find("  udevadm control --reload\n  udevadm trigger " +
                                 std::string(there) + "\n"),
              std::string::npos)
        << content(said);
  }
}

TEST_F(DeployService, IsStartedByItsUsbDevice) {
  const auto ids_of = [](const std::string& rule) {
    const auto from = rule.find("ATTR{idVendor}");
    return rule.substr(from, rule.find(", GROUP") - from);
  };
  for (const auto& [kind, rule, unit] :
       {std::tuple{"falcon", tact::hal::kFalconRule, "tact-falcon.device"},
        std::tuple{"force-dimension", tact::hal::kForceDimensionRule,
                   "tact-forcedimension.device"}}) {
    install_for("kind = \"" + std::string(kind) + "\"\n");
    EXPECT_NE(rules().find(ids_of(rule)), std::string::npos) << rules();
    EXPECT_NE(rules().find("ENV{SYSTEMD_WANTS}+=\"tactd@liver.service\""), std::string::npos);
    EXPECT_NE(drop_in().find("BindsTo=" + std::string(unit)), std::string::npos) << drop_in();
    EXPECT_NE(drop_in().find("After=" + std::string(unit)), std::string::npos);
    std::string path = unit;  // the alias is the path of that unit
    path = "/" + path.replace(path.find('-'), 1, "/").substr(0, path.find(".device"));
    EXPECT_NE(rules().find("ENV{SYSTEMD_ALIAS}+=\"" + path + "\""), std::string::npos) << rules();
  }
}

TEST_F(DeployService, APhantomOnFireWireIsNotWaitedFor) {
  install_for("kind = \"phantom\"\n");
  EXPECT_NE(rules().find("ATTR{idVendor}==\"2988\""), std::string::npos);
  EXPECT_EQ(drop_in(), "");
}

TEST_F(DeployService, WhatIsWrittenNeverArms) {
  for (const char* kind : {"can-odrive", "falcon", "force-dimension", "phantom"}) {
    install_for("kind = \"" + std::string(kind) + "\"\n");
    for (const std::string& text : {drop_in(), rules()}) {
      EXPECT_EQ(text.find("arm"), std::string::npos) << text;
      EXPECT_EQ(text.find("Exec"), std::string::npos) << text;
      EXPECT_EQ(text.find("RUN"), std::string::npos) << text;
    }
  }
}

TEST_F(DeployService, NeedsASceneThatNamesItsDevice) {
  install_for("kind = \"sim-delta\"\n");
  EXPECT_NE(content(said).find("nothing to wait for"), std::string::npos);
  EXPECT_EQ(drop_in() + rules(), "");
  install_for("", 2);
  EXPECT_NE(content(said).find("needs a line kind"), std::string::npos);
  EXPECT_EQ(install("--service ../liver --into " + root, said), 2);
  EXPECT_EQ(install("--service kidney --into " + root, said), 2);
  EXPECT_NE(content(said).find("there is no scene"), std::string::npos);
}

TEST_F(Deploy, AnUnknownOptionIsBadUsage) {
  EXPECT_EQ(install("--froce", said), 2);
  EXPECT_NE(content(said).find("--help"), std::string::npos);
  EXPECT_EQ(install("--user", said), 2);
}

TEST_F(Deploy, AnEmptyFolderOrNameIsNotThisMachine) {
  for (const char* option : {"--into", "--user"}) {
    EXPECT_EQ(install(std::string("--dry-run ") + option + " ''", said), 2);
    EXPECT_NE(content(said).find(std::string(option) + " needs a value"), std::string::npos);
  }
}

}  // namespace
