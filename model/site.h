// site.h - the point of a surface nearest to a probe, followed from tick to tick.
#pragma once

#include "model/mesh.h"
#include "model/types.h"
