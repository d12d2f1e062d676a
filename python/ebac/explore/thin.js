// Draws the window on the screen anew whenever it moves: of each bin the least and the most.
// `columns` is what the page carries, unpacked once; see pack.py and thin.py.

let columns = null;
let waiting = false;

async function unpacked(bytes, Kind) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  const width = Kind.BYTES_PER_ELEMENT;
  const rows = planes.length / width;
  const raw = new Uint8Array(planes.length);
  for (let place = 0; place < width; place++) {
    for (let row = 0, from = place * rows; row < rows; row++) raw[row * width + place] = planes[from + row];
  }
  return new Kind(raw.buffer);
}

async function unpack({packed_times, packed_columns, rows, first, last}) {
  const times = packed_times.byteLength > 0 ? await unpacked(packed_times, Float64Array) : null;
  const step = rows > 1 ? (last - first) / (rows - 1) : 1;
  const at = times ? (row) => times[row] : (row) => first + step * row;
  const values = [];
  for (const bytes of packed_columns) values.push(await unpacked(bytes, Float32Array));
  return {at, rows, values};
}

// The first row at or after an instant.
function row_at({at, rows}, instant) {
  let low = 0, high = rows;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (at(middle) < instant) low = middle + 1; else high = middle;
  }
  return low;
}

// What to draw of [start, stop): every row up to four a bin, else the least and the most of each bin.
function bands(values, at, start, stop, bins) {
  const count = stop - start;
  const size = count <= 4 * bins ? count : bins;
  const t = new Float64Array(size), least = new Float64Array(size).fill(NaN), most = new Float64Array(size);
  for (let bin = 0; bin < size; bin++) {
    const from = start + Math.floor(bin * count / size), to = start + Math.floor((bin + 1) * count / size);
    let low = NaN, high = NaN;
    for (let row = from; row < to; row++) {
      const value = values[row];
      if (!(value >= low)) low = value === value ? value : low;
      if (!(value <= high)) high = value === value ? value : high;
    }
    t[bin] = at((from + to - 1) >> 1);
    most[bin] = high;
    if (size < count) least[bin] = low; // one line is enough where every row is drawn
  }
  return {t, least, most};
}

// What stands between two gaps, of which no line shows anything; elsewhere NaN.
function alone(drawn) {
  const known = (row) => row >= 0 && row < drawn.length && drawn[row] === drawn[row];
  return drawn.map((value, row) => (known(row - 1) || known(row + 1) ? NaN : value));
}

function draw({sources, decades, window_, plots}) {
  const began = performance.now();
  const bins = Math.max(200, Math.round(plots[0].inner_width || 1000));
  const start = Math.max(0, row_at(columns, window_.start) - 1);
  const stop = Math.min(columns.rows, row_at(columns, window_.end) + 2);
  sources.forEach((source, place) => {
    const {t, least, most} = bands(columns.values[place], columns.at, start, stop, bins);
    const scale = (values) => (decades[place] ? values.map(Math.asinh) : values);
    const high = scale(most);
    source.data = {t, least, most, low: scale(least), high, alone: alone(high)};
  });
  // For those who measure, and for the tests.
  const drawn = (window.ebac_exploration?.drawn ?? 0) + 1;
  window.ebac_exploration = {drawn, start, stop, rows: stop - start, bins, thin_ms: performance.now() - began};
}

export default async function (args) {
  if (waiting) return; // one drawing a frame is enough
  waiting = true;
  columns ??= await unpack(args);
  requestAnimationFrame(() => {
    waiting = false;
    draw(args);
  });
}
