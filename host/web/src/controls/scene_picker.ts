// SPDX-License-Identifier: Apache-2.0
// scene_picker.ts - another scene, other numbers of its law. It asks; who has started the simulation
// starts tactd anew, or says why not. What is good is decided there, not here.

import { by_id } from "../document/dom";
import type { OfferedScene, Parameter, Picker, SceneWish } from "../link/protocol";
import { range_words, share_of, value_at } from "./parameter_scale";

function element<K extends keyof HTMLElementTagNameMap>(tag: K, set: Partial<HTMLElementTagNameMap[K]>): HTMLElementTagNameMap[K] {
  return Object.assign(document.createElement(tag), set);
}

/** A slider and a field for one number. */
class Row {
  readonly box = element("div", { className: "parameter" });
  private readonly field = element("input", { type: "number", step: "any" });
  private readonly slider = element("input", { type: "range", min: "0", max: "1", step: "0.002" });

  constructor(readonly of: Parameter, value: number) {
    const name = of.key.slice(of.key.indexOf(".") + 1);
    const small = element("small", { className: "soft", id: `about_${of.key}`, textContent: `${of.meaning}; ${range_words(of)}` });
    this.field.id = `set_${of.key}`;
    this.slider.id = `slide_${of.key}`;
    this.field.min = String(of.low);
    this.field.max = String(of.high);
    for (const input of [this.field, this.slider]) input.setAttribute("aria-describedby", small.id);
    this.slider.setAttribute("aria-label", `${name}, slider`);
    this.field.addEventListener("input", () => this.follow());
    this.slider.addEventListener("input", () => this.put(value_at(of, Number(this.slider.value))));
    const label = element("label", { htmlFor: this.field.id });
    label.append(...name.split(/(?<=_)/).flatMap((part) => [part, element("wbr", {})])); // a narrow one breaks there
    this.box.append(label, this.field, this.slider, small);
    this.put(value);
  }

  /** NaN: nothing is written there. */
  get value(): number {
    return this.field.valueAsNumber;
  }

  put(value: number): void {
    this.field.value = String(value);
    this.follow();
  }

  private follow(): void {
    this.slider.value = String(share_of(this.of, this.value));
    this.slider.setAttribute("aria-valuetext", `${this.field.value} ${this.of.unit}`.trim());
    this.field.setAttribute("aria-invalid", String(!(this.value >= this.of.low && this.value <= this.of.high)));
  }
}

export class ScenePicker {
  /** Something is offered. */
  there = false;
  private scenes: OfferedScene[] = [];
  private now: Picker | null = null;
  private shown = ""; // what runs, as it was put into the form
  private rows: Row[] = [];
  private readonly select = by_id<HTMLSelectElement>("wished_scene");

  constructor(private readonly ask: (wish: SceneWish) => void, private readonly offered: () => Promise<OfferedScene[]>) {
    this.select.addEventListener("change", () => this.show(this.select.value === this.now?.scene ? this.now.set : {}));
    by_id("wish").addEventListener("submit", (event) => {
      event.preventDefault();
      this.apply();
    });
    by_id("as_shipped").addEventListener("click", () => {
      this.show({});
      this.apply();
    });
  }

  /** Null: nothing is offered. */
  async status(picker: Picker | null): Promise<void> {
    const is_new = picker !== null && this.now === null; // of another tact-view, maybe with others
    this.now = picker;
    if (is_new) {
      this.scenes = await this.offered().catch(() => []);
      this.select.replaceChildren(...this.scenes.map((one) => new Option(one.scene)));
      this.shown = "";
    }
    this.tell();
  }

  private tell(): void {
    const picker = this.now;
    this.there = picker !== null && this.scenes.length > 0;
    document.body.classList.toggle("can_pick", this.there);
    if (!picker || !this.there) return;
    const runs = JSON.stringify([picker.scene, picker.set]);
    if (runs !== this.shown) {
      this.shown = runs;
      this.select.value = picker.scene;
      this.show(picker.set);
    }
    const changed = Object.keys(picker.set).length;
    if (picker.asked) this.say(`starting ${picker.asked} …`);
    else if (picker.answer) this.say(picker.answer, "bad");
    else this.say(`${picker.scene} runs, ${changed === 0 ? "as shipped" : `${changed} changed`}`);
  }

  /** The numbers of the chosen scene, as shipped but for these. */
  private show(set: Record<string, number>): void {
    const scene = this.scenes.find((one) => one.scene === this.select.value);
    this.rows = (scene?.parameters ?? []).map((of) => new Row(of, set[of.key] ?? of.value));
    by_id("parameters").replaceChildren(...this.rows.map((row) => row.box));
    by_id("wished_law").textContent = scene ? `law ${scene.law}` : "";
  }

  private apply(): void {
    const empty = this.rows.find((row) => Number.isNaN(row.value));
    if (empty) return this.say(`${empty.of.key} has no number`, "bad");
    const changed = this.rows.filter((row) => row.value !== row.of.value);
    this.ask({ scene: this.select.value, set: Object.fromEntries(changed.map((row) => [row.of.key, row.value])) });
  }

  private say(words: string, tone = "plain"): void {
    by_id("picker_words").textContent = words;
    by_id("picker_words").dataset.tone = tone;
  }
}
