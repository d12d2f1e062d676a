// Numbers as people read them, and a contact in words.

const EXACT = 0.06e-3; // m, two encoder counts

/** A number with its unit: `quantity(0.0082, "mm")` of metres is "8.2 mm". */
export function quantity(value, unit, digits = 3) {
  const factor = { mm: 1e3, mJ: 1e3, "kN/m": 1e-3, ms: 1e3 }[unit] ?? 1;
  if (!Number.isFinite(value)) return `– ${unit}`;
  const scaled = value * factor;
  const places = Math.max(0, digits - 1 - Math.floor(Math.log10(Math.max(Math.abs(scaled), 10 ** (1 - digits)))));
  return `${scaled.toFixed(Math.min(places, digits)).replace(/^-(0\.?0*)$/, "$1").replace("-", "−")} ${unit}`;
}

/** Energy in mJ, from a joule on in J. */
export function energy(joules) {
  return quantity(joules, Math.abs(joules) < 1 ? "mJ" : "J");
}

/** Where the hand and an ideal wall balance [m]: null where they do not touch. */
export function idealRest({ stiffness, position, hand, target }) {
  return target > position ? (hand * target + stiffness * position) / (hand + stiffness) : null;
}

/** A verdict: `kind` good, fair, bad or free, a headline and a sentence behind it; `touched`: whether the wall ever acted. */
export function verdict(measured, ideal, touched) {
  if (ideal === null) {
    return touched
      ? { kind: "free", head: "No contact at rest", more: "The handle left the surface. Drag the hand into the wall." }
      : { kind: "free", head: "Free air", more: "Drag the hand into the wall." };
  }
  const { swing, rest, perceived, force_settled: settled, limit_cycle: frequency } = measured;
  if (!measured.still) {
    const at = Number.isFinite(frequency) ? ` at ${quantity(frequency, "Hz", 2)}` : "";
    return { kind: "bad", head: `Shakes by ${quantity(swing, "mm", 2)}`, more: `The handle swings to and fro${at}.` };
  }
  const away = rest - ideal;
  const where = Math.abs(away) < EXACT
    ? `Rests within ${quantity(Math.max(Math.abs(away), 1e-5), "mm", 2)} of an ideal wall.`
    : `Rests ${quantity(Math.abs(away), "mm", 2)} too ${away > 0 ? "deep" : "far out"}.`;
  if (!measured.force_quiet) {
    const times = perceived >= 10 ? perceived.toFixed(0) : perceived.toFixed(1);
    const felt = [];
    if (perceived > 1) felt.push(`vibrates ${times} times the threshold of touch`);
    if (!Number.isFinite(settled)) felt.push("does not settle");
    return { kind: "fair", head: "Buzzes", more: `Still, but its force ${felt.join(" and ")}. ${where}` };
  }
  const exact = Math.abs(away) < EXACT;
  return { kind: exact ? "good" : "fair", head: exact ? "Quiet and exact" : "Quiet, but soft", more: where };
}
