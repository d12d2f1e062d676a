// Ticks of an axis that shows asinh(value): decades, or 1-2-5 steps, or even steps, whatever labels at least three.

const {start, end} = cb_data;
const low = Math.sinh(Math.min(start, end)), high = Math.sinh(Math.max(start, end));
const inside = (values) => values.filter((value) => low <= value && value <= high);

function steps(factors) {
  const values = [0];
  for (let decade = 1; decade < 1e7; decade *= 10) {
    for (const factor of factors) values.push(factor * decade, -factor * decade);
  }
  return values;
}

// Even steps of 1, 2 or 5 times a power of ten, about five of them.
function even() {
  const rough = (high - low) / 5;
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((factor) => factor * decade >= rough);
  const values = [];
  for (let place = Math.ceil(low / step); place * step <= high; place++) values.push(place * step);
  return values;
}

const LEAST = 3;
const few = [steps([1]), steps([1, 2, 5]), steps([1, 2, 3, 4, 5, 7])].map(inside).find(({length}) => length >= LEAST);
// Labels of -1, 0 and 1 would overlap where the axis runs over many decades.
const wide = Math.abs(end - start) > 9;
const shown = (few ?? even()).filter((value) => !(wide && Math.abs(value) === 1));
return shown.map((value) => Math.asinh(value));
