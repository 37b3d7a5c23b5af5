// SPDX-License-Identifier: Apache-2.0
// tools/image: what it refuses, and the scene of a real device. tests/image boots it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <tuple>

#include "tests/support/program.h"

namespace tact::tools::deploy::image_test {

namespace fs = std::filesystem;
using tests::Outcome;
using tests::run_command;

const std::string kSource = TACT_SOURCE_DIR;

TEST(Image, RefusesWhatItCannotMake) {
  for (const auto& [words, message] :
       {std::pair<std::string, std::string>{"--release 11", "tools/releases has no Debian 11"},
        {"--device odrive", "no device odrive; one of: sim-delta can-odrive"},
        {"--out ''", "--out needs a value"},
        {"--out /dev/null", "/dev/null is no file"},
        {"--froce", "unknown option --froce"}}) {
    const Outcome outcome = run_command(kSource + "/tools/image " + words);
    EXPECT_EQ(outcome.status, 2) << words;
    EXPECT_NE(outcome.output.find(message), std::string::npos) << outcome.output;
  }
}

// tactd finds nothing wrong in it, but that no such device is plugged in.
TEST(Image, TheSceneOfARealDeviceHasItsExampleKeys) {
  const std::string folder = testing::TempDir() + "tact-image-" + std::to_string(getpid());
  for (const auto& [device, section, missing] :
       {std::tuple<std::string, std::string, std::string>{"can-odrive", "can",
                                                          "no network interface"},
        {"can-cia402", "delta", "no network interface"},
        {"can-moteus", "can", "no network interface"},
        {"falcon", "falcon", "no Novint Falcon"},
        {"force-dimension", "force_dimension", "library cannot be loaded"},
        {"phantom", "phantom", "library cannot be loaded"}}) {
    fs::remove_all(folder);
    fs::create_directories(folder);
    fs::copy(kSource + "/model/scenes", folder, fs::copy_options::recursive);
    const Outcome written =
        run_command("bash -euc 'root=" + kSource + " work=" + folder + " device=" + device +
                    "; . $root/tools/deploy/image/system.sh; choose_device $work/liver.toml'");
    EXPECT_EQ(written.status, 0) << written.output;
    std::ifstream file(folder + "/liver.toml");
    std::stringstream scene;
    scene << file.rdbuf();
    EXPECT_NE(scene.str().find("\nkind = \"" + device + "\""), std::string::npos) << scene.str();
    EXPECT_NE(scene.str().find("\n[device." + section + "]\n"), std::string::npos) << device;
    EXPECT_EQ(scene.str().find("[device.sim]"), std::string::npos) << device;
    const Outcome checked = tests::run_program("tactd", folder + "/liver.toml --check");
    EXPECT_NE(checked.output.find(missing), std::string::npos) << device << ": " << checked.output;
  }
  fs::remove_all(folder);
}

}  // namespace tact::tools::deploy::image_test
