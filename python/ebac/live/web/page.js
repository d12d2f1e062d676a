// The page without a server: the loop in the browser, as fast as time passes, and the mouse as the hand.

import { Core, load } from "./core.js";
import { SLIDERS, element, sliders } from "./controls.js";
import { scene, view } from "./scene.js";
import { Sound } from "./sound.js";
import { panels, strips } from "./strips.js";
import { energy, idealRest, quantity, verdict } from "./words.js";

const WINDOW = 2; // s, shown in the strips
const ROWS = 2048; // of them
const WALL = 0; // m, its surface
const REACH = { low: -0.025, high: 0.06 }; // m, of the hand
const FIRST = ["tca", "tca-damped", "eba", "ebac"];
const SHOWN = ["x", "f_env", "f_cmd", "f_applied", "energy"];
const JUDGED = 700; // ticks without a change, before the page speaks of a contact
const MOST = 250; // ticks of a frame: a page that was hidden does not catch up

export class Page {
  constructor(core, facts) {
    this.core = core;
    this.facts = facts;
    this.sound = new Sound();
    this.law = "tca";
    this.observer = 1;
    this.speed = 1;
    this.paused = false;
    this.ticks = 0;
    this.dragging = false;
    this.target = 0.04;
    this.rows = Object.fromEntries(["t", ...SHOWN].map((name) => [name, new Float64Array(ROWS)]));
    this.frame = { least: 0, most: 0 };
    this.due = 0;
    const defaults = Object.fromEntries(core.catalogue.settings.map((one) => [one.name, one.default]));
    this.values = Object.fromEntries(SLIDERS.map(({ name }) => [name, defaults[name]]));
    this.find();
    this.build();
    this.restart();
    this.last = performance.now();
    requestAnimationFrame((now) => this.draw(now));
    setInterval(() => this.judge(), 200);
  }

  find() {
    for (const id of ["scene", "strips", "laws", "more", "sliders", "hand", "verdict", "about", "sound", "pause",
      "again", "speed", "observer", "error", "x", "force", "ripple", "energy"]) {
      this[`${id}At`] = document.getElementById(id);
    }
  }

  build() {
    for (const name of FIRST) {
      const button = element("button", this.lawsAt, { text: name, type: "button", "data-law": name });
      button.style.setProperty("--law", this.facts.colours[name]);
      button.addEventListener("click", () => this.choose(name));
    }
    element("option", this.moreAt, { text: "more laws …", value: "" });
    for (const { name } of this.core.catalogue.laws) {
      if (!FIRST.includes(name)) element("option", this.moreAt, { text: name, value: name });
    }
    this.moreAt.addEventListener("change", () => this.moreAt.value && this.choose(this.moreAt.value));
    this.place = sliders(this.slidersAt, SLIDERS, (name, value) => this.change(name, value));
    this.place(this.values);
    for (const { name, about } of this.facts.hands) element("option", this.handAt, { text: about, value: name });
    this.handAt.addEventListener("change", () => this.hold(this.handAt.value));
    this.soundAt.addEventListener("click", async () => {
      const on = await this.sound.toggle();
      this.soundAt.setAttribute("aria-pressed", on);
      this.soundAt.textContent = `Sound ${on ? "on" : "off"}`;
    });
    this.pauseAt.addEventListener("click", () => this.pause(!this.paused));
    this.againAt.addEventListener("click", () => this.restart());
    this.speedAt.addEventListener("change", () => { this.speed = Number(this.speedAt.value); });
    this.observerAt.addEventListener("change", () => {
      this.observer = this.observerAt.checked ? 1 : 0;
      this.restart();
    });
    this.grab();
  }

  /** The mouse, a finger or the arrow keys move where the hand wants to be. */
  grab() {
    const canvas = this.sceneAt;
    const metres = (event) => {
      const box = canvas.getBoundingClientRect();
      const { from, to } = view(box.width);
      const radius = (20 / box.width) * (to - from);
      return from + ((event.clientX - box.left) / box.width) * (to - from) + radius;
    };
    canvas.addEventListener("pointerdown", (event) => {
      this.dragging = true;
      this.offset = this.target - metres(event);
      if (Math.abs(this.offset) > 0.012) this.offset = 0;
      canvas.setPointerCapture(event.pointerId);
      this.aim(metres(event) + this.offset);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (this.dragging) this.aim(metres(event) + this.offset);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, () => { this.dragging = false; });
    }
    canvas.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!way) return;
      event.preventDefault();
      this.aim(this.target + way * 0.002);
    });
  }

  choose(law) {
    this.law = law;
    this.restart();
  }

  hold(name) {
    const hand = this.facts.hands.find((one) => one.name === name);
    Object.assign(this.values, hand.settings);
    this.place(this.values);
    this.restart();
  }

  change(name, value) {
    this.values[name] = value;
    if (name === "environment.stiffness") {
      this.core.wall(value, WALL);
      this.fresh();
    } else {
      this.restart();
    }
  }

  aim(target) {
    this.target = Math.min(REACH.high, Math.max(REACH.low, target));
    this.core.aim(this.target);
    this.fresh();
  }

  pause(paused) {
    this.paused = paused;
    this.pauseAt.setAttribute("aria-pressed", paused);
    this.pauseAt.textContent = paused ? "Go on" : "Pause";
  }

  /** From the first row on, with what is chosen; the hand pulls to where it was. */
  restart() {
    const path = { "hand.path.target": this.target, "environment.position": WALL };
    this.errorAt.textContent = "";
    try {
      this.core.start(this.law, { ...this.values, ...path }, { observer: this.observer });
    } catch (error) {
      this.errorAt.textContent = error.message;
      return;
    }
    this.fault = 0;
    this.touched = false;
    this.fresh();
    for (const button of this.lawsAt.querySelectorAll("button")) {
      button.setAttribute("aria-pressed", button.dataset.law === this.law);
    }
    this.moreAt.value = FIRST.includes(this.law) ? "" : this.law;
    const { summary } = this.core.catalogue.laws.find(({ name }) => name === this.law);
    this.aboutAt.textContent = `${this.law}: ${this.facts.abouts[this.law] ?? summary}.`;
  }

  /** What was measured so far belongs to another contact. */
  fresh() {
    this.core.watch(1000);
    this.since = this.ticks;
  }

  /** Run `ticks` of the loop; what a frame does, and what a test asks for. */
  advance(ticks) {
    const made = this.core.step(ticks);
    if (made.rows === 0) return;
    this.frame = { least: Infinity, most: -Infinity };
    for (let k = 0; k < made.rows; ++k) {
      const row = (this.ticks + k) % ROWS;
      this.rows.t[row] = (this.ticks + k) / 1000; // of the page: a run that starts again follows the last one
      for (const name of SHOWN) this.rows[name][row] = made[name][k];
      this.frame.least = Math.min(this.frame.least, made.x[k]);
      this.frame.most = Math.max(this.frame.most, made.x[k]);
    }
    this.touched ||= made.f_env.some((force) => force !== 0);
    this.ticks += made.rows;
    this.fault = made.fault;
    if (this.speed === 1) this.sound.play(made.f_applied, 1e-3);
  }

  now(name) { return this.rows[name][(this.ticks - 1 + ROWS) % ROWS]; }

  /** The last rows of the window, oldest first. */
  shown() {
    const count = Math.min(this.ticks, Math.round(WINDOW * 1000), ROWS);
    const from = this.ticks - count;
    const column = (name) => Float64Array.from({ length: count }, (_, k) => this.rows[name][(from + k) % ROWS]);
    return Object.fromEntries(["t", ...SHOWN].map((name) => [name, column(name)]));
  }

  draw(now) {
    const passed = (now - this.last) / 1000;
    this.last = now;
    if (!this.paused && this.fault === 0) {
      this.due = Math.min(MOST, this.due + passed * 1000 * this.speed);
      const ticks = Math.floor(this.due);
      this.due -= ticks;
      this.advance(ticks);
    }
    const theme = this.theme();
    const colour = lit(this.facts.colours[this.law] ?? "#555555", theme.lit);
    scene(this.sceneAt, {
      wall: WALL, x: this.now("x"), ...this.frame, target: this.target, force: this.now("f_applied"), colour,
      pulled: this.dragging, theme,
    });
    this.curves(colour, theme);
    requestAnimationFrame((next) => this.draw(next));
  }

  theme() {
    const style = getComputedStyle(document.documentElement);
    const of = (name) => style.getPropertyValue(`--${name}`).trim();
    return { ink: of("ink"), soft: of("soft"), grid: of("grid"), axis: of("axis"), wall: of("wall"), hatch: of("hatch"), hand: of("hand"), bad: of("bad"), lit: Number(of("lit")) };
  }

  curves(colour, theme) {
    const last = Math.max(WINDOW, this.now("t"));
    const ideal = this.ideal();
    const landmarks = { surface: WALL, ...(ideal === null ? {} : { "ideal wall": ideal }) };
    strips(this.stripsAt, panels(this.shown(), landmarks, colour, theme), { from: last - WINDOW, to: last, theme });
  }

  ideal() {
    return idealRest({ stiffness: this.values["environment.stiffness"], position: WALL,
      hand: this.values["hand.stiffness"], target: this.target });
  }

  judge() {
    const x = this.now("x");
    this.xAt.textContent = quantity(x - WALL, "mm");
    this.forceAt.textContent = quantity(this.now("f_applied"), "N");
    this.energyAt.textContent = energy(this.now("energy"));
    const waits = this.ticks - this.since < JUDGED;
    let said = { kind: "wait", head: this.dragging ? "Moving" : "Listening", more: "The verdict comes when the hand holds still." };
    let measured = null;
    if (this.fault !== 0) said = { kind: "bad", head: `Fault ${this.fault}`, more: "The loop stopped; start it again." };
    else if (!waits) {
      measured = this.core.measure();
      said = verdict(measured, this.ideal(), this.touched);
    }
    this.measured = measured;
    this.rippleAt.textContent = measured ? quantity(measured.force_swing, "N") : "–";
    this.verdictAt.dataset.kind = said.kind;
    this.verdictAt.firstElementChild.textContent = said.head;
    let more = said.more;
    if (this.now("energy") < -0.02) more += ` The wall has given ${energy(-this.now("energy"))} to the hand.`;
    this.verdictAt.lastElementChild.textContent = more;
  }
}

/** A colour on its way to white by `share`: those of the figures are made for paper. */
function lit(colour, share) {
  const parts = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return `#${parts.map((one) => Math.round(one + share * (255 - one)).toString(16).padStart(2, "0")).join("")}`;
}

/** Begin with the module and the facts that stand in the page. */
export async function begin(module, facts) {
  const started = performance.now();
  const bytes = Uint8Array.from(atob(module), (c) => c.charCodeAt(0));
  const core = await load(bytes);
  window.ebacLive = new Page(core, facts);
  window.ebacLive.loaded = performance.now() - started;
}
