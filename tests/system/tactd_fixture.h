// SPDX-License-Identifier: Apache-2.0
// tactd_fixture.h - tactd started from a test, with a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tests/support/program.h"
#include "tests/support/stub_dhd/stub_client.h"

namespace tact::tests {

inline const std::string kLiver = TACT_SOURCE_DIR "/model/scenes/liver.toml";

/// Options for a shell: no simulated device, so tactd starts without force, but a stand-in for one.
inline const std::string kStubDevice =
    " --no-seccomp --trust-library --set rate_Hz=250 --set limits.energy_J=0.2 --set "
    "'device.kind=\"force-dimension\"' --set 'device.force_dimension.library=\"" +
    kStubLibrary + "\"'";

class Tactd : public testing::Test {
 protected:
  void SetUp() override {
    folder = "/tmp/tactd-test-" + std::to_string(getpid());
    std::filesystem::create_directory(folder);
  }
  void TearDown() override { std::filesystem::remove_all(folder); }

  std::string in_folder(const std::string& name) const { return folder + "/" + name; }
  Outcome tactd(const std::string& arguments) const {
    return run_program("tactd", "--socket " + in_folder("t.sock") + " " + arguments);
  }
  nlohmann::json report_of(const std::string& arguments) const {
    const std::string path = in_folder("report.json");
    const Outcome outcome = tactd(arguments + " --json " + path);
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    std::ifstream file(path);
    return nlohmann::json::parse(file, nullptr, false);
  }

  std::string folder;
};

inline bool has(const Outcome& outcome, const std::string& text) {
  return outcome.output.find(text) != std::string::npos;
}

inline std::string field(const std::string& path, const std::string& name) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.rfind(name + ":", 0) == 0) return line.substr(name.size() + 1);
  return "";
}

/// The loop's thread of a running tactd, once it has slept through so many ticks; else empty.
inline std::string loop_thread(pid_t process, long ticks) {
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (int i = 0; i < 60'000; ++i, std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
    std::error_code gone;
    for (const auto& task : std::filesystem::directory_iterator(tasks, gone)) {
      const std::string status = task.path() / "status";
      const std::string slept = field(status, "voluntary_ctxt_switches");
      if (field(status, "Name") == "\ttact-loop" && !slept.empty() && std::stol(slept) > ticks)
        return task.path().filename();
    }
  }
  return "";
}

}  // namespace tact::tests
