// SPDX-License-Identifier: Apache-2.0
// The programs that read the bytes of others are built as Debian builds such programs.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/program.h"

namespace tact::tests::hardening_test {

TEST(Hardening, ProgramsAreRelocatableAndBoundBeforeMain) {
  for (const char* program : {"tactd", "tactctl", "tact-view"}) {
    const std::string read = run_command("readelf -hldW " + program_path(program)).output;
    EXPECT_NE(read.find("DYN (Position-Independent"), std::string::npos) << program;
    EXPECT_NE(read.find("GNU_RELRO"), std::string::npos) << program;
    EXPECT_NE(read.find(" NOW"), std::string::npos) << program;
  }
}

int guards_in(const std::string& library) {
  return std::atoi(run_command("nm $(find " TACT_BINARY_DIR " -maxdepth 2 -name " + library +
                               ") | grep -c __stack_chk_fail")
                       .output.c_str());
}

TEST(Hardening, NetworkCodeHasStackGuardsAndCheckedCopies) {
  for (const char* library : {"libtact_host_server.a", "libtact_host_igtl.a",
                              "libtact_firmware_protocol.a", "libtact_model_io.a"})
    EXPECT_GT(guards_in(library), 0) << library;
  EXPECT_NE(run_command("nm -D " + program_path("tact-view") + " | grep -c _chk@").output, "0\n");
}

TEST(Hardening, LoopAndGateCodeHasNoStackGuards) {
  for (const char* library : {"libtact_firmware_loop.a", "libtact_firmware_gate.a"})
    EXPECT_EQ(guards_in(library), 0) << library;
}

}  // namespace tact::tests::hardening_test
