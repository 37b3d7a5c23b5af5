// SPDX-License-Identifier: Apache-2.0
// tools/deploy/: the files that let a group of people use real devices.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "hal/udev_rules.h"

namespace {

namespace fs = std::filesystem;

const std::string kDeploy = TACT_SOURCE_DIR "/tools/deploy/";

std::string content(const std::string& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

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
       {tact::hal::kFalconRule, tact::hal::kForceDimensionRule, tact::hal::kGpioRule})
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

TEST_F(Deploy, AnUnknownOptionIsBadUsage) {
  EXPECT_EQ(install("--froce", said), 2);
  EXPECT_NE(content(said).find("--help"), std::string::npos);
  EXPECT_EQ(install("--user", said), 2);
}

}  // namespace
