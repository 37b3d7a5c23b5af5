// SPDX-License-Identifier: Apache-2.0
// deform.ts - moves the vertices of the organ by the contacts. Only contacts and profiles
// travel from tactd; the mesh stays here.
//
//     d(v) = fade(v) (-n (u(rho) + taper(rho) tilt . (v - p)) + s w(rho))
//
//     n, s   normal and tangential shift at the contact     rho  distance from the contact in its tangent plane
//     u      profile (profile.ts)                        w    u / u_0, the same shape
//     tilt   the organ sinks more towards a free lobe (model/tissue/indentation_tilt.h); p  the contact
//     taper  1 near the contact and 0 a reach away
//     fade   1 near the tangent plane and 0 a reach away or on a surface that faces away, so that
//            the far side of the organ stays where it is
//
// A mass-spring tissue names its displaced vertices itself (patch.ts).
// Indentations of several contacts add up, as tactd sends each sphere's own: beside the others it is smaller
// than its depth. Of their sideways shifts, which are not each its own, the larger is shown. Where
// the sum would fold the surface over, its steepest parts are spread (fold_guard.ts). Where triangles are too wide for
// the tip, or the sum is less than what presses, the surface goes below the spheres (tip_fit.ts).

import { FoldGuard } from "./fold_guard";
import type { Moved } from "./patch";
import { Profile } from "./profile";
import { TipFit } from "./tip_fit";
import { smoothstep } from "../scene/smoothstep";
import { kContactInside, type Ball, type Contact } from "../link/protocol";

/** What presses, and the triangles that it has cut: they cover nothing. */
export interface Tool {
  balls: readonly Ball[]; // by number of the contact
  cut: ReadonlySet<number>;
}

export interface Deformed {
  moved: number; // vertices that moved by more than a micrometre
  most_m: number; // largest displacement
}

const kTaperStart = 0.7; // of the reach, as the rings themselves have it
const kMaxFits = 10; // of surface to spheres, each followed by the fold guard
const kFitted_m = 1e-5;

/** u + tilt, but a tilted surface does not rise out of an indentation. */
function no_further_than_0(u_m: number, lean_m: number): number {
  return u_m < 0 ? Math.min(0, u_m + lean_m) : Math.max(0, u_m + lean_m);
}

export class Deformer {
  private readonly profile: Profile;
  private readonly guard: FoldGuard;
  private readonly tips: TipFit;
  private was_moved = false;
  /** Length of each vertex's displacement, m. */
  readonly travel_m: Float32Array;
  private readonly sideways_m: Float32Array; // largest shift so far of each vertex

  constructor(
    private readonly rest_m: Float32Array,
    private readonly rest_normal: Float32Array,
    profile_points: number,
    profile_pitch_m: number,
    triangle: Uint32Array,
  ) {
    this.guard = new FoldGuard(rest_m, triangle);
    this.tips = new TipFit(rest_m, triangle);
    this.profile = new Profile(profile_points, profile_pitch_m);
    this.travel_m = new Float32Array(rest_m.length / 3);
    this.sideways_m = new Float32Array(rest_m.length);
  }

  /** Writes moved vertices to out_m. False when it left everything as it was. */
  apply(
    contacts: readonly Contact[],
    moved: Moved | null,
    out_m: Float32Array,
    result: Deformed,
    tool: Tool = { balls: [], cut: new Set() },
  ): boolean {
    result.moved = 0;
    result.most_m = 0;
    const anything = contacts.length > 0 || (moved !== null && moved.vertex.length > 0);
    if (!anything && !this.was_moved) return false;
    out_m.set(this.rest_m);
    if (moved) this.place(moved, out_m);
    else this.press(contacts, out_m);
    for (let i = 0; i < kMaxFits && this.fit(contacts, tool, out_m) > kFitted_m; ++i) this.guard.hold(out_m);
    this.measure(out_m, result);
    this.was_moved = anything;
    return true;
  }

  private measure(out_m: Float32Array, result: Deformed): void {
    for (let i = 0; i < out_m.length; i += 3) {
      const dx = out_m[i] - this.rest_m[i];
      const dy = out_m[i + 1] - this.rest_m[i + 1];
      const dz = out_m[i + 2] - this.rest_m[i + 2];
      const travel_m = Math.sqrt(dx * dx + dy * dy + dz * dz);
      this.travel_m[i / 3] = travel_m;
      if (travel_m > 1e-6) ++result.moved;
      if (travel_m > result.most_m) result.most_m = travel_m;
    }
  }

  private place(moved: Moved, out_m: Float32Array): void {
    for (let i = 0; i < moved.vertex.length; ++i) {
      const v = moved.vertex[i];
      if (v >= this.travel_m.length) continue;
      const [dx, dy, dz] = moved.displacement_m.subarray(3 * i, 3 * i + 3);
      out_m[3 * v] += dx;
      out_m[3 * v + 1] += dy;
      out_m[3 * v + 2] += dz;
    }
  }

  private press(contacts: readonly Contact[], out_m: Float32Array): void {
    this.sideways_m.fill(0);
    for (const contact of contacts) this.indent(contact, out_m);
    for (let i = 0; i < out_m.length; ++i) out_m[i] += this.sideways_m[i];
    this.guard.hold(out_m);
  }

  /** Below each sphere that presses. Returns by how much the surface went down at most, m. */
  private fit(contacts: readonly Contact[], { balls, cut }: Tool, out_m: Float32Array): number {
    if (balls.length === 0) return 0;
    const moved = this.guard.find_moved(out_m);
    const triangles = cut.size > 0 ? moved.filter((t) => !cut.has(t)) : moved;
    let most_m = 0;
    for (const { contact, state, depth_m, normal } of contacts) {
      const ball = balls[contact];
      if (!ball || state === kContactInside || !(depth_m > 0)) continue;
      most_m = Math.max(most_m, this.tips.sink(ball, normal, depth_m, triangles, out_m));
    }
    return most_m;
  }

  /** d = -n u, added; s w, where it is the largest. */
  private indent(contact: Contact, out_m: Float32Array): void {
    this.profile.set(contact.profile_m);
    const reach_m = this.profile.reach_m;
    const [px, py, pz] = contact.surface_point_m;
    const [nx, ny, nz] = contact.normal;
    const [tx, ty, tz] = contact.tilt;
    const u0_m = contact.profile_m[0] ?? 0;
    const per_u0 = Math.abs(u0_m) > 1e-9 ? 1 / u0_m : 0;
    for (let i = 0; i < this.rest_m.length; i += 3) {
      const x = this.rest_m[i] - px;
      const y = this.rest_m[i + 1] - py;
      const z = this.rest_m[i + 2] - pz;
      const height_m = x * nx + y * ny + z * nz;
      if (Math.abs(height_m) >= reach_m) continue;
      const rho_m = Math.sqrt(Math.max(0, x * x + y * y + z * z - height_m * height_m));
      if (rho_m >= reach_m) continue;
      const facing = this.rest_normal[i] * nx + this.rest_normal[i + 1] * ny + this.rest_normal[i + 2] * nz;
      const fade = (1 - smoothstep(0.4 * reach_m, reach_m, Math.abs(height_m))) * smoothstep(-0.4, 0.2, facing);
      const mean_m = this.profile.at(rho_m) * fade;
      const lean_m = fade * (1 - smoothstep(kTaperStart * reach_m, reach_m, rho_m)) * (x * tx + y * ty + z * tz);
      const u_m = no_further_than_0(mean_m, lean_m);
      const w = mean_m * per_u0;
      if (!Number.isFinite(u_m)) continue;
      out_m[i] -= nx * u_m;
      out_m[i + 1] -= ny * u_m;
      out_m[i + 2] -= nz * u_m;
      const sx = contact.shift_m[0] * w;
      const sy = contact.shift_m[1] * w;
      const sz = contact.shift_m[2] * w;
      const side = this.sideways_m;
      const before = side[i] * side[i] + side[i + 1] * side[i + 1] + side[i + 2] * side[i + 2];
      if (!(sx * sx + sy * sy + sz * sz > before)) continue;
      side[i] = sx;
      side[i + 1] = sy;
      side[i + 2] = sz;
    }
  }
}
