// SPDX-License-Identifier: Apache-2.0
// What bash offers after the script that a program makes of its own options.
#include "model/io/program/completion.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "tests/support/program.h"

namespace tact::model::io::completion_test {

class Completion : public testing::Test {
 protected:
  Completion() : script(testing::TempDir() + "tact-completion-" + std::to_string(getpid())) {
    app.add_option("SCENE", scene, "a file");
    app.add_option("WORD", word, "")->check(CLI::IsMember({"arm", "reset"}));
    app.add_option("--load,-l", load, "")->check(CLI::IsMember({"cpu", "disk"}));
    app.add_option("--out", out, "");
    app.add_flag("--once", once, "");
    app.add_subcommand("compare", "")->add_flag("--gate", gate, "");
    std::ofstream(script) << bash_completion(app, "tact-some");
  }
  ~Completion() override { unlink(script.c_str()); }

  /// What bash offers for the last of these words, in its order.
  std::string offers(const std::string& words) const {
    return tests::run_command("bash -euc 'source " + script + "; " + "COMP_WORDS=(tact-some " +
                              words +
                              "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _tact_some; "
                              "echo \"${COMPREPLY[*]}\"'")
        .output;
  }
  CLI::App app;
  std::string scene, word, load, out, script;
  bool once = false, gate = false;
};

TEST_F(Completion, OffersTheOptionsThatBeginSo) {
  EXPECT_EQ(offers("--o"), "--out --once\n");
  EXPECT_EQ(offers("x.toml --ga"), "\n") << "of a subcommand alone";
  EXPECT_EQ(offers("--none"), "\n");
}

TEST_F(Completion, OffersTheValuesThatAnOptionTakes) {
  EXPECT_EQ(offers("--load d"), "disk\n");
  EXPECT_EQ(offers("-l c"), "cpu\n");
  EXPECT_EQ(offers("--out c"), "\n") << "a file";
}

TEST_F(Completion, OffersWordsAndSubcommandsElsewhere) {
  EXPECT_EQ(offers("x.toml re"), "reset\n");
  EXPECT_EQ(offers("c"), "compare\n");
  EXPECT_EQ(offers("--once a"), "arm\n") << "a flag takes no value";
}

TEST_F(Completion, OffersOfASubcommandItsOwnOptions) {
  EXPECT_EQ(offers("compare --"), "--help --gate\n");
  EXPECT_EQ(offers("compare re"), "\n");
}

}  // namespace tact::model::io::completion_test
