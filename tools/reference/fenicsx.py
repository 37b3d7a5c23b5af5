# SPDX-License-Identifier: Apache-2.0
"""The whole tool pressed into a neo-Hookean body, solved by FEniCSx (dolfinx 0.5; Debian: python3-dolfinx-real).

The displacement u, quadratic on tetrahedra with straight edges, makes this energy stationary:

    W = int  G/2 (J^(-2/3) tr F'F - 3) + K/2 (J - 1)^2  dV  +  sum_s int  k P(R_s - |X + u - c_s|)  dA
    P(g) = 0 for g <= 0,  g^3 / (6 w) to w,  then g^2 / 2 - w g / 2 + w^2 / 6

F = I + grad u, J = det F, G = E / (2 (1 + nu)), K = E / (3 (1 - 2 nu)); c_s, R_s centre and radius of a sphere, rigid and without
friction; k its penalty per area of the resting surface, w where its pressure becomes straight. The force on a sphere is -dW/dc_s.
Nothing is shared with CalculiX but the mesh: no element, no contact search, no program. mm, kPa, mN.

Newton's method with MUMPS; the next step begins where the last two point. A step without solution is halved.
Source: P. Wriggers, Computational Contact Mechanics, Springer 2006, 6.3.
"""
import re

import numpy as np

from run import Code, Failure

MM, KPA, NEWTON = 1e3, 1e-3, 1e-3  # of m and of Pa; of mN
PENALTY = 500.0  # of E / R: sinks in by 1e-3 of R and less
SOFT = 1e-3  # w, of R: with a kink Newton's method turns in circles
FIRST_STEP, STEP, LEAST_STEP = 0.05, 0.15, 2e-3  # of R
STEPS_OF_NEWTON, GOOD = 15, 1e-4  # of the force
REACH = 2.0  # of R beyond the deepest press: faces that may be in contact
BODY_DEGREE, SKIN_DEGREE = 3, 4  # of the rules of integration


def version():
    """ "0.5.2", of dolfinx."""
    try:
        import dolfinx
    except ImportError:
        raise Failure("FEniCSx is not installed; apt install python3-dolfinx python3-dolfinx-real") from None
    return dolfinx.__version__


def body_energy(ufl, u, shear, bulk):
    f = ufl.Identity(3) + ufl.grad(u)
    j = ufl.det(f)
    dx = ufl.Measure("dx", metadata={"quadrature_degree": BODY_DEGREE})
    return (0.5 * shear * (j**(-2.0 / 3.0) * ufl.inner(f, f) - 3.0) + 0.5 * bulk * (j - 1.0)**2) * dx


def contact_energy(ufl, inside, soft):
    """Energy and pressure of a penalty of one, where a sphere reaches so far beyond the surface."""
    def by_depth(deep, shallow):
        return ufl.conditional(ufl.gt(inside, soft), deep, ufl.conditional(ufl.gt(inside, 0.0), shallow, 0.0))

    return (by_depth(0.5 * inside**2 - 0.5 * soft * inside + soft**2 / 6.0, inside**3 / (6.0 * soft)),
            by_depth(inside - 0.5 * soft, inside**2 / (2.0 * soft)))


def compiled(dolfinx, form):
    """dolfinx keeps what it has compiled, and a lock beside it."""
    try:
        return dolfinx.fem.form(form)
    except TimeoutError as locked:
        file = re.search(r"remove (\S+\.c)", str(locked))
        raise Failure("another press compiles the same equations for FEniCSx, or one was stopped while it did: wait, or remove "
                      f"{file[1] if file else '~/.cache/fenics'}") from None


class Problem:
    """The energy's slope and curvature of a body under a tool."""

    def __init__(self, organ, body, what):
        import dolfinx
        import ufl
        from mpi4py import MPI
        from petsc4py import PETSc

        self.fem, self.petsc, self.what = dolfinx.fem, PETSc, what
        self.radius_mm, self.way = np.array(what.radius_m) * MM, np.array(what.direction)
        domain = ufl.Mesh(ufl.VectorElement("Lagrange", "tetrahedron", 1))
        used, corners = np.unique(body.element[:, :4], return_inverse=True)
        mesh = dolfinx.mesh.create_mesh(MPI.COMM_SELF, corners.reshape(-1, 4), body.node_m[used] * MM, domain)
        space = dolfinx.fem.VectorFunctionSpace(mesh, ("Lagrange", 2))
        self.u, du, v = dolfinx.fem.Function(space), ufl.TrialFunction(space), ufl.TestFunction(space)
        self.centre = [dolfinx.fem.Constant(mesh, np.zeros(3)) for _ in what.radius_m]
        # Constants, not numbers: what is compiled for one press serves all.
        shear_kPa, modulus_kPa = organ.shear_modulus_Pa * KPA, organ.youngs_modulus_Pa * KPA
        bulk_kPa = modulus_kPa / (3.0 * (1.0 - 2.0 * organ.poisson_ratio))
        shear_kPa, bulk_kPa, way = (dolfinx.fem.Constant(mesh, value) for value in (shear_kPa, bulk_kPa, self.way))
        faces = self.contact_faces(dolfinx, mesh)
        ds = ufl.Measure("ds", domain=mesh, subdomain_data=faces, metadata={"quadrature_degree": SKIN_DEGREE})(1)
        energy, pushes = body_energy(ufl, self.u, shear_kPa, bulk_kPa), []
        for centre, radius_mm in zip(self.centre, self.radius_mm):
            radius, penalty = (dolfinx.fem.Constant(mesh, x) for x in (radius_mm, PENALTY * modulus_kPa / radius_mm))
            away = ufl.SpatialCoordinate(mesh) + self.u - centre
            overlap_energy, pressure = contact_energy(ufl, radius - ufl.sqrt(ufl.inner(away, away)), SOFT * radius)
            energy += penalty * overlap_energy * ds
            pushes.append(penalty * pressure * ufl.dot(away, way) / ufl.sqrt(ufl.inner(away, away)) * ds)
        slope = ufl.derivative(energy, self.u, v)
        self.slope, self.curvature = compiled(dolfinx, slope), compiled(dolfinx, ufl.derivative(slope, self.u, du))
        self.force = [compiled(dolfinx, push) for push in pushes]
        held = dolfinx.mesh.locate_entities_boundary(mesh, 2, lambda x: organ.held(x.T / MM))
        self.held = dolfinx.fem.dirichletbc(np.zeros(3), dolfinx.fem.locate_dofs_topological(space, 2, held), space)
        self.matrix, self.residual = dolfinx.fem.petsc.create_matrix(self.curvature), dolfinx.fem.petsc.create_vector(self.slope)
        self.matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        self.matrix.setOption(PETSc.Mat.Option.SPD, True)  # MUMPS pivots less then
        self.solver = PETSc.KSP().create(MPI.COMM_SELF)
        self.solver.setOperators(self.matrix)
        self.solver.setType("preonly")
        self.solver.getPC().setType("cholesky")
        self.solver.getPC().setFactorSolverType("mumps")

    def contact_faces(self, dolfinx, mesh):
        """Tags 1 the faces near the spheres' way."""
        centre_mm = np.array(self.what.centre_m) * MM
        reach_mm = (1.0 + REACH) * self.radius_mm + self.what.depths_m[-1] * MM

        def is_near(x):
            away_mm = np.linalg.norm(x.T[:, None] - centre_mm, axis=2)
            return (away_mm <= reach_mm).any(axis=1)

        faces = np.sort(dolfinx.mesh.locate_entities_boundary(mesh, 2, is_near))
        return dolfinx.mesh.meshtags(mesh, 2, faces, np.ones(len(faces), dtype=np.int32))

    def force_N(self):
        """Of each sphere, against the way."""
        return [float(self.fem.assemble_scalar(force)) * NEWTON for force in self.force]

    def go_to(self, depth_m):
        for centre, at_m in zip(self.centre, self.what.centre_m):
            centre.value[:] = (np.array(at_m) + depth_m * self.way) * MM

    def off(self):
        """Length of the slope of the energy, mN; what is held is left out."""
        with self.residual.localForm() as local:
            local.set(0.0)
        self.fem.petsc.assemble_vector(self.residual, self.slope)
        self.fem.petsc.set_bc(self.residual, [self.held], scale=0.0)
        return self.residual.norm()

    def newton(self):
        """True: stationary. One linear solve a step."""
        change, u, off_mN = self.residual.duplicate(), self.u.vector, self.off()
        for _ in range(STEPS_OF_NEWTON):
            if off_mN <= GOOD * max(1.0, sum(map(abs, self.force_N())) / NEWTON):
                return True
            self.matrix.zeroEntries()
            self.fem.petsc.assemble_matrix(self.matrix, self.curvature, bcs=[self.held])
            self.matrix.assemble()
            self.solver.solve(self.residual, change)
            part, before_mN = 1.0, off_mN
            u.axpy(-1.0, change)
            off_mN = self.off()
            while not off_mN < before_mN and part > 0.2:
                part *= 0.5
                u.axpy(part, change)
                off_mN = self.off()
            if not off_mN < 2.0 * before_mN:
                return False
        return False


def solve(organ, body, what):
    """The force of each sphere, N, at each depth: (depths, spheres)."""
    problem = Problem(organ, body, what)
    u, out, at_m, before = problem.u.vector, [], 0.0, None
    step_m, least_m = FIRST_STEP * min(what.radius_m), LEAST_STEP * min(what.radius_m)
    for depth_m in what.depths_m:
        while at_m < depth_m:
            # Even steps to the depth: what is left over is never a small part of one.
            to_m = at_m + (depth_m - at_m) / np.ceil((depth_m - at_m) / step_m - 1e-6)
            last = u.copy()
            if before is not None:  # goes on as it went
                u.axpy(min(2.0, (to_m - at_m) / before[1]), last - before[0])
            problem.go_to(to_m)
            if problem.newton():
                before, at_m = (last, to_m - at_m), to_m
                step_m = min(STEP * min(what.radius_m), 1.5 * step_m)
                if depth_m - at_m < least_m:
                    at_m = depth_m
            else:
                last.copy(u)
                before, step_m = None if before is None or step_m < 4 * least_m else before, 0.5 * min(step_m, to_m - at_m)
                if step_m < least_m:
                    raise Failure(f"FEniCSx found no solution beyond {at_m * 1e3:.3g} mm", Code.NO_SOLUTION)
        out.append(problem.force_N())
    return np.array(out)
