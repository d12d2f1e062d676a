// Sliders beside three panels. One simulation is under way at a time: what is moved meanwhile is sent when it is drawn.
const PANEL = 150, LEFT = 58, RIGHT = 24, BOTTOM = 34, TOP = 8;

function element(kind, parent, text = "", style = "") {
  const made = document.createElement(kind);
  made.textContent = text;
  made.style.cssText = style;
  parent.append(made);
  return made;
}

function shown(value, control) {
  const digits = control.step >= 1 ? String(Math.round(value)) : Number(value.toPrecision(3)).toString();
  return `${digits} ${control.unit}`;
}

function same(one, other) {
  return Object.keys(one).every((name) => one[name] === other[name]);
}

function render({ model, el }) {
  const box = element("div", el, "", "display:flex;gap:16px;flex-wrap:wrap;font:13px sans-serif;color:#222;background:#fff;padding:8px");
  const side = element("div", box, "", "width:230px");
  const right = element("div", box, "", "flex:1;min-width:420px");
  const canvas = element("canvas", right, "", "width:100%");
  const verdict = element("div", right, "", "margin-top:4px");
  verdict.setAttribute("role", "status");

  let waiting = false, next = null;
  function send(values) {
    if (waiting) { next = values; return; }
    if (same(values, model.get("values"))) return;  // moved forth and back: no answer would come
    waiting = true;
    model.set("values", values);
    model.save_changes();
  }
  function change(name, value) {
    send({ ...(next ?? model.get("values")), [name]: value });
  }

  const law = element("select", element("label", side, "law ", "display:block;margin-bottom:10px"));
  for (const name of model.get("laws")) element("option", law, name).value = name;
  law.value = model.get("values").law;
  law.addEventListener("change", () => change("law", law.value));

  const inputs = new Map();
  for (const control of model.get("controls")) {
    const label = element("label", side, "", "display:block;margin-bottom:8px");
    const line = element("div", label, "", "display:flex;justify-content:space-between");
    element("span", line, control.label);
    const number = element("span", line);
    const input = element("input", label, "", "width:100%");
    input.type = "range";
    const to = control.decades ? Math.log10 : (x) => x;
    const from = control.decades ? (x) => 10 ** x : (x) => x;
    input.min = to(control.low);
    input.max = to(control.high);
    input.step = control.step || (to(control.high) - to(control.low)) / 400;
    input.addEventListener("input", () => {
      const value = from(Number(input.value));
      number.textContent = shown(value, control);
      change(control.name, value);
    });
    inputs.set(control.name, (value) => {
      input.value = to(value);
      number.textContent = shown(value, control);
    });
  }
  const place = () => {
    const values = model.get("values");
    law.value = values.law;
    for (const [name, set] of inputs) set(values[name]);
  };

  function draw() {
    const picture = model.get("picture");
    if (!picture.t) return;
    const floats = (data) => new Float32Array(data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength));
    const t = floats(picture.t), panels = picture.panels;
    const width = canvas.clientWidth || 600, height = panels.length * PANEL + BOTTOM;
    const scale = window.devicePixelRatio || 1;
    canvas.width = width * scale;
    canvas.height = height * scale;
    canvas.style.height = `${height}px`;
    const g = canvas.getContext("2d");
    g.scale(scale, scale);
    g.font = "12px sans-serif";
    const x = (time) => LEFT + (width - LEFT - RIGHT) * (time - t[0]) / (t[t.length - 1] - t[0]);
    panels.forEach((panel, i) => panelOf(g, panel, floats, t, x, TOP + i * PANEL, PANEL - 18, width));
    g.fillStyle = "#222";
    g.textAlign = "center";
    for (let s = Math.ceil(t[0] * 4) / 4; s <= t[t.length - 1] + 1e-6; s += Math.max(0.25, (t[t.length - 1] - t[0]) / 8)) {
      g.fillText(s.toFixed(2), x(s), height - 20);
    }
    g.fillText("time [s]", (width + LEFT - RIGHT) / 2, height - 5);
    const error = model.get("error");
    verdict.textContent = error || `simulated: ${model.get("verdict")}`;
    verdict.style.color = error ? "#b00020" : "#222";
  }

  function panelOf(g, panel, floats, t, x, top, high, width) {
    const lines = panel.lines.map((line) => ({ ...line, y: floats(line.y) }));
    let least = Infinity, most = -Infinity;
    for (const { y } of lines) for (const value of y) {
      if (value < least) least = value;
      if (value > most) most = value;
    }
    const room = 0.06 * (most - least || 1);
    least -= room;
    most += room;
    const at = (value) => top + high * (most - value) / (most - least);
    g.strokeStyle = "#ddd";
    g.strokeRect(LEFT, top, width - LEFT - RIGHT, high);
    if (least < 0 && most > 0) {
      g.beginPath();
      g.moveTo(LEFT, at(0));
      g.lineTo(width - RIGHT, at(0));
      g.stroke();
    }
    g.fillStyle = "#222";
    g.textAlign = "right";
    for (const value of [least + room, most - room]) g.fillText(Number(value.toPrecision(3)), LEFT - 4, at(value) + 4);
    g.save();
    g.translate(12, top + high / 2);
    g.rotate(-Math.PI / 2);
    g.textAlign = "center";
    g.fillText(panel.label, 0, 0);
    g.restore();
    lines.forEach((line, i) => {
      g.strokeStyle = g.fillStyle = line.colour;
      g.lineWidth = 1.2;
      g.beginPath();
      for (let k = 0; k < line.y.length; ++k) g.lineTo(x(t[k]), at(line.y[k]));
      g.stroke();
      g.textAlign = "right";
      g.fillText(line.name, width - RIGHT - 6, top + 14 + 14 * i);
    });
  }

  const done = () => {
    draw();
    waiting = false;
    if (next !== null) {
      const values = next;
      next = null;
      send(values);
    }
  };
  model.on("change:serial", done);
  model.on("change:values", () => { if (!waiting) place(); });
  place();
  requestAnimationFrame(draw);
}

export default { render };
