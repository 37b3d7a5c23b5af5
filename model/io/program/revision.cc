// SPDX-License-Identifier: Apache-2.0
// revision.cc - what built this, apart from what is slow to compile: it is new with every commit.
#include "model/io/program/command_line.h"

namespace tact::model::io {

const char* tact_version() { return TACT_VERSION; }

const char* source_revision() { return TACT_GIT_REVISION; }

const char* compiler_version() { return __VERSION__; }

}  // namespace tact::model::io
