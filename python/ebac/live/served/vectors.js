// Points and matrices of 4 x 4, by columns, as WebGL takes them.

export const add = (a, b, s = 1) => a.map((x, i) => x + s * b[i]);
export const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const size = (a) => Math.hypot(...a);
export const unit = (a) => a.map((x) => x / (size(a) || 1));

export function times(a, b) {
  const c = new Array(16).fill(0);
  for (let j = 0; j < 4; ++j) for (let i = 0; i < 4; ++i) for (let k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
  return c;
}

/** What a camera at `eye` sees that looks at `to`; and its axes. */
export function camera(eye, to, up, angle, aspect) {
  const back = unit(add(eye, to, -1));
  const right = unit(cross(up, back));
  const above = cross(back, right);
  const view = [right[0], above[0], back[0], 0, right[1], above[1], back[1], 0, right[2], above[2], back[2], 0,
    -dot(right, eye), -dot(above, eye), -dot(back, eye), 1];
  const f = 1 / Math.tan(angle / 2);
  const [near, far] = [0.02, 2];
  const lens = [f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, (2 * far * near) / (near - far), 0];
  return { eye, right, above, back, f, aspect, matrix: times(lens, view) };
}

/** Where a point is on the screen, both from -1 to 1. */
export function seen(m, p) {
  const w = m[3] * p[0] + m[7] * p[1] + m[11] * p[2] + m[15];
  return [0, 1].map((i) => (m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i]) / w);
}

/** The matrix that puts what lies along z from 0 to 1 between two points, `wide` across. */
export function between(from, to, wide) {
  const along = add(to, from, -1);
  const z = unit(along);
  const x = unit(cross(Math.abs(z[2]) < 0.9 ? [0, 0, 1] : [1, 0, 0], z));
  const y = cross(z, x);
  return [...x.map((v) => v * wide), 0, ...y.map((v) => v * wide), 0, ...along, 0, ...from, 1];
}

export const placed = (at, scale) => [scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, ...at, 1];
