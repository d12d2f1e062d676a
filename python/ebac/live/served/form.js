// Controls for what can be chosen.

const PICKS = { law: "Law", world: "World", hand: "Hand", device: "Device" };
const SLIDERS = {
  stiffness: { label: "Stiffness", to: (v) => Math.log10(v), from: (p) => Math.round(10 ** p / 100) * 100, step: 0.01, text: (v) => `${(v / 1e3).toFixed(1)} kN/m` },
  damping: { label: "Damping", to: (v) => v, from: (p) => p, step: 1, text: (v) => `${v.toFixed(0)} N s/m` },
  delay: { label: "Delay", to: (v) => v, from: (p) => p, step: 1, text: (v) => `${v} sample${v === 1 ? "" : "s"}` },
};
const PAUSE = 80; // ms between two changes of a slider

/** Builds the form at the first state; returns what shows a state. */
export function form(place, change) {
  let shown = null;
  const fields = {};
  const build = ({ options, ranges }) => {
    for (const [name, label] of Object.entries(PICKS)) {
      const pick = document.createElement("label");
      pick.className = "pick";
      const select = (fields[name] = document.createElement("select"));
      select.id = `pick-${name}`;
      for (const one of options[name]) select.add(new Option(one, one));
      select.addEventListener("change", () => change(name, select.value));
      pick.append(label, select);
      place.append(pick);
    }
    for (const [name, slider] of Object.entries(SLIDERS)) place.append(sliding(name, slider, ranges[name]));
    const check = document.createElement("label");
    check.className = "check";
    const box = (fields.observer = Object.assign(document.createElement("input"), { type: "checkbox", id: "observer" }));
    box.addEventListener("change", () => change("observer", box.checked));
    check.append(box, " Observer (restarts the loop)");
    place.append(check);
  };
  const sliding = (name, { label, to, from, step, text }, [low, high]) => {
    const row = document.createElement("label");
    row.className = "slider";
    const out = document.createElement("output");
    const input = Object.assign(document.createElement("input"), { type: "range", id: `slide-${name}`, min: to(low), max: to(high), step });
    let timer = 0;
    const value = () => Math.min(high, Math.max(low, from(Number(input.value))));
    input.addEventListener("change", () => name === "delay" && change(name, value()));
    input.addEventListener("input", () => {
      out.value = text(value());
      if (name === "delay") return; // may restart the loop
      timer ||= setTimeout(() => {
        timer = 0;
        change(name, value());
      }, PAUSE);
    });
    fields[name] = input;
    input.show = (v) => {
      if (document.activeElement === input && timer) return;
      input.value = to(v);
      out.value = text(v);
    };
    row.append(label, out, input);
    return row;
  };
  return (state) => {
    if (!shown) build(state);
    shown = state;
    for (const [name, field] of Object.entries(fields)) {
      const value = state.choices[name];
      if (field.show) field.show(value);
      else if (field.type === "checkbox") field.checked = value;
      else field.value = value;
      field.disabled = state.role !== "control";
    }
  };
}
