// SPDX-License-Identifier: Apache-2.0
// accuracy_file.h - how true the force of a scene's whole tool is, as tact-lab chart measured it.
//
// SCENE.accuracy, which tools/chart/tool.py writes, is next to SCENE.toml, a table for each law.
// tactd --check prints it. A figure counts for what was measured alone: the hash is of forces, so
// another law, parameter, organ or tool has another one, and another hand or device has not. A
// scene keeps its tolerance where the RMS, of the peak, and the error of the own force at every
// place and depth are within tolerance.force_error_ratio: an RMS alone hides light touch. Set-up
// code only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/result.h"
#include "model/scene/tissue_law.h"

namespace tact::model::scene {

/// How far one law is off a reference.
struct Accuracy {
  std::string law;                       // its name in a scene
  std::string law_hash;                  // hash_of_linear_forces()
  std::string reference;                 // what it was measured against, for people
  std::string date;                      // YYYY-MM-DD
  bool large_strain_off = false;         // it was measured without, and the law has it
  double rms_ratio = 0.0;                // of the peak
  double within_noticeable_ratio = 0.0;  // share of places and depths within the 7 % people notice
  std::vector<double> depth_m;           // rising
  std::vector<double> own_worst_ratio;   // of the same place and depth, at each depth
};
/// The index of depth_m at which the local force is farthest off.
std::size_t worst_depth(const Accuracy& accuracy);
bool keeps(const Accuracy& accuracy, const ToleranceSettings& tolerance);

/// A hash of the law's answers at places and depths over the organ, of how they couple, and of
/// the tool's spheres: 16 hex digits. As a linear reference evaluates it: compliance.large_strain
/// off.
Result<std::string> hash_of_linear_forces(const Scene& scene, std::string_view law_name);

/// "model/scenes/liver.accuracy"
std::string accuracy_path(const Scene& scene);
/// The figure of this scene's law. An error says that there is none, or that it is of something
/// else, and the remedy.
Result<Accuracy> read_accuracy(const Scene& scene);
/// The largest of its errors, the RMS of the peak or an own force.
double worst_error_ratio(const Accuracy& accuracy);
/// The law of the scene with a figure and the least worst error; of equal ones the
/// last, as a net of springs may be felt as `compliance` and costs more. None: no figure counts.
std::optional<Accuracy> nearest_law(const Scene& scene);

/// For people: the figure, and whether it is within the tolerance of the scene.
std::string accuracy_line(const Scene& scene);

}  // namespace tact::model::scene
