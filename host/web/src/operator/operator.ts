// SPDX-License-Identifier: Apache-2.0
// operator.ts - the operator in the picture: shown or hidden, seen from outside or with the own eyes.

import { eyes_of, grip_error_m, with_head } from "./figure";
import { FigureView } from "./figure_view";
import { by_id } from "../document/dom";
import type { Hud } from "../panels/hud";
import type { FigureFrame, Skeleton, Status, Vec } from "../link/protocol";
import type { Stage } from "../scene/stage";

export class Operator {
  on = true;
  eyes_on = false;
  view_chosen = false; // by a key or the mouse: from then on only these change it
  shown: FigureFrame | null = null;
  private newest: FigureFrame | null = null; // not drawn yet
  private figure: FigureView | null = null;
  private skeleton: Skeleton | null = null;
  private known = ""; // what the figure was made of
  private was_worn = false; // the last picture had a headset's head

  constructor(
    private readonly stage: Stage,
    private readonly hud: Hud,
  ) {}

  get there(): boolean {
    return this.figure !== null;
  }

  /** The figure is there if tact-view sends its skeleton; every scene has its own. */
  status(now: Status): void {
    const made_of = now.figure ? `${now.scene_number} ${JSON.stringify(now.figure)}` : "";
    if (made_of === this.known) return;
    this.known = made_of;
    const was = this.there;
    if (this.figure) {
      this.stage.scene.remove(this.figure.object);
      this.figure.dispose();
    }
    this.skeleton = now.figure ?? null;
    this.figure = now.figure ? new FigureView(now.figure) : null;
    if (this.figure) {
      this.stage.scene.add(this.figure.object);
    } else {
      this.newest = this.shown = null;
      this.hud.tracking(null);
    }
    this.newest ??= this.shown;
    if (was !== this.there) this.show(this.on);
    by_id("figure").hidden = by_id("eyes").hidden = !this.figure;
  }

  take(next: FigureFrame): void {
    this.newest = next;
  }

  show(on: boolean): void {
    this.on = on;
    if (this.eyes_on) this.see_with_eyes(false);
    this.stage.set_operator(this.there && on);
    this.hud.pressed("figure", on);
  }

  /** With a tracked head by itself, until a person chooses another view; when asked, with any head. */
  see_with_eyes(on: boolean): void {
    this.eyes_on = on && this.there;
    if (!this.eyes_on) this.stage.look_through(null);
    this.hud.pressed("eyes", this.eyes_on);
  }

  /** Once per picture. `heard`: what a tracker says is of now, or of the recording. */
  draw(heard: boolean): void {
    if (!this.figure || !this.skeleton) return;
    if (this.newest) {
      this.shown = this.newest;
      this.newest = null;
      this.figure.show(this.shown);
      this.hud.tracking(heard ? this.shown : null);
    }
    this.figure.object.visible = this.on && this.shown !== null;
    if (!this.shown) return;
    if (this.shown.head_tracked && this.on && !this.view_chosen && !this.eyes_on) this.see_with_eyes(true);
    if (this.eyes_on) this.stage.look_through(eyes_of(this.shown, this.skeleton));
    this.show_wearer(this.shown, this.figure, this.skeleton);
  }

  /** A headset's own pose is the head of the figure, not that of a tracker; the rest is the figure's. */
  private show_wearer(shown: FigureFrame, figure: FigureView, skeleton: Skeleton): void {
    const worn = this.stage.worn_head;
    if (worn || this.was_worn) figure.show(worn ? with_head(shown, skeleton, worn) : shown);
    this.was_worn = worn !== null;
    figure.clear_view(shown, worn ? worn.at_m : (this.stage.camera.position.toArray() as Vec));
  }

  /** Where the figure's eyes are, m; null without one that is shown. */
  get eyes_m(): Vec | null {
    return this.on && this.shown && this.skeleton ? eyes_of(this.shown, this.skeleton).at_m : null;
  }

  /** Joints by name, m. */
  get joints_m(): Record<string, number[]> | null {
    const names = this.skeleton?.joints;
    const at = this.shown?.joint_m;
    return names && at ? Object.fromEntries(names.map((name, i) => [name, at.slice(3 * i, 3 * i + 3)])) : null;
  }

  /** The same from what is drawn; null while the figure is not visible. */
  get drawn_m(): Record<string, Vec> | null {
    const names = this.skeleton?.joints;
    const drawn_m = this.figure?.drawn_m;
    return names && drawn_m ? Object.fromEntries([...drawn_m].map(([index, at_m]) => [names[index], at_m])) : null;
  }

  get grip_error_m(): number | null {
    return this.shown && this.skeleton ? grip_error_m(this.shown, this.skeleton) : null;
  }
}
