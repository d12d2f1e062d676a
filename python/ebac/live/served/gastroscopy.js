// The page's side of a gastroscopy: frames in; start, pause and reset out.

const BACK = 10; // s
const NAMES = ["t", "force", "tube", "place"];
const $ = (id) => document.getElementById(id);
const columns = Object.fromEntries(NAMES.map((name) => [name, []]));
const live = (window.ebacServed = { frames: 0, drawn: 0, state: null, frame: null });
let run = -1, dirty = true, stripsAt = 0, lumen = null;

const outside = new Outside($("outside"));
const endoscope = new Endoscope($("camera"));
const send = (kind) => link.send({ kind });

const taken = {
  state(state) {
    live.state = state;
    const controls = state.role === "control";
    const others = state.pages > 1 ? ` ${state.pages} pages are open.` : "";
    $("link").textContent = `Simulated. ${controls ? "This page controls." : "This page only watches."}${others}`;
    $("run").textContent = state.running ? "Pause" : "Start";
    for (const id of ["run", "reset"]) $(id).disabled = !controls;
    $("take").hidden = !state.free;
    const rows = { law: state.law, "delay each way": `${(1e3 * state.delay_s).toFixed(0)} ms`,
      "force feedback": state.feedback ? `× ${state.feedback}` : "none",
      "physician heeds": state.heed_N ? `${state.heed_N} N` : "no force", "limit of the tissue": `${state.limit_N} N` };
    $("chosen").replaceChildren(...Object.entries(rows).map(([name, value]) => {
      const row = document.createElement("tr");
      for (const text of [name, value]) row.append(Object.assign(document.createElement("td"), { textContent: text }));
      return row;
    }));
    dirty = true;
  },
  shape: ({ shape }) => (lumen = new Lumen(shape)),
  history: ({ strips: more }) => append(more),
  error: ({ text }) => ($("error").textContent = text),
  frame(frame) {
    ++live.frames;
    if (frame.run !== run) {
      if (run >= 0) for (const name of NAMES) columns[name].length = 0;
      run = frame.run;
    }
    live.frame = frame;
    append(frame.strips);
    dirty = true;
  },
};

const link = new Link(taken, () => {
  $("link").textContent = "Not connected. It is where `ebac gastroscopy --live` runs; trying again …";
  live.state = null;
});

function append(more) {
  if (!more?.t?.length) return;
  const last = columns.t.at(-1) ?? -1;
  more.t.forEach((t, i) => t > last && NAMES.forEach((name) => columns[name].push(more[name][i])));
  const old = columns.t.findIndex((t) => t > columns.t.at(-1) - BACK);
  if (old > 100) for (const name of NAMES) columns[name].splice(0, old);
}

function words({ reached, fault, touched, phase, force, most, over }, { limit_N: limit, targets, running }) {
  const shown = most.toFixed(1);
  if (fault) return ["bad", `Stopped by fault ${fault}`, "Reset begins anew."];
  if (reached) return [over > 0 ? "fair" : "good", "Pylorus passed", `${touched} of ${targets} targets touched; ${over > 0 ? `${shown} N at most, above the limit` : `never above ${limit} N`}.`];
  if (!running) return ["free", "Paused", `${phase}.`];
  if (force > limit) return ["bad", "Above the limit", `${force.toFixed(1)} N on the tissue.`];
  if (over > 0) return ["fair", "Was above the limit", `${phase}; ${shown} N at most.`];
  return ["good", "Within the limit", `${phase}; ${shown} N at most, ${limit} N allowed.`];
}

function theme() {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(["ink", "soft", "grid", "axis", "hand", "bad", "good", "tissue", "scope", "target"].map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}
const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
const points = (flat) => Array.from({ length: flat.length / 3 }, (_, i) => flat.slice(3 * i, 3 * i + 3).map((x) => 1e-4 * x));

function paint(now) {
  requestAnimationFrame(paint);
  const { frame, state } = live;
  if (!dirty || !frame || !state) return;
  dirty = false;
  const look = theme();
  const colours = Object.fromEntries(["hand", "bad", "tissue", "scope", "target"].map((name) => [name, rgb(look[name])]));
  colours.section = colours.scope.map((x) => 0.6 * x + 0.25);
  lumen?.move(frame.wall, frame.radius);
  const scene = { at: frame.at.map((x) => 1e-4 * x), ahead: frame.ahead, right: frame.right, lumen, tube: points(frame.tube),
    targets: frame.targets.map((p) => p.map((x) => 1e-4 * x)), colours, force: frame.force, limit: state.limit_N,
    tip: state.tip_m, diameter: state.diameter_m, field: state.field_rad };
  outside.draw(scene);
  endoscope.draw(scene);
  const texts = { force: `${frame.force.toFixed(2)} N`, most: `${frame.most.toFixed(2)} N`, place: `${(100 * frame.place).toFixed(1)} cm`,
    touched: `${frame.touched} of ${state.targets}`, t: `${frame.t.toFixed(1)} s`, felt: `${frame.on_hand.toFixed(2)} N`,
    over: `${(1e3 * frame.over).toFixed(0)} ms`, energy: `${(1e3 * frame.energy).toFixed(1).replace("-", "−")} mJ` };
  for (const [id, text] of Object.entries(texts)) $(id).textContent = text;
  const [kind, head, more] = words(frame, state);
  $("verdict").dataset.kind = kind;
  $("verdict").children[0].textContent = head;
  $("verdict").children[1].textContent = more;
  if (now - stripsAt > 90 && columns.t.length > 1) {
    stripsAt = now;
    const to = columns.t.at(-1);
    strips($("strips"), { t: columns.t, panels: [
      { label: "force [N]", least: 2, marks: [{ value: 0 }, { value: state.limit_N, name: "limit", colour: look.bad }], lines: [
        { name: "tube", y: columns.tube, colour: look.axis, width: 1.2 },
        { name: "tip, section", y: columns.force, colour: look.hand, width: 2 },
      ] },
      { label: "depth [cm]", least: 4, marks: [], lines: [{ y: columns.place.map((x) => 100 * x), colour: look.scope, width: 2 }] },
    ] }, { from: Math.max(columns.t[0], to - BACK), to: Math.max(to, columns.t[0] + 1), theme: look });
  }
  ++live.drawn;
}

let dragged = null;
$("outside").addEventListener("pointerdown", (event) => ($("outside").setPointerCapture(event.pointerId), (dragged = [event.clientX, event.clientY])));
$("outside").addEventListener("pointermove", (event) => {
  if (!dragged) return;
  outside.turn += 0.008 * (event.clientX - dragged[0]);
  outside.tilt = Math.min(1.4, Math.max(-1.4, outside.tilt + 0.008 * (event.clientY - dragged[1])));
  dragged = [event.clientX, event.clientY];
  dirty = true;
});
for (const name of ["pointerup", "pointercancel"]) $("outside").addEventListener(name, () => (dragged = null));
$("outside").addEventListener("wheel", (event) => {
  event.preventDefault();
  outside.far = Math.min(1.6, Math.max(0.3, outside.far * Math.exp(1e-3 * event.deltaY)));
  dirty = true;
}, { passive: false });
$("run").addEventListener("click", () => send(live.state?.running ? "pause" : "start"));
$("reset").addEventListener("click", () => send("reset"));
$("take").addEventListener("click", () => send("take"));
window.addEventListener("resize", () => (dirty = true));
link.open();
requestAnimationFrame(paint);
