// The page's side of `ebac live`: frames of the loop in, orders of the hand out.

const BACK = 10; // s
const NAMES = ["t", "x", "f_env", "f_cmd", "f_meas", "beta", "energy"];
const BEAT = 100; // ms, while the dead-man key is held
const $ = (id) => document.getElementById(id);
const columns = Object.fromEntries(NAMES.map((name) => [name, []]));
const live = (window.ebacServed = { frames: 0, drawn: 0, state: null, frame: null, drawnX: null, opened: performance.now() });
let run = -1, dirty = true, stripsAt = 0, beat = 0;

const scene = new Scene($("scene"));
const send = (message) => link.send(message);
const showForm = form($("form"), (name, value) => ($("error").textContent = "", send({ kind: "change", name, value })));
live.dragTo = (place) => send({ kind: "drag", place });

dragging($("scene"), scene, {
  hand: () => live.frame?.target,
  drag: (place) => live.dragTo(place.map((x) => Math.min(0.2, Math.max(-0.2, x)))),
  drop: () => send({ kind: "drop" }),
  changed: () => (dirty = true),
});

const taken = {
  state(state) {
    live.state = state;
    showForm(state);
    const controls = state.role === "control";
    const others = state.pages > 1 ? ` ${state.pages} pages are open.` : "";
    const drives = state.real ? "Real drives." : state.virtual ? "Simulated drives, virtual clock." : "Simulated drives.";
    $("link").textContent = `${drives} ${controls ? "This page controls." : "This page only watches."}${others}`;
    $("run").textContent = state.running ? "Pause" : "Start";
    $("record").textContent = state.recording ? "Stop recording" : "Record";
    $("record").setAttribute("aria-pressed", state.recording);
    for (const id of ["run", "reset", "record", "save"]) $(id).disabled = !controls;
    for (const button of $("modes").children) button.disabled = !controls;
    $("modes").hidden = $("hint").hidden = state.real;
    $("dead").hidden = !state.dead_man || !controls;
    $("take").hidden = !state.free;
    $("notice").textContent = state.notice;
    dirty = true;
  },
  shape({ shape }) {
    scene.shape(shape);
    dirty = true;
  },
  history: ({ strips: more }) => append(more),
  error: ({ text }) => ($("error").textContent = text),
  frame(frame) {
    ++live.frames;
    if (frame.run !== run) {
      if (run >= 0) for (const name of NAMES) columns[name].length = 0;
      run = frame.run;
    }
    live.frame = { ...live.frame, ...frame };
    append(frame.strips);
    if (frame.verdict) judge(frame);
    dirty = true;
  },
};

const link = new Link(taken, () => {
  $("link").textContent = "Not connected. The loop is where `ebac live` runs; trying again …";
  live.state = null;
});

function append(more) {
  if (!more?.t?.length) return;
  const last = columns.t.at(-1) ?? -1;
  more.t.forEach((t, i) => t > last && NAMES.forEach((name) => columns[name].push(more[name]?.[i] ?? NaN)));
  const old = columns.t.findIndex((t) => t > columns.t.at(-1) - BACK);
  if (old > 200) for (const name of NAMES) columns[name].splice(0, old);
}

function judge({ verdict, late_us: late, skipped }) {
  $("verdict").dataset.kind = verdict.kind;
  $("verdict").children[0].textContent = verdict.head;
  $("verdict").children[1].textContent = verdict.more;
  $("late").textContent = late === undefined ? "–" : `${late.toFixed(0)} µs`;
  $("skipped").textContent = skipped ?? "–";
}

const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
function theme() {
  const style = getComputedStyle(document.documentElement);
  const of = (name) => style.getPropertyValue(`--${name}`).trim();
  return Object.fromEntries(["ink", "soft", "grid", "axis", "hand", "bad", "good"].map((name) => [name, of(name)]));
}

function paint(now) {
  requestAnimationFrame(paint);
  if (!dirty || !live.frame) return;
  dirty = false;
  const { x = [0], force = [0], target = [0] } = live.frame;
  const colour = COLOURS[live.state?.choices.law] ?? "#444444";
  scene.draw({ x, force, target, law: rgb(colour) });
  const minus = (value, digits) => value.toFixed(digits).replace("-", "−");
  $("x").textContent = `${minus(1e3 * x[0], 2)} mm`;
  $("force").textContent = `${minus(Math.hypot(...force), 2)} N`;
  if (now - stripsAt > 90 && columns.t.length > 1) {
    stripsAt = now;
    drawStrips(colour);
  }
  live.drawnX = x[0];
  ++live.drawn;
  live.first ??= performance.now();
}

function drawStrips(colour) {
  const look = theme();
  const thousand = (values) => values.map((value) => 1e3 * value);
  const to = columns.t.at(-1);
  const beta = { label: "beta [N/m]", least: 1, marks: [], lines: [{ y: columns.beta, colour, width: 1.5 }] };
  strips($("strips"), {
    t: columns.t,
    panels: [
      { label: "position [mm]", least: 4, marks: [], lines: [{ name: "handle", y: thousand(columns.x), colour, width: 2 }] },
      { label: "force [N]", least: 4, marks: [{ value: 0 }], lines: [
        { name: "asked", y: columns.f_env, colour: look.axis, width: 1.2 },
        { name: "allowed", y: columns.f_cmd, colour, width: 2 },
        { name: "measured", y: columns.f_meas, colour: look.hand, width: 1 },
      ] },
      ...(columns.beta.every(Number.isNaN) ? [] : [beta]), // with the observer there is none
      { label: "energy taken in [mJ]", least: 20, marks: [{ value: 0 }], below: `${look.bad}22`, lines: [{ y: thousand(columns.energy), colour, width: 2 }] },
    ],
  }, { from: Math.max(columns.t[0], to - BACK), to: Math.max(to, columns.t[0] + 1), theme: look });
}

function held(on) {
  clearInterval(beat);
  beat = 0;
  $("dead").classList.toggle("held", on);
  if (on) {
    send({ kind: "hold" });
    send({ kind: "start" });
    beat = setInterval(() => send({ kind: "hold" }), BEAT);
  } else send({ kind: "release" });
}
$("dead").addEventListener("pointerdown", (event) => ($("dead").setPointerCapture(event.pointerId), held(true)));
for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) $("dead").addEventListener(name, () => beat && held(false));
const isKey = (event) => event.code === "Space" && !$("dead").hidden;
window.addEventListener("keydown", (event) => isKey(event) && (event.preventDefault(), event.repeat || held(true)));
window.addEventListener("keyup", (event) => isKey(event) && (event.preventDefault(), held(false)));
for (const name of ["blur", "visibilitychange"]) window.addEventListener(name, () => beat && held(false));

$("run").addEventListener("click", () => send({ kind: live.state?.running ? "pause" : "start" }));
$("reset").addEventListener("click", () => send({ kind: "reset" }));
$("record").addEventListener("click", () => send({ kind: "record", on: !live.state?.recording }));
$("save").addEventListener("click", () => send({ kind: "save" }));
$("take").addEventListener("click", () => send({ kind: "take" }));
$("modes").addEventListener("click", ({ target }) => target.dataset.mode && send({ kind: "mode", mode: target.dataset.mode }));
window.addEventListener("resize", () => (dirty = true));
link.open();
requestAnimationFrame(paint);
