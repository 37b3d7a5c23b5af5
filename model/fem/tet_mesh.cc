// SPDX-License-Identifier: Apache-2.0
#include "model/fem/tet_mesh.h"

namespace tact::model::fem {

double volume_m3(const TetMesh& mesh) {
  double sum_m3 = 0.0;
  for (const TetNodes& e : mesh.element) {
    const Vec3& o = mesh.node_m[e[0]];
    const Vec3 a = mesh.node_m[e[1]] - o, b = mesh.node_m[e[2]] - o, c = mesh.node_m[e[3]] - o;
    sum_m3 += dot(a, cross(b, c)) / 6.0;
  }
  return sum_m3;
}

}  // namespace tact::model::fem
