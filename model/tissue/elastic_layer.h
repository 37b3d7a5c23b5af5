// SPDX-License-Identifier: Apache-2.0
// elastic_layer.h - the compliance of a wide flat layer that is bonded to a rigid support, in
// closed form: a map where none was condensed.
//
//     LY-1   phi(s) = (2 k sinh 2s - 4s) / D,   psi(s) = (2 k sinh 2s + 4s) / D
//            D = 2 k cosh 2s + 1 + k^2 + 4 s^2,   k = 3 - 4 nu
//     LY-2   g(rho) E = (1 - nu^2) / (pi h)  integral of (phi(s) - 1) J_0(s rho / h) ds,   r = g(0)
//     LY-3   s1 E = s2 E = (1 + nu) / (2 pi h) ((1 - nu) integral of (psi(s) - 1) ds - ln 2)
//
//     phi, psi  normal and sideways motion of the layer over that of a half-space under a load of
//               wave number s / h     h  thickness, m     rho  distance from the force, m
//     r, g, s1, s2 as in compliance_map.h
//
// A point force by Hankel's transform [Burmister, J. Appl. Phys. 16 (1945) 89]. LY-2 is within 1 %
// of the constant of Dimitriadis et al., Biophys. J. 82 (2002) 2798, eq. 15. The organ's edges and
// the slope of its underside are not known here.
#pragma once

#include "model/contact/surface.h"
#include "model/tissue/compliance_map.h"

namespace tact::model::tissue {

struct ElasticLayer {
  double thickness_m = 0.0;    // h, > 0
  double poisson_ratio = 0.0;  // nu, 0 to 0.5
};

/// The same at each vertex; ring_pitch_m > 0. mesh_hash and the held box stay empty.
ComplianceMap layer_map(const ElasticLayer& layer, const contact::SurfaceView& surface,
                        double ring_pitch_m);

}  // namespace tact::model::tissue
