// main.ts - puts the parts together: connection -> stage, panels, plots; mouse and keys -> hand.

import "./style.css";
import { Connection } from "./connection";
import { HandControl } from "./hand_control";
import { by_id, Hud } from "./hud";
import { OrganView } from "./organ_view";
import { Plots } from "./plots";
import type { Frame, Mesh, Scene, Status, Vec } from "./protocol";
import { Recorder } from "./recorder";
import { Stage } from "./stage";
import { ToolView } from "./tool_view";

const canvas = by_id<HTMLCanvasElement>("view");
const hud = new Hud();
const plots = new Plots(by_id);
const recorder = new Recorder();

let scene: Scene | null = null;
let organ: OrganView | null = null;
let tool: ToolView | null = null;
let newest: Frame | null = null; // not drawn yet
let shown: Frame | null = null;
let status: Status | null = null;
let paused = false;
let wireframe = false;
let most_ever_m = 0;

const stage = new Stage(canvas, draw);
const hand = new HandControl(canvas, stage, may_move_hand, (position_m, grip_ratio) =>
  connection.move_hand(position_m, grip_ratio),
);
const connection = new Connection({
  status: (now) => {
    status = now;
    hud.link(now);
    if (now.link === "lost") recorder.stop();
  },
  scene: take_scene,
  frame: take_frame,
  server_gone: () => {
    status = null;
    hud.link(null);
    recorder.stop();
  },
});

function may_move_hand(): boolean {
  return scene?.simulated === true && status?.link === "live";
}

function take_scene(next: Scene, organ_mesh: Mesh, tool_mesh: Mesh): void {
  if (organ && tool) {
    stage.scene.remove(organ.object, tool.object);
    organ.dispose();
    tool.dispose();
  }
  scene = next;
  organ = new OrganView(organ_mesh, next, stage.tissue);
  organ.wireframe = wireframe;
  tool = new ToolView(tool_mesh, next, stage.steel);
  stage.scene.add(organ.object, tool.object);
  let floor_m = Infinity;
  for (let i = 2; i < organ_mesh.vertex_m.length; i += 3) floor_m = Math.min(floor_m, organ_mesh.vertex_m[i]);
  stage.set_home(organ.bounds, floor_m - 0.004);
  hud.scene(next);
  plots.spheres = next.spheres.length;
  by_id("hand").hidden = !next.simulated;
}

function take_frame(frame: Frame): void {
  recorder.frame(frame);
  if (paused) return;
  newest = frame;
  plots.add(frame);
}

function draw(now_ms: number): void {
  if (organ && tool && newest) {
    shown = newest;
    newest = null;
    organ.show(shown.sites, shown.patch);
    tool.show(shown);
    hand.frame(shown, now_ms);
    hud.frame(shown, now_ms, stage.fps);
    most_ever_m = Math.max(most_ever_m, organ.deformed.most_m);
  }
  tool?.show_hand_target(hand.target ? (hand.target.toArray() as Vec) : null);
  if (!paused) plots.draw(now_ms);
}

const actions: Record<string, () => void> = {
  p: () => {
    paused = !paused;
    hud.pressed("pause", paused);
  },
  m: () => {
    hand.mode = !hand.mode && may_move_hand();
    hud.pressed("hand", hand.mode);
    canvas.classList.toggle("moves_hand", hand.mode);
  },
  r: () => (recorder.on ? recorder.stop() : recorder.start()),
  c: () => recorder.save_table(),
  w: () => {
    wireframe = !wireframe;
    if (organ) organ.wireframe = wireframe;
    hud.pressed("wire", wireframe);
  },
  v: () => stage.go_home(),
  g: () => hand.toggle_grip(),
  h: () => {
    const keys = by_id("keys");
    keys.hidden = !keys.hidden;
    hud.pressed("help", !keys.hidden);
    by_id("help").setAttribute("aria-expanded", String(!keys.hidden));
  },
};

window.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
  if (event.key === " ") event.preventDefault();
  actions[event.key === " " ? "p" : event.key.toLowerCase()]?.();
});
const buttons: Record<string, string> = {
  pause: "p", hand: "m", record: "r", csv: "c", wire: "w", home: "v", help: "h",
};
for (const [id, key] of Object.entries(buttons)) {
  by_id(id).addEventListener("click", (event) => {
    event.preventDefault();
    by_id(id).blur(); // so that the space bar does not press it again
    actions[key]();
  });
}

/** Read-only numbers for tests and for curious people in the console. */
const numbers = {
  get fps() { return stage.fps; },
  get link() { return status?.link ?? "gone"; },
  get scene_name() { return scene?.scene ?? ""; },
  get vertex_count() { return organ?.vertex_count ?? 0; },
  get frames() { return connection.frames; },
  get bytes() { return connection.bytes; },
  get largest_frame_bytes() { return connection.largest_frame_bytes; },
  get moved_vertices() { return organ?.deformed.moved ?? 0; },
  get cut_triangles() { return organ?.cut_triangles ?? 0; },
  get most_m() { return organ?.deformed.most_m ?? 0; },
  get most_ever_m() { return most_ever_m; },
  get tool_m() { return shown ? [...shown.tool_m] : null; },
  get force_N() { return shown ? [...shown.force_N] : null; },
  get tick() { return shown?.tick ?? 0; },
  get state() { return shown?.state ?? 0; },
  get paused() { return paused; },
  get wireframe() { return wireframe; },
  get camera_m() { return stage.camera.position.toArray(); },
};
export type TactNumbers = Readonly<typeof numbers>;
declare global {
  interface Window { readonly tact: TactNumbers; }
}
Object.defineProperty(window, "tact", { value: Object.freeze(numbers) });
