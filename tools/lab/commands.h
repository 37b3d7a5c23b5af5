// SPDX-License-Identifier: Apache-2.0
// commands.h - the subcommands of tact-lab, each in the file of its name.
#pragma once

#include "tools/program/program.h"

namespace tact::tools::lab {

void add_chart(program::Program& lab);
void add_condense(program::Program& lab);
void add_fit(program::Program& lab);
void add_new_scene(program::Program& lab);
void add_plan(program::Program& lab);
void add_reference(program::Program& lab);
void add_stability(program::Program& lab);
void add_sweep(program::Program& lab);

}  // namespace tact::tools::lab
