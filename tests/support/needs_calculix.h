// SPDX-License-Identifier: Apache-2.0
// needs_calculix.h - a fixture for tests that solve by CalculiX, which Debian 13 does not have.
#pragma once

#include <gtest/gtest.h>

#include "tools/reference/calculix/calculix.h"

namespace tact::tests {

class NeedsCalculiX : public testing::Test {
 protected:
  void SetUp() override {
    const auto version = tools::reference::calculix_version();
    if (!version) GTEST_SKIP() << version.error().message;
  }
};

}  // namespace tact::tests
