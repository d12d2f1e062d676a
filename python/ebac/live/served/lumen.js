// The wall: rings around the centre line, whose places change from frame to frame.

const AROUND = 28;

export class Lumen {
  /** `right` and `down` of every ring. */
  constructor({ right, down }) {
    [this.right, this.down] = [right, down];
    this.rings = right.length / 3;
    this.places = new Float32Array(3 * AROUND * this.rings);
    this.normals = new Float32Array(3 * AROUND * this.rings);
    this.triangles = [];
    for (let i = 0; i + 1 < this.rings; ++i) {
      for (let k = 0; k < AROUND; ++k) {
        const [a, b] = [i * AROUND + k, i * AROUND + ((k + 1) % AROUND)];
        this.triangles.push(a, b, b + AROUND, a, b + AROUND, a + AROUND);
      }
    }
  }

  /** Centres and radii in tenths of a millimetre. */
  move(centres, radii) {
    const { right, down, places, normals } = this;
    for (let i = 0, p = 0; i < this.rings; ++i) {
      const [before, after] = [Math.max(0, i - 1), Math.min(this.rings - 1, i + 1)];
      const slope = (radii[after] - radii[before]) / (60 * (after - before));
      for (let k = 0; k < AROUND; ++k) {
        const a = (2 * Math.PI * k) / AROUND;
        const [c, s] = [Math.cos(a), Math.sin(a)];
        for (let j = 0; j < 3; ++j, ++p) {
          const out = c * right[3 * i + j] + s * down[3 * i + j];
          const [n1, n2] = [(j + 1) % 3, (j + 2) % 3].map((m) => 3 * i + m);
          const ahead = right[n1] * down[n2] - right[n2] * down[n1];
          places[p] = 1e-4 * (centres[3 * i + j] + radii[i] * out);
          normals[p] = out - slope * ahead;
        }
      }
    }
  }
}
