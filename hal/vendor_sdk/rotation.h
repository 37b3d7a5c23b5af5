// SPDX-License-Identifier: Apache-2.0
// rotation.h - what a vendor SDK calls an orientation, as tact's quaternion.
//
// By the largest of the four components (S. Shepperd, J. Guidance 1 (1978) 223).
#pragma once

#include "model/types.h"

namespace tact::hal::vendor_sdk {

/// R, row by row, as a unit quaternion; NaN where R is no rotation.
model::Quat quat_from_rotation(const double r[3][3]);

/// The rotation vector of q, at most half a turn. |q| = 1.
model::Vec3 rotation_vector_rad(const model::Quat& q) RT_SAFE;

}  // namespace tact::hal::vendor_sdk
