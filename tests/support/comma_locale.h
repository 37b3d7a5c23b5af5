// SPDX-License-Identifier: Apache-2.0
// comma_locale.h - a locale that writes one and a half as 1,5, made here, as few machines have one.
#pragma once

#include <gtest/gtest.h>

#include <clocale>
#include <cstdlib>
#include <fstream>
#include <locale>
#include <string>

#include "tests/support/program.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#include <sanitizer/lsan_interface.h>
#define TACT_COUNTS_LEAKS
#endif
#endif

namespace tact::tests {

/// The locale of C and of C++ as long as it lives; the test fails where it has no decimal comma.
class CommaLocale {
 public:
  /// `folder` of the test's own takes the compiled locale.
  explicit CommaLocale(const std::string& folder) {
    std::ofstream(folder + "/comma.txt")
        << "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3\nEND LC_NUMERIC\n";
    std::ofstream ascii(folder + "/ascii.txt");  // localedef has no table of its own
    ascii << "<code_set_name> ASCII\nCHARMAP\n" << std::hex << std::setfill('0');
    for (int c = 0; c < 128; ++c)
      ascii << "<U" << std::setw(4) << c << "> /x" << std::setw(2) << c << " c\n";
    ascii << "END CHARMAP\n" << std::flush;
    // It has a word about each category that is empty; what counts is what the locale does.
    const Outcome made = run_command(
        "cd " + folder + " && localedef --quiet --force -f ./ascii.txt -i comma.txt ./comma");
    setenv("LOCPATH", folder.c_str(), 1);
#ifdef TACT_COUNTS_LEAKS
    __lsan_disable();  // glibc's newlocale() loses the list that it makes of LOCPATH
#endif
    try {
      std::locale::global(std::locale("comma"));
    } catch (const std::runtime_error& error) {
      ADD_FAILURE() << error.what() << ": " << made.output;
    }
#ifdef TACT_COUNTS_LEAKS
    __lsan_enable();
#endif
    EXPECT_STREQ(std::localeconv()->decimal_point, ",") << made.output;
    EXPECT_EQ(std::strtod("1,5", nullptr), 1.5);
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::locale::global(std::locale::classic());
    unsetenv("LOCPATH");
  }
};

}  // namespace tact::tests
