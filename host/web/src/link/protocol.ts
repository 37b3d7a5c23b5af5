// SPDX-License-Identifier: Apache-2.0
// protocol.ts - what tact-view sends, with its units in the names. Vectors are [x, y, z] in frame W:
// +x towards the operator, +y to the right, +z up.

import type { FrameFields, Scene, ContactFields, Vec } from "./records";

export type { Scene, Vec } from "./records";

export type Sphere = Scene["spheres"][number];

export const kContactInside = 3;

/** A probe sphere in contact, or inside the organ. */
export interface Contact extends ContactFields {
  contact: number;
}

/** Of a law without profiles: vertices that are not at rest, and cut triangles. */
export interface Patch {
  count: number;
  moved: string; // base64, see patch.ts
  cut_total: number; // so far
  cut: number[]; // some of them
}

export interface Frame extends FrameFields {
  kind: "frame";
  contacts: Contact[];
  patch?: Patch;
}

/** A sphere of the tool where it is now. */
export interface Ball {
  centre_m: Vec;
  radius_m: number;
}

/** c = p + R offset, each. */
export function balls_of({ tool_position_m: p, tool_orientation }: Frame, spheres: readonly Sphere[]): Ball[] {
  const [w, x, y, z] = tool_orientation;
  return spheres.map(({ radius_m, offset_m: o }) => {
    // R o = o + 2 w (q x o) + 2 q x (q x o)
    const u = cross([x, y, z], o);
    const v = cross([x, y, z], u);
    return { radius_m, centre_m: [0, 1, 2].map((i) => p[i] + o[i] + 2 * (w * u[i] + v[i])) as Vec };
  });
}

/** Since the loop started. */
export function time_s_of(frame: Frame): number {
  return frame.time_ns * 1e-9;
}

const kLongestGap_s = 1;

/** A recording that was sought, or another run: what was true before is not of this time. */
export function is_jump(before_s: number, now_s: number): boolean {
  return now_s < before_s || now_s > before_s + kLongestGap_s;
}

/** A round cone between two joints of the operator's figure. */
export interface Capsule {
  a: number;
  b: number;
  radius_a_m: number;
  radius_b_m: number;
  depth_ratio: number; // front to back
  holds_tool: boolean;
}

/** What does not change of the figure; joints by number. */
export interface Skeleton {
  joints: string[];
  capsules: Capsule[];
  sides: [number, number]; // left and right hip
  hand: number; // finger tips that hold the tool
  head: number;
}

/** Follows the frame with the same tick. */
export interface FigureFrame {
  kind: "figure";
  tick: number;
  joint_m: number[]; // 3 per joint
  grip_m: Vec;
  head: [number, number, number, number]; // w, x, y, z; the face looks along its -x
  reached: boolean;
  error_mm: number;
  sweeps: number;
  updates: number;
  full_chain: boolean;
  trouble: number; // 0 none, 1 held, 2 lost, 3 out of reach
  words: string;
  head_tracked: boolean;
}

export type LinkName = "waiting" | "live" | "lost" | "replay";

/** How a recording is played. */
export interface Replay {
  start_s: number; // time_s of its first frame
  length_s: number;
  frames: number;
  playing: boolean;
  speed_ratio: number;
  repeats: boolean;
  stops: { at_s: number; fault: number }[]; // since the start; fault 0: stopped on request
}

/** What a page may ask of it; each may be missing. */
export interface ReplayRequest {
  playing?: boolean;
  at_s?: number; // since the start
  step_frames?: number;
  speed_ratio?: number;
  repeats?: boolean;
}

/** What may be set of a law, its ends included. */
export interface Parameter {
  key: string; // as --set takes it
  unit: string;
  value: number; // as shipped
  low: number;
  high: number;
  whole: boolean;
  live: boolean; // may change while the scene runs
  meaning: string;
}

/** A scene that may be chosen: of `tactd SCENE --parameters --json`. */
export interface OfferedScene {
  scene: string;
  law: string;
  parameters: Parameter[];
}

/** What a page may ask for, in simulation: what `set` does not name is as shipped. */
export interface SceneRequest {
  scene: string;
  set: Record<string, number>;
}

/** What runs, what was asked for and has not come yet, why the last request was refused. */
export interface Picker extends SceneRequest {
  asked: string;
  answer: string; // why the last request was refused
  note: string; // about the numbers that were set last
}

export interface Status {
  kind: "status";
  link: LinkName;
  detail: string;
  scene_number: number;
  kept_s: number;
  figure?: Skeleton;
  replay?: Replay;
  picker?: Picker; // where a scene may be chosen
}

export interface Mesh {
  vertex_m: Float32Array; // 3 per vertex
  triangle: Uint32Array; // 3 per triangle
  color?: Uint8Array; // red, green, blue of each vertex, where the scene has them
}

/** Takes organ and tool out of /mesh.bin: vertices, triangles, vertices, triangles, colours of the organ's vertices. */
export function split_meshes(scene: Scene, bytes: ArrayBuffer): { organ: Mesh; tool: Mesh } {
  let at = 0;
  const take = (vertices: number, triangles: number): Mesh => {
    const vertex_m = new Float32Array(bytes, at, vertices * 3);
    at += vertex_m.byteLength;
    const triangle = new Uint32Array(bytes, at, triangles * 3);
    at += triangle.byteLength;
    return { vertex_m, triangle };
  };
  const organ = take(scene.organ_vertices, scene.organ_triangles);
  const tool = take(scene.tool_vertices, scene.tool_triangles);
  if (bytes.byteLength > at) organ.color = new Uint8Array(bytes, at, organ.vertex_m.length);
  return { organ, tool };
}

export function length_of(v: Vec): number {
  return Math.hypot(v[0], v[1], v[2]);
}

export function cross(a: Vec, b: Vec): Vec {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

export function dot(a: Vec, b: Vec): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
