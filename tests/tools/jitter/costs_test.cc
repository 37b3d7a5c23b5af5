// SPDX-License-Identifier: Apache-2.0
// What the kernel counts of the loop's core and thread, read from files that a test has written.
#include "tools/jitter/statistics/costs.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/jitter/trace/marker.h"
#include "tools/program/run_program.h"

namespace tact::tools::jitter::costs_test {

namespace fs = std::filesystem;

class FilesOfAPc : public testing::Test {
 protected:
  FilesOfAPc() : scratch(std::move(*program::ScratchFolder::make("tact-costs"))) {}
  void put(const std::string& path, const std::string& text) const {
    fs::create_directories(fs::path(scratch.path() + path).parent_path());
    std::ofstream(scratch.path() + path) << text;
  }
  void put_counters(int irq, int local, int steal, const std::string& task) const {
    put("/proc/interrupts", "           CPU0       CPU2\n 24:  7  " + std::to_string(irq) +
                                "  PCI-MSIX 0-edge      eth0\nLOC:  9  " + std::to_string(local) +
                                "   Local timer interrupts\nERR:  3\n");
    put("/proc/stat", "cpu 0\ncpu2 1 2 3 4 5 6 7 " + std::to_string(steal) + " 0 0\n");
    put("/proc/self/task/5/stat", "5 (tact (l) oop) S 1 2 3 4 5 6 " + task + " 0 0\n");
    put("/proc/self/task/5/schedstat", "100 " + task.substr(0, 1) + "000 3\n");
    put("/proc/self/task/5/sched", "se.nr_migrations           :      " + task.substr(0, 1) + "\n");
    put("/proc/self/task/5/status",
        "voluntary_ctxt_switches:\t10\nnonvoluntary_ctxt_switches:\t" + task.substr(0, 1) + "\n");
  }
  program::ScratchFolder scratch;
};

TEST_F(FilesOfAPc, CostsAreThoseOfTheLoopsCoreAndThread) {
  const firmware::pc::PcFiles files(scratch.path());
  put_counters(100, 50, 4, "1 0 2 0");
  const Costs before = read_costs(files, 5, 2);
  put_counters(103, 50, 6, "5 0 9 0");
  const Costs delta = read_costs(files, 5, 2) - before;
  EXPECT_EQ(delta.interrupts, (std::map<std::string, std::uint64_t>{{"24 eth0", 3}}));
  EXPECT_EQ(delta.minor_faults, 4u);
  EXPECT_EQ(delta.major_faults, 7u);
  EXPECT_EQ(delta.voluntary_switches, 0u);
  EXPECT_EQ(delta.involuntary_switches, 4u);
  EXPECT_EQ(delta.migrations, 4u);
  EXPECT_EQ(delta.waited_ns, 4000u);
  EXPECT_EQ(delta.steal_ms, 2000u / static_cast<std::uint64_t>(sysconf(_SC_CLK_TCK)));
  EXPECT_FALSE(delta.smi) << "there is no such file";
  EXPECT_EQ(to_json(delta)["smi"], nullptr);
  const std::string words = describe(delta);
  EXPECT_NE(words.find("interrupts 24 eth0 3"), std::string::npos) << words;
  EXPECT_NE(words.find("4 us"), std::string::npos) << words;
}

TEST_F(FilesOfAPc, SystemManagementInterruptsAreThoseOfTheLoopsCore) {
  const firmware::pc::PcFiles files(scratch.path());
  const auto put_msr = [this](int core, std::uint64_t count) {
    std::string registers(0x34, '\x7f');
    registers.append(reinterpret_cast<const char*>(&count), sizeof count);
    put("/dev/cpu/" + std::to_string(core) + "/msr", registers + "beyond");
  };
  put_counters(100, 50, 4, "1 0 2 0");
  const Costs without = read_costs(files, 5, 2);
  put_msr(1, 900);
  put_msr(2, 40);
  const Costs before = read_costs(files, 5, 2);
  put_msr(1, 950);
  put_msr(2, 43);
  const Costs after = read_costs(files, 5, 2);
  EXPECT_EQ((after - before).smi, 3u);
  EXPECT_EQ(to_json(after - before)["smi"], 3);
  EXPECT_NE(describe(after - before).find("3 SMI"), std::string::npos);
  EXPECT_FALSE((after - without).smi) << "no count before, no difference";
  EXPECT_EQ(describe(before - before).find("SMI"), std::string::npos);
  put("/dev/cpu/2/msr", "short");
  EXPECT_FALSE(read_costs(files, 5, 2).smi);
}

TEST_F(FilesOfAPc, AMarkerIsWrittenOnceTracefsIsThereAndMayEndTheRecording) {
  EXPECT_FALSE(TraceMarker(firmware::pc::PcFiles(scratch.path()), true).is_open());
  put("/sys/kernel/tracing/trace_marker", "");
  put("/sys/kernel/tracing/tracing_on", "1");
  TraceMarker marker(firmware::pc::PcFiles(scratch.path()), true);
  ASSERT_TRUE(marker.is_open());
  marker.write("tick 7");
  std::string on, line;
  std::getline(std::ifstream(scratch.path() + "/sys/kernel/tracing/tracing_on"), on);
  std::getline(std::ifstream(scratch.path() + "/sys/kernel/tracing/trace_marker"), line);
  EXPECT_EQ(on, "0");
  EXPECT_EQ(line, "tick 7");
}

}  // namespace tact::tools::jitter::costs_test
