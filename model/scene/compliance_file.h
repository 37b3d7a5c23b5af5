// SPDX-License-Identifier: Apache-2.0
// compliance_file.h - a ComplianceMap as a file: what tools/condense writes and a scene names.
//
//     "TACTCOMP"  version u32  vertices u32  rings u32  inclusions u32
//     poisson_ratio  patch_radius_m  ring_pitch_m  fixed_min_m  fixed_max_m     9 f64
//     mesh_hash   16 characters
//     r E         vertices f32
//     n1 n2 s1 s2 axis of 1    7 vertices f32
//     g_j E       vertices * rings f32
//     checksum    u64, FNV-1a of every byte before it
//
// Little endian. Set-up code only.
#pragma once

#include <cstdint>
#include <string>

#include "model/contact/surface.h"
#include "model/result.h"
#include "model/scene/law_settings.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::scene {

/// Any damage is an error that says what is wrong with which file.
Result<tissue::ComplianceMap> read_compliance_map(const std::string& path);

/// The checksum that the file ends with, 8 bytes as they stand there; empty where there is none.
std::string compliance_checksum(const std::string& path);

/// A hash of [[elastic.inclusion]], their moduli as ratios to the organ's; 0: there is none.
std::uint32_t inclusions_hash(const ElasticSettings& elastic);

/// Same shape, same hash, for any position of the surface: triangles, and vertices relative to the
/// first one in steps of 0.1 um. 16 hex digits.
std::string surface_hash(const contact::SurfaceView& surface);

}  // namespace tact::model::scene
