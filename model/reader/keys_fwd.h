// SPDX-License-Identifier: Apache-2.0
// keys_fwd.h - names the class Keys (scene_reader.h) for headers that pass it on.
#pragma once

namespace tact::model::reader {

class Keys;

}  // namespace tact::model::reader
