// The widget of `ebac.live.widget`: sliders beside the strips of one run, simulated here and drawn at every move.

import { load } from "./core.js";
import { SLIDERS, element, sliders } from "./controls.js";
import { panels, strips } from "./strips.js";
import { idealRest, verdict } from "./words.js";

const LIGHT = { ink: "#16202c", soft: "#5b6877", grid: "#e4e9ef", axis: "#8a97a6", hand: "#8a4fbf", bad: "#c62828" };
const STYLE = `
.ebac-live { display: flex; flex-wrap: wrap; gap: 16px; padding: 10px; background: #fff; color: #16202c; font: 13px/1.4 system-ui, sans-serif; }
.ebac-live .side { width: 230px; }
.ebac-live .right { flex: 1; min-width: 300px; }
.ebac-live canvas { width: 100%; height: 430px; display: block; }
.ebac-live select { width: 100%; font: inherit; margin-bottom: 10px; }
.ebac-live .slider { display: grid; grid-template-columns: 1fr auto; margin-bottom: 6px; }
.ebac-live .slider output { font-weight: 600; }
.ebac-live .slider input { grid-column: 1 / 3; width: 100%; margin: 0; }
.ebac-live [role=status] { margin-bottom: 6px; }`;

/** Run a scenario to its end and return its columns and the fault. */
export function simulated(core, law, settings, options, rows) {
  core.start(law, settings, options);
  core.watch(0);
  const columns = Object.fromEntries(core.catalogue.columns.map(({ name }) => [name, new Float64Array(rows)]));
  let fault = 0;
  for (let done = 0; done < rows && fault === 0;) {
    const made = core.step(rows - done);
    for (const name of Object.keys(columns)) columns[name].set(made[name], done);
    done += made.rows;
    fault = made.fault;
  }
  return { columns, fault };
}

async function render({ model, el }) {
  element("style", el, { text: STYLE });
  const box = element("div", el, { name: "ebac-live" });
  const side = element("div", box, { name: "side" });
  const right = element("div", box, { name: "right" });
  const said = element("div", right, { role: "status" });
  const canvas = element("canvas", right);
  const bytes = model.get("module");
  const core = await load(new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.byteLength));

  const law = element("select", element("label", side, { text: "law" }));
  for (const { name } of core.catalogue.laws) element("option", law, { text: name, value: name });
  const change = (changes) => {
    model.set(changes.law ? "law" : "values", changes.law ?? { ...model.get("values"), ...changes });
    show();
  };
  law.addEventListener("change", () => change({ law: law.value }));
  const place = sliders(side, SLIDERS, (name, value) => change({ [name]: value }));

  function show() {
    const values = model.get("values");
    const facts = model.get("facts");
    try {
      const { columns, fault } = simulated(core, model.get("law"), { ...facts.settings, ...values }, facts.options, facts.rows);
      const position = facts.settings["environment.position"] ?? 0;
      const ideal = idealRest({ stiffness: values["environment.stiffness"], position,
        hand: values["hand.stiffness"], target: facts.target });
      const landmarks = { surface: position, ...(ideal === null ? {} : { "ideal wall": ideal }) };
      const colour = facts.colours[model.get("law")] ?? "#555555";
      strips(canvas, panels(columns, landmarks, colour, LIGHT), { from: 0, to: facts.seconds, theme: LIGHT });
      const { head, more } = verdict(core.measure(), ideal, columns.f_env.some((force) => force !== 0));
      said.textContent = fault ? `Fault ${fault}: the loop stopped.` : `${head}. ${more}`;
      model.set("verdict", said.textContent);
      model.set("error", "");
    } catch (error) {
      said.textContent = error.message;
      model.set("error", error.message);
    }
    model.save_changes();
  }

  const settle = () => {
    law.value = model.get("law");
    place(model.get("values"));
    show();
  };
  model.on("change:values", settle);
  model.on("change:law", settle);
  settle();
  new ResizeObserver(() => show()).observe(canvas);
}

export default { render };
