// SPDX-License-Identifier: Apache-2.0
// main.ts - puts the parts together: connection -> stage, panels, plots; mouse and keys -> hand.

import "./style.css";
import { Connection } from "./connection";
import { eyes_of, grip_error_m } from "./figure";
import { FigureView } from "./figure_view";
import { HandControl } from "./hand_control";
import { by_id, Hud } from "./hud";
import { split_link } from "./link";
import { News } from "./news";
import { OrganView } from "./organ_view";
import { Plots } from "./plots";
import type { FigureFrame, Frame, Mesh, Scene, Status, Vec } from "./protocol";
import { Recorder } from "./recorder";
import { Stage } from "./stage";
import { ToolView } from "./tool_view";

/** Takes the token out of the address bar: no bookmark, history or screenshot keeps it. */
function take_token(): string | null {
  const { token, rest } = split_link(location.hash);
  if (token !== null) history.replaceState(null, "", location.pathname + location.search + rest);
  return token;
}

const token = take_token();
const canvas = by_id<HTMLCanvasElement>("view");
const hud = new Hud();
const plots = new Plots(by_id);
const recorder = new Recorder();
const news = new News();
const kLongestWait_ms = 100; // of a frame for its figure

let scene: Scene | null = null;
let organ: OrganView | null = null;
let tool: ToolView | null = null;
let newest: Frame | null = null; // not drawn yet
let waiting: Frame | null = null; // its figure is not here yet: a hand and its tool are drawn together
let waiting_since_ms = 0;
let shown: Frame | null = null;
let status: Status | null = null;
let paused = false;
let wireframe = false;
let most_ever_m = 0;
let silence_s = 0;
let figure: FigureView | null = null;
let newest_figure: FigureFrame | null = null;
let shown_figure: FigureFrame | null = null;
let figure_on = true;
let eyes_on = false;
let view_chosen = false; // by a key or the mouse: from then on it changes for nobody else

const stage = new Stage(canvas, draw);
const hand = new HandControl(canvas, stage, may_move_hand, (position_m, grip_ratio) =>
  connection.move_hand(position_m, grip_ratio),
);
const connection = new Connection({
  status: (now) => {
    status = now;
    hud.link(now);
    take_skeleton(now);
    if (now.link === "lost") {
      hud.tracking(null);
      recorder.stop();
    }
  },
  scene: take_scene,
  frame: take_frame,
  figure: take_figure,
  server_gone: (refused) => {
    status = null;
    hud.link(null, refused);
    hud.tracking(null); // what a chip said last is not known any more
    recorder.stop();
  },
}, token);
window.addEventListener("hashchange", () => {
  const next = take_token();
  if (next !== null) connection.use(next);
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
  waiting = null;
  scene = next;
  organ = new OrganView(organ_mesh, next);
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

/** The figure is there if tact-view tells its skeleton; every scene has its own. */
function take_skeleton(now: Status): void {
  if (figure) {
    stage.scene.remove(figure.object);
    figure.dispose();
  }
  const was = figure !== null;
  figure = now.figure ? new FigureView(now.figure) : null;
  if (!figure) {
    newest_figure = shown_figure = null;
    hud.tracking(null);
  }
  newest_figure ??= shown_figure;
  if (figure) stage.scene.add(figure.object);
  if (was !== (figure !== null)) show_figure(figure_on);
  by_id("figure").hidden = by_id("eyes").hidden = !figure;
}

function show_figure(on: boolean): void {
  figure_on = on;
  if (eyes_on) see_with_eyes(false);
  stage.set_operator(figure !== null && on);
  hud.pressed("figure", on);
}

/** With a tracked head by itself, until a person chooses another view; when asked, with any head. */
function see_with_eyes(on: boolean): void {
  eyes_on = on && figure !== null;
  if (!eyes_on) stage.look_through(null);
  hud.pressed("eyes", eyes_on);
}

function draw_figure(): void {
  if (!figure || !status?.figure) return;
  if (newest_figure) {
    shown_figure = newest_figure;
    newest_figure = null;
    figure.show(shown_figure);
    hud.tracking(status.link === "lost" ? null : shown_figure);
  }
  figure.object.visible = figure_on && shown_figure !== null;
  if (!shown_figure) return;
  if (shown_figure.head_tracked && figure_on && !view_chosen && !eyes_on) see_with_eyes(true);
  if (eyes_on) stage.look_through(eyes_of(shown_figure, status.figure));
  figure.clear_view(shown_figure, stage.camera.position);
}

function take_frame(frame: Frame): void {
  recorder.frame(frame);
  news.frame(performance.now());
  if (paused) return;
  newest = figure ? waiting ?? newest : frame;
  waiting = figure ? frame : null;
  waiting_since_ms = performance.now();
  plots.add(frame);
}

function take_figure(next: FigureFrame): void {
  if (paused) return;
  newest_figure = next;
  if (waiting?.tick !== next.tick) return;
  newest = waiting;
  waiting = null;
}

function draw(now_ms: number): void {
  if (waiting && now_ms - waiting_since_ms > kLongestWait_ms) {
    newest = waiting; // without its figure, then: no tick is kept from a person's eyes
    waiting = null;
  }
  if (organ && tool && newest) {
    shown = newest;
    newest = null;
    organ.show(shown.sites, shown.patch);
    tool.show(shown);
    hand.frame(shown, now_ms);
    hud.frame(shown, now_ms);
    most_ever_m = Math.max(most_ever_m, organ.deformed.most_m);
  }
  hud.draw(now_ms, stage.fps);
  const silent_s = news.silence_s(performance.now(), scene?.frame_rate_Hz ?? 60);
  silence_s = status?.link === "replay" ? 0 : silent_s; // a recording may have gaps
  hud.silence(silence_s);
  if (silence_s > 0) tool?.hide_force();
  draw_figure();
  tool?.show_hand_target(hand.target ? (hand.target.toArray() as Vec) : null);
  if (!paused) plots.draw(now_ms);
}

const actions: Record<string, () => unknown> = {
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
  v: () => {
    view_chosen = true;
    see_with_eyes(false);
    stage.go_home();
  },
  f: () => figure && show_figure(!figure_on),
  e: () => {
    view_chosen = true;
    see_with_eyes(!eyes_on);
  },
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
  pause: "p", hand: "m", record: "r", csv: "c", wire: "w", home: "v", figure: "f", eyes: "e",
  help: "h",
};
for (const [id, key] of Object.entries(buttons)) {
  by_id(id).addEventListener("click", (event) => {
    event.preventDefault();
    by_id(id).blur(); // so that the space bar does not press it again
    actions[key]();
  });
}

stage.controls.addEventListener("start", () => (view_chosen = true));

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
  get silence_s() { return silence_s; },
  get wireframe() { return wireframe; },
  get figure_on() { return figure !== null && figure_on; },
  get eyes_on() { return eyes_on; },
  /** Joints by name, m. */
  get figure_m() {
    const names = status?.figure?.joints;
    if (!names || !shown_figure) return null;
    const at = shown_figure.joint_m;
    return Object.fromEntries(names.map((name, i) => [name, at.slice(3 * i, 3 * i + 3)]));
  },
  /** The same from what is drawn; null while the figure is not visible. */
  get drawn_figure_m() {
    const names = status?.figure?.joints, drawn_m = figure?.drawn_m;
    if (!names || !drawn_m) return null;
    return Object.fromEntries([...drawn_m].map(([index, at_m]) => [names[index], at_m]));
  },
  /** Where a place in the tool's own axes is drawn. */
  drawn_tool_m(place_m: Vec) { return tool?.drawn_m(place_m) ?? null; },
  get grip_error_m() { return shown_figure && status?.figure ? grip_error_m(shown_figure, status.figure) : null; },
  get tracking_words() { return shown_figure?.words ?? ""; },
  get largest_figure_bytes() { return connection.largest_figure_bytes; },
  get camera_m() { return stage.camera.position.toArray(); },
};
export type TactNumbers = Readonly<typeof numbers>;
declare global {
  interface Window { readonly tact: TactNumbers; }
}
Object.defineProperty(window, "tact", { value: Object.freeze(numbers) });
