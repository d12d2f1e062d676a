// The picture: base, lever, handle, world, force, and where the hand wants to be.

const LEVER = 0.1; // m
const PER_NEWTON = 2.5e-3; // m of arrow
const LONGEST_ARROW = 0.06;

export class Scene {
  constructor(canvas) {
    this.screen = new Screen(canvas);
    const ball = Array.from({ length: 13 }, (_, i) => [Math.sin((Math.PI * i) / 12), -Math.cos((Math.PI * i) / 12)]);
    this.ball = this.screen.mesh(...turned(ball));
    this.rod = this.screen.mesh(...turned([[0, 0], [1, 0], [1, 1], [0, 1]], 14));
    this.cone = this.screen.mesh(...turned([[0, 0], [1, 0], [0, 1]], 14));
    this.world = null;
    this.turn = 0.35;
    this.tilt = 0.75;
    this.far = 0.36;
    this.theme();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.theme());
  }

  theme() {
    const style = getComputedStyle(document.documentElement);
    const rgb = (name) => {
      const text = style.getPropertyValue(name).trim();
      return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
    };
    this.colours = Object.fromEntries(["world", "metal", "hand", "bad", "soft"].map((name) => [name, rgb(`--${name}`)]));
  }

  /** Another world: places in hundredths of a millimetre, corners of triangles. */
  shape([places, triangles]) {
    if (this.world) this.screen.free(this.world);
    this.world = places.length ? this.screen.mesh(places.map((x) => 1e-5 * x), triangles) : null;
  }

  look() {
    const { clientWidth: w, clientHeight: h } = this.screen.canvas;
    const middle = [0.01, 0, -0.012];
    const [ct, st] = [Math.cos(this.tilt), Math.sin(this.tilt)];
    const eye = add(middle, [this.far * ct * Math.sin(-this.turn), -this.far * ct * Math.cos(this.turn), this.far * st]);
    return camera(eye, middle, [0, 0, 1], 0.6, w / h);
  }

  draw({ x, force, target, law }) {
    const c = this.look();
    const { screen, colours } = this;
    const three = (p) => [p[0] ?? 0, p[1] ?? 0, p[2] ?? 0];
    screen.begin(c);
    const [handle, hand] = [three(x), three(target)];
    const joint = [0, 0, -LEVER];
    screen.draw(this.rod, between([0, 0, -LEVER - 0.012], joint, 0.03), colours.metal);
    screen.draw(this.rod, between(joint, handle, 0.0028), colours.metal);
    screen.draw(this.ball, placed(handle, 0.0055), law);
    const long = Math.min(LONGEST_ARROW, PER_NEWTON * size(force));
    if (long > 1e-3) {
      const to = add(handle, unit(three(force)), -long); // on the hand
      const lift = [0, 0, 0.009];
      const [a, b] = [add(handle, lift), add(to, lift)];
      const neck = add(b, unit(add(b, a, -1)), -Math.min(0.008, long));
      screen.draw(this.rod, between(a, neck, 0.0014), colours.bad);
      screen.draw(this.cone, between(neck, b, 0.0036), colours.bad);
    }
    screen.draw(this.rod, between(handle, add(hand, [1e-6, 0, 0]), 0.0009), colours.hand);
    screen.draw(this.ball, placed(hand, 0.0065), colours.hand, 0.6);
    if (this.world) screen.draw(this.world, placed([0, 0, 0], 1), colours.world, 0.55);
  }
}
