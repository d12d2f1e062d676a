// The ripple of the force as sound: what is faster than 20 Hz, held for a tick as the motor holds it.

const LAG = 0.09; // s between the simulation and the ear: frames come unevenly
const CORNER = 20; // Hz; slower changes are pressing, not ripple
const LOUD = 0.35; // of full scale for a ripple of 1 N

export class Sound {
  constructor() {
    this.context = null;
    this.on = false;
    this.mean = 0;
  }

  /** Turn it on or off; browsers allow sound only after a click. */
  async toggle() {
    this.on = !this.on;
    if (this.on && this.context === null) this.context = new AudioContext();
    if (this.context !== null) await (this.on ? this.context.resume() : this.context.suspend());
    this.next = 0;
    this.part = 0;
    return this.on;
  }

  /** Play the forces [N] of consecutive ticks of `dt` [s]. */
  play(force, dt) {
    if (!this.on || force.length === 0) return;
    const rate = this.context.sampleRate;
    const exact = force.length * dt * rate + this.part;
    const count = Math.floor(exact);
    this.part = exact - count;
    if (count === 0) return;
    const buffer = this.context.createBuffer(1, count, rate);
    const data = buffer.getChannelData(0);
    const share = 1 - Math.exp(-2 * Math.PI * CORNER * dt);
    let tick = -1, ripple = 0;
    for (let i = 0; i < count; ++i) {
      const now = Math.min(force.length - 1, Math.floor(i / (dt * rate)));
      if (now !== tick) {
        tick = now;
        this.mean += share * (force[tick] - this.mean);
        ripple = force[tick] - this.mean;
      }
      data[i] = Math.tanh(LOUD * ripple) * 0.8;
    }
    const source = this.context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.context.destination);
    const soon = this.context.currentTime + 0.01;
    if (this.next < soon || this.next > soon + 3 * LAG) this.next = soon + LAG;
    source.start(this.next);
    this.next += count / rate;
  }
}
