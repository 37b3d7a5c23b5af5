// SPDX-License-Identifier: Apache-2.0
// look.ts - a material as one picture. The colour of a surface that looks in direction n (in view) is
// painted once for every n; afterwards a pixel reads the colour that belongs to its own n. So moist
// tissue costs one texture read per pixel and stays smooth on a PC without a graphics card.
//
//     colour(n) = base (sky + key + glow) + coat F S(r) + rim
//
//     r  reflection of the line of sight, 2 (n.v) n - v      F  Fresnel [C. Schlick, Comput. Graph.
//     S  bright windows of a soft-lit room                       Forum 13 (1994) 233]

import * as THREE from "three";
import { smoothstep } from "./smoothstep";
import { dot, type Vec } from "../link/protocol";

const kPixels = 256;
const kEdge = 0.495; // the picture's rim stays inside: at = kEdge n.xy + 0.5

export interface Look {
  base: Vec; // linear colour
  glow: Vec; // light that comes through thin tissue at the rim
  coat: number; // strength of reflections
  metal: number; // 0: reflections are white, 1: they have the colour of the base
}

export const kTissue: Look = { base: [0.27, 0.024, 0.018], glow: [0.42, 0.07, 0.04], coat: 1.0, metal: 0 };
export const kSkin: Look = { base: [0.5, 0.27, 0.18], glow: [0.2, 0.06, 0.03], coat: 0.3, metal: 0 };
export const kGlove: Look = { base: [0.12, 0.3, 0.5], glow: [0.04, 0.1, 0.16], coat: 0.5, metal: 0 };
export const kSteel: Look = { base: [0.56, 0.6, 0.65], glow: [0, 0, 0], coat: 1.0, metal: 1 };
export const kCover: Look = { base: [0.2, 0.2, 0.2], glow: [0.02, 0.02, 0.02], coat: 0.75, metal: 0 };
export const kFigure: Look = { base: [0.4, 0.42, 0.45], glow: [0.05, 0.06, 0.08], coat: 0.35, metal: 0 };
export const kAccent: Look = { base: [0.13, 0.4, 0.36], glow: [0.03, 0.09, 0.08], coat: 0.45, metal: 0 };

interface Window {
  towards: Vec;
  half_angle_rad: number;
  soft_rad: number;
  color: Vec;
}

const kWindows: readonly Window[] = [
  { towards: unit([0.42, 0.8, 0.5]), half_angle_rad: 0.17, soft_rad: 0.1, color: [15, 14, 13] },
  { towards: unit([0.42, 0.8, 0.5]), half_angle_rad: 0.2, soft_rad: 0.6, color: [3.2, 2.8, 2.6] },
  { towards: unit([-0.8, 0.35, 0.4]), half_angle_rad: 0.1, soft_rad: 0.4, color: [2.6, 3.6, 5.2] },
  { towards: unit([0.1, -0.8, 0.4]), half_angle_rad: 0.1, soft_rad: 0.9, color: [1.2, 0.9, 0.9] },
];
const kKey = unit([0.4, 0.8, 0.7]);
const kBack = unit([-0.85, 0.35, -0.25]);

function unit(v: Vec): Vec {
  const length = Math.hypot(...v);
  return [v[0] / length, v[1] / length, v[2] / length];
}

/** Colour of a surface that looks along n, n.z > 0 towards the eye; linear, may exceed 1. */
export function shade(look: Look, n: Vec): Vec {
  const r: Vec = [2 * n[2] * n[0], 2 * n[2] * n[1], 2 * n[2] * n[2] - 1];
  const grazing = Math.pow(1 - n[2], 5);
  const key = Math.max(0, (dot(n, kKey) + 0.35) / 1.35); // wrapped: flesh scatters light around its edge
  const rim = Math.pow(1 - n[2], 2.2) * Math.max(0, dot(n, kBack) + 0.35);
  const sky = 0.16 + 0.14 * n[1];
  // F = F0 + (1 - F0) (1 - n.v)^5
  const fresnel = look.metal > 0.5 ? 1 : 0.045 + 0.6 * grazing;
  // A room: dark floor, a bright horizon, a dim ceiling.
  const room = 0.06 + smoothstep(-0.15, 0.1, r[1]) * (0.75 - 0.45 * Math.max(0, r[1]));
  const bright_of: Vec = [room, room, room];
  for (const window of kWindows) {
    const angle_rad = Math.acos(Math.min(1, Math.max(-1, dot(r, window.towards))));
    const inside = 1 - smoothstep(window.half_angle_rad, window.half_angle_rad + window.soft_rad, angle_rad);
    if (inside > 0) for (let c = 0; c < 3; ++c) bright_of[c] += inside * window.color[c];
  }
  const thin = Math.pow(1 - n[2], 2.5) * 0.55;
  const out: Vec = [0, 0, 0];
  for (let c = 0; c < 3; ++c) {
    const bright = bright_of[c];
    const diffuse = look.base[c] * (sky + 1.35 * key * key) + look.glow[c] * thin;
    const mirror = look.coat * fresnel * bright;
    const cool = [0.3, 0.48, 0.8][c] * rim * 0.9;
    out[c] =
      look.metal * (look.base[c] * (0.25 * sky + 0.16 * key) + 0.55 * mirror * look.base[c]) +
      (1 - look.metal) * (diffuse + mirror) +
      cool * (0.35 + 0.65 * look.metal);
  }
  return out;
}

export function paint(look: Look): THREE.Texture {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = kPixels;
  const pen = canvas.getContext("2d")!;
  const image = pen.createImageData(kPixels, kPixels);
  for (let row = 0; row < kPixels; ++row) {
    for (let column = 0; column < kPixels; ++column) {
      let x = ((column + 0.5) / kPixels - 0.5) / kEdge;
      let y = -((row + 0.5) / kPixels - 0.5) / kEdge;
      const length = Math.hypot(x, y);
      if (length > 0.9999) {
        x *= 0.9999 / length;
        y *= 0.9999 / length;
      }
      const color = shade(look, [x, y, Math.sqrt(1 - x * x - y * y)]);
      const at = 4 * (row * kPixels + column);
      for (let c = 0; c < 3; ++c) {
        // Film-like shoulder and display gamma, so that no pixel has to do it again.
        image.data[at + c] = 255 * Math.pow(1 - Math.exp(-1.25 * color[c]), 1 / 2.2);
      }
      image.data[at + 3] = 255;
    }
  }
  pen.putImageData(image, 0, 0);
  const picture = new THREE.CanvasTexture(canvas);
  picture.generateMipmaps = false;
  picture.minFilter = THREE.LinearFilter;
  return picture;
}

const kVertex = /* glsl */ `
  attribute vec3 tint;
  varying vec2 at;
  varying vec3 tinted;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    vec3 n = normalize(normalMatrix * normal);
    // Axes across the line of sight, so that the look does not change towards the picture's edge.
    vec3 sight = normalize(-place.xyz);
    vec3 right = normalize(vec3(sight.z, 0.0, -sight.x));
    at = ${kEdge} * vec2(dot(n, right), dot(n, cross(sight, right))) + 0.5;
    tinted = tint;
    gl_Position = projectionMatrix * place;
  }`;
const kFragment = /* glsl */ `
  uniform sampler2D look;
  varying vec2 at;
  varying vec3 tinted;
  void main() { gl_FragColor = vec4(texture2D(look, at).rgb * tinted, 1.0); }`;

/** Needs the attributes position, normal and tint (a factor on the picture's colour). */
export function look_material(picture: THREE.Texture): THREE.ShaderMaterial {
  return new THREE.ShaderMaterial({
    vertexShader: kVertex,
    fragmentShader: kFragment,
    uniforms: { look: { value: picture } },
    polygonOffset: true, // room for the lines of the mesh
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}
