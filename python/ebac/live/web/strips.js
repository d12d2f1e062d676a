// Curves over time, one panel below the other, in one canvas.

const LEFT = 52, RIGHT = 10, TOP = 20, GAP = 26, BOTTOM = 26;

/** Size a canvas to its box on the screen and return its context and size [pixels of CSS]. */
export function fitted(canvas) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const scale = window.devicePixelRatio || 1;
  const [w, h] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  const g = canvas.getContext("2d");
  g.setTransform(scale, 0, 0, scale, 0, 0);
  g.clearRect(0, 0, width, height);
  return { g, width, height };
}

/** Steps of 1, 2 or 5 that give about `count` lines between two values, at least two. */
export function ticks(low, high, count) {
  const raw = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(raw));
  const steps = [10, 5, 2, 1, 0.5].map((n) => n * power);
  const first = (step) => Math.ceil(low / step), last = (step) => Math.floor(high / step);
  const step = steps.findLast((one) => one >= raw && last(one) > first(one)) ?? steps.find((one) => last(one) > first(one));
  const found = [];
  for (let n = first(step); n <= last(step); ++n) found.push(n * step);
  return { values: found, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9)) };
}

/** What a run shows: position, force and energy of its columns [SI]; `landmarks` are places [m] by name. */
export function panels(columns, landmarks, colour, theme) {
  const thousand = (values) => values.map((value) => 1e3 * value);
  const large = columns.energy.some((value) => Math.abs(value) >= 1);
  const marks = Object.entries(landmarks).map(([name, value]) => ({ name, value: 1e3 * value, colour: name === "surface" ? theme.axis : theme.hand }));
  return {
    t: columns.t,
    panels: [
      { label: "position [mm]", least: 4, marks, lines: [{ name: "handle", y: thousand(columns.x), colour, width: 2 }] },
      { label: "force [N]", least: 4, marks: [{ value: 0 }], lines: [
        { name: "asked", y: columns.f_env, colour: theme.axis, width: 1.2 },
        { name: "allowed", y: columns.f_cmd, colour, width: 2 },
      ] },
      { label: `energy taken from the hand [${large ? "J" : "mJ"}]`, least: large ? 1 : 20, marks: [{ value: 0 }],
        below: `${theme.bad}22`, lines: [{ y: large ? columns.energy : thousand(columns.energy), colour, width: 2 }] },
    ],
  };
}

/**
 * Draw `{ t, panels }` from the time `from` to `to` [s]: panels are `{ label, least, lines: [{ name, y, colour, width }],
 * marks: [{ value, name }], below }`. `least` is the smallest height of the scale; `below` colours what is under zero.
 */
export function strips(canvas, { t, panels }, { from, to, theme }) {
  const { g, width, height } = fitted(canvas);
  const high = (height - TOP - BOTTOM - GAP * (panels.length - 1)) / panels.length;
  const x = (time) => LEFT + ((width - LEFT - RIGHT) * (time - from)) / (to - from);
  g.lineJoin = "round";
  panels.forEach((panel, i) => drawPanel(g, t, x, panel, TOP + i * (high + GAP), high, width, theme));
  g.fillStyle = theme.soft;
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "center";
  const times = ticks(from, to, width < 500 ? 4 : 8);
  for (const time of times.values) g.fillText(`${time.toFixed(times.digits)} s`, Math.min(x(time), width - 20), height - 9);
}

function range(panel) {
  let [low, high] = [Infinity, -Infinity];
  const take = (value) => {
    if (value < low) low = value;
    if (value > high) high = value;
  };
  for (const { y } of panel.lines) for (let k = 0; k < y.length; ++k) take(y[k]);
  for (const { value } of panel.marks ?? []) take(value);
  if (!(low <= high)) [low, high] = [0, 0];
  const room = Math.max(0.08 * (high - low), 0.5 * (panel.least - (high - low)));
  return [low - room, high + room];
}

function drawPanel(g, t, x, panel, top, high, width, theme) {
  const [low, most] = range(panel);
  const y = (value) => top + (high * (most - value)) / (most - low);
  g.fillStyle = theme.ground ?? "transparent";
  g.fillRect(LEFT, top, width - LEFT - RIGHT, high);
  g.font = "11px system-ui, sans-serif";
  g.lineWidth = 1;
  const lines = ticks(low, most, Math.max(2, high / 34));
  g.textAlign = "right";
  for (const value of lines.values) {
    g.strokeStyle = Math.abs(value) < 1e-12 ? theme.axis : theme.grid;
    stroke(g, [[LEFT, y(value)], [width - RIGHT, y(value)]]);
    g.fillStyle = theme.soft;
    g.fillText(value.toFixed(lines.digits).replace("-", "−"), LEFT - 6, y(value) + 4);
  }
  g.save();
  g.beginPath();
  g.rect(LEFT, top - 2, width - LEFT - RIGHT, high + 4);
  g.clip();
  if (panel.below && low < 0) {
    g.fillStyle = panel.below;
    g.fillRect(LEFT, y(0), width - LEFT - RIGHT, y(low) - y(0));
  }
  g.setLineDash([5, 4]);
  for (const mark of panel.marks ?? []) {
    g.strokeStyle = mark.colour ?? theme.axis;
    stroke(g, [[LEFT, y(mark.value)], [width - RIGHT, y(mark.value)]]);
  }
  g.setLineDash([]);
  for (const line of panel.lines) curve(g, t, line, x, y);
  g.restore();
  legend(g, panel, top, width, theme);
}

/** Of the rows on one column of pixels the least and the most are drawn: no peak is lost. NaN leaves a gap. */
function curve(g, t, line, x, y) {
  g.strokeStyle = line.colour;
  g.lineWidth = line.width ?? 1.5;
  g.beginPath();
  let [column, low, high, last, gap] = [NaN, 0, 0, 0, true];
  const to = (value) => {
    if (gap) g.moveTo(column - 0.5, y(value)); // a value between two gaps is seen, too
    g.lineTo(column, y(value));
    gap = false;
  };
  const flush = () => {
    if (Number.isNaN(column)) return;
    if (low !== high) for (const value of [low, high]) to(value);
    to(last);
  };
  for (let k = 0; k < t.length; ++k) {
    const value = line.y[k];
    const at = Number.isNaN(value) ? NaN : Math.round(x(t[k]) * 2) / 2;
    if (at !== column) {
      flush();
      gap ||= Number.isNaN(at);
      [column, low, high] = [at, value, value];
    }
    low = Math.min(low, value);
    high = Math.max(high, value);
    last = value;
  }
  flush();
  g.stroke();
}

function legend(g, panel, top, width, theme) {
  g.font = "600 12px system-ui, sans-serif";
  g.textAlign = "left";
  g.fillStyle = theme.ink;
  g.fillText(panel.label, LEFT, top - 7);
  g.font = "11px system-ui, sans-serif";
  let right = width - RIGHT;
  const named = [...(panel.marks ?? []).map((m) => ({ colour: theme.axis, ...m, dashed: true })), ...panel.lines];
  if (panel.below && width > 500) named.push({ name: "given by the wall", colour: panel.below });
  for (const one of named.filter(({ name }) => name && (name !== "surface" || width > 500)).reverse()) {
    g.textAlign = "right";
    g.fillStyle = theme.soft;
    g.fillText(one.name, right, top - 7);
    right -= g.measureText(one.name).width + 6;
    g.strokeStyle = one.colour;
    g.lineWidth = one.dashed ? 1 : one.colour === panel.below ? 9 : 2.5;
    g.setLineDash(one.dashed ? [4, 3] : []);
    stroke(g, [[right - 16, top - 11], [right, top - 11]]);
    g.setLineDash([]);
    right -= 28;
  }
}

function stroke(g, points) {
  g.beginPath();
  points.forEach(([px, py], i) => (i ? g.lineTo(px, py) : g.moveTo(px, py)));
  g.stroke();
}
