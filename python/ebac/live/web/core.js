// The compiled core in JavaScript: device, hand and wall, simulated tick by tick. See bindings/wasm/exports.cpp.

const LONGEST_NAME = 256; // bytes, as in exports.cpp
const NO_SUCH_CALL = 52; // of WASI: the core opens no file, reads no clock and no environment

/** Compile the module and return a `Core`. */
export async function load(bytes) {
  let memory = null;
  const fail = (at, length) => {
    throw new RangeError(new TextDecoder().decode(new Uint8Array(memory.buffer, at, length)));
  };
  const { instance } = await WebAssembly.instantiate(bytes, {
    env: { fail },
    wasi_snapshot_preview1: new Proxy({}, { get: () => () => NO_SUCH_CALL }),
  });
  memory = instance.exports.memory;
  instance.exports._initialize?.();
  return new Core(instance.exports);
}

export class Core {
  constructor(exports) {
    this.wasm = exports;
    const at = exports.catalogue();
    const bytes = new Uint8Array(exports.memory.buffer);
    const text = new TextDecoder().decode(bytes.subarray(at, bytes.indexOf(0, at)));
    /** Laws, settings, columns and measures, with units and ranges. */
    this.catalogue = JSON.parse(text);
    this.capacity = exports.capacity();
  }

  /** A call that may raise: an error leaves the module's stack as it was. */
  guarded(call) {
    const top = this.wasm.__stack_pointer.value;
    try {
      return call();
    } catch (error) {
      this.wasm.__stack_pointer.value = top;
      throw error;
    }
  }

  /** Write a name where the core reads it; returns its length. */
  name(text) {
    const bytes = new TextEncoder().encode(text);
    if (bytes.length > LONGEST_NAME) throw new RangeError(`${text.slice(0, 40)}...: is no name, at most ${LONGEST_NAME} bytes`);
    new Uint8Array(this.wasm.memory.buffer, this.wasm.name_at(), bytes.length).set(bytes);
    return bytes.length;
  }

  /** Begin a run from rest. `settings` by name in SI units, others have their default; `observer` 0 off, 1 on, 2 for every law, 3 with the scale learned. */
  start(law, settings = {}, { observer = 1, seed = 1, jitter = 0 } = {}) {
    this.guarded(() => {
      this.wasm.reset();
      for (const [name, value] of Object.entries(settings)) this.wasm.set(this.name(name), value);
      this.wasm.chance(seed, jitter);
      this.wasm.observe(observer);
      this.wasm.start(this.name(law));
    });
  }

  /** From now on the hand wants to be at `target` [m]. */
  aim(target) { this.guarded(() => this.wasm.aim(target)); }

  /** From now on another wall: stiffness [N/m], place of its surface [m]. */
  wall(stiffness, position) { this.guarded(() => this.wasm.wall(stiffness, position)); }

  /** Run `ticks`, at most `capacity`. Returns views by column, good until the next call, and the fault, 0 for none. */
  step(ticks) {
    const rows = Math.max(0, Math.min(this.capacity, Math.floor(ticks)));
    const fault = this.guarded(() => this.wasm.step(rows));
    const at = this.wasm.columns();
    const made = { rows, fault };
    this.catalogue.columns.forEach(({ name }, i) => {
      made[name] = new Float64Array(this.wasm.memory.buffer, at + 8 * i * this.capacity, rows);
    });
    return made;
  }

  /** Measure the contact from the next row on; keep the last `rows` at least, 0 for all. */
  watch(rows = 0) { this.wasm.watch(rows); }

  /** What `ebac.contact` measures over the rows since `watch`: by name, SI units, NaN where there is none. */
  measure() {
    const at = this.guarded(() => this.wasm.measure());
    const { measures } = this.catalogue;
    const values = new Float64Array(this.wasm.memory.buffer, at, measures.length);
    return Object.fromEntries(measures.map(({ name }, i) => [name, values[i]]));
  }

  /** Nanoseconds of a tick, the best of several runs: for comparison with the native core. */
  time(ticks = 20000, repeats = 5) {
    let best = Infinity;
    for (let i = 0; i < repeats; ++i) {
      const from = performance.now();
      this.guarded(() => this.wasm.spin(ticks));
      best = Math.min(best, ((performance.now() - from) / ticks) * 1e6);
    }
    return best;
  }
}
