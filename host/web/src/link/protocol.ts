// SPDX-License-Identifier: Apache-2.0
// protocol.ts - what tact-view sends, with its units in the names. Vectors are [x, y, z] in frame W:
// +x towards the operator, +y to the right, +z up.

export type Vec = [number, number, number];

export interface Sphere {
  radius_m: number;
  offset_m: Vec; // tool frame
}

export interface Scene {
  scene: string;
  device: string;
  law: string;
  organ: { vertices: number; triangles: number };
  tool: { vertices: number; triangles: number };
  ring_count: number;
  ring_pitch_m: number;
  rate_Hz: number;
  frame_rate_Hz: number;
  force_limit_N: number;
  torque_limit_Nm: number; // 0: the device has no torque
  continuous_force_N: number;
  energy_budget_J: number;
  limits_checksum: string;
  non_rt: boolean;
  simulated: boolean;
  cannot_grip: boolean; // the scene grips, the device has nothing to close the jaws
  spheres: Sphere[];
  look: { organ: string; tool: string; pieces: Vec[] }; // [look] of the scene
}

export const kSiteInside = 3;

/** A probe sphere in contact, or inside the organ. */
export interface Site {
  site: number;
  state: number; // 1 touching, 2 held, 3 inside the organ: no force until it has once been outside
  point_m: Vec; // on the undeformed surface
  normal: Vec; // outward, unit
  shift_m: Vec; // tangential displacement of the tissue
  depth_m: number; // press positive
  u_m: number[]; // displacement into the tissue at radius j * ring_pitch_m, its mean around the site
  tilt: Vec; // what u_m lacks at x: tilt . (x - point_m)
}

/** Of a law without profiles: vertices that are not at rest, and cut triangles. */
export interface Patch {
  count: number;
  moved: string; // base64, see patch.ts
  cut_total: number; // so far
  cut: number[]; // some of them
}

export interface Frame {
  kind: "frame";
  tick: number;
  time_s: number;
  state: number;
  fault: number;
  limit: number;
  late: number;
  skipped: number;
  dropped: number;
  contact_losses: number; // so far
  tool_m: Vec;
  turn: [number, number, number, number]; // w, x, y, z
  velocity_mps: Vec;
  grip_ratio: number;
  force_N: Vec;
  torque_Nm: Vec;
  wanted_N: Vec;
  margin_us: number;
  tick_us: number;
  peak_N: number;
  rms_N: number;
  given_J: number; // more than was taken
  grip_N: number; // on the fingers, opening positive
  sites: Site[];
  patch?: Patch;
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
  answer: string;
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
  const take = (part: { vertices: number; triangles: number }): Mesh => {
    const vertex_m = new Float32Array(bytes, at, part.vertices * 3);
    at += vertex_m.byteLength;
    const triangle = new Uint32Array(bytes, at, part.triangles * 3);
    at += triangle.byteLength;
    return { vertex_m, triangle };
  };
  const organ = take(scene.organ);
  const tool = take(scene.tool);
  if (bytes.byteLength > at) organ.color = new Uint8Array(bytes, at, organ.vertex_m.length);
  return { organ, tool };
}

export function length_of(v: Vec): number {
  return Math.hypot(v[0], v[1], v[2]);
}

export function dot(a: Vec, b: Vec): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
