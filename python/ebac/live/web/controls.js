// Sliders over settings of the core: name, unit and range come from its catalogue.

import { quantity } from "./words.js";

/** What people move, in the order of the page; `decades`: equal ways are equal factors. */
export const SLIDERS = [
  { name: "environment.stiffness", label: "wall stiffness", unit: "kN/m", low: 500, high: 50e3, decades: true },
  { name: "timing.delay", label: "delay of the drive", unit: "samples", low: 0, high: 4 },
  { name: "hand.stiffness", label: "hand: stiffness", unit: "N/m", low: 50, high: 2000, decades: true },
  { name: "hand.damping", label: "hand: damping", unit: "N s/m", low: 0.5, high: 40, decades: true },
  { name: "hand.mass", label: "hand: mass", unit: "kg", low: 0.03, high: 1, decades: true },
  { name: "device.mechanics.damping", label: "device: damping", unit: "N s/m", low: 0, high: 8, step: 0.1 },
];

export function element(kind, parent, { text = "", name = "", ...attributes } = {}) {
  const made = document.createElement(kind);
  if (text) made.textContent = text;
  if (name) made.className = name;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent?.append(made);
  return made;
}

/** Build sliders into `parent`; `changed(name, value)` is called for every move. Returns `set(values)`. */
export function sliders(parent, controls, changed) {
  const places = controls.map((control) => {
    const label = element("label", parent, { name: "slider" });
    element("span", label, { text: control.label });
    const number = element("output", label);
    const to = control.decades ? Math.log10 : Number;
    const from = control.decades ? (place) => Number((10 ** place).toPrecision(3)) : Number;
    const input = element("input", label, {
      type: "range",
      min: to(control.low),
      max: to(control.high),
      step: control.decades ? (to(control.high) - to(control.low)) / 200 : (control.step ?? 1),
      "data-name": control.name,
      "aria-label": `${control.label} [${control.unit}]`,
    });
    const show = (value) => {
      const whole = control.unit === "samples";
      number.textContent = whole ? `${value} sample${value === 1 ? "" : "s"}` : quantity(value, control.unit);
    };
    input.addEventListener("input", () => {
      const value = from(Number(input.value));
      show(value);
      changed(control.name, value);
    });
    return (value) => {
      input.value = to(value);
      show(value);
    };
  });
  return (values) => controls.forEach(({ name }, i) => places[i](values[name]));
}
