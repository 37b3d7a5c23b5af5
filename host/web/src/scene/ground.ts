// SPDX-License-Identifier: Apache-2.0
// ground.ts - a grid of 20 mm that fades into the dark, and a soft shadow below the organ. Lines and
// one small picture: a large transparent plane would cost more than everything else.

import * as THREE from "three";

const kStep_m = 0.02;
const kPieces = 12; // each line is cut, so that it can fade along its length

function grid(radius_m: number): THREE.LineSegments {
  const place: number[] = [];
  const color: number[] = [];
  const n = Math.floor(radius_m / kStep_m);
  const add = (x: number, y: number, strength: number): void => {
    place.push(x, y, 0);
    const fade = Math.max(0, 1 - Math.hypot(x, y) / radius_m);
    color.push(0.55, 0.66, 0.78, strength * fade * fade);
  };
  for (let i = -n; i <= n; ++i) {
    const strength = i % 5 === 0 ? 0.42 : 0.16;
    for (let j = 0; j < kPieces; ++j) {
      const from_m = radius_m * ((2 * j) / kPieces - 1);
      const to_m = radius_m * ((2 * (j + 1)) / kPieces - 1);
      const side_m = i * kStep_m;
      if (Math.min(Math.hypot(side_m, from_m), Math.hypot(side_m, to_m)) > radius_m) continue;
      add(side_m, from_m, strength);
      add(side_m, to_m, strength);
      add(from_m, side_m, strength);
      add(to_m, side_m, strength);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(place, 3));
  geometry.setAttribute("color", new THREE.Float32BufferAttribute(color, 4));
  const material = new THREE.LineBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });
  return new THREE.LineSegments(geometry, material);
}

function shadow(radius_m: number): THREE.Mesh {
  const pixels = 64;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = pixels;
  const pen = canvas.getContext("2d")!;
  const fade = pen.createRadialGradient(pixels / 2, pixels / 2, 0, pixels / 2, pixels / 2, pixels / 2);
  fade.addColorStop(0, "rgba(0,0,0,0.75)");
  fade.addColorStop(0.5, "rgba(0,0,0,0.45)");
  fade.addColorStop(1, "rgba(0,0,0,0)");
  pen.fillStyle = fade;
  pen.fillRect(0, 0, pixels, pixels);
  const texture = new THREE.CanvasTexture(canvas);
  texture.generateMipmaps = false;
  texture.minFilter = THREE.LinearFilter;
  const material = new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false });
  const mesh = new THREE.Mesh(new THREE.CircleGeometry(radius_m, 40), material);
  mesh.position.z = -0.0005; // below the lines
  return mesh;
}

/** At z = 0, around an organ of this radius. */
export function make_ground(radius_m: number): THREE.Group {
  const group = new THREE.Group();
  group.add(shadow(1.15 * radius_m), grid(2.6 * radius_m));
  return group;
}
