// The lumen from outside, transparent, with the gastroscope in it.

const PIECES = 14; // of the bending section

/** The bending section between the tube's end and the tip: a curve with both directions. */
function bent(from, fromWay, to, toWay) {
  const long = size(add(to, from, -1));
  return Array.from({ length: PIECES }, (_, i) => {
    const u = (i + 1) / PIECES;
    const [a, b, c, d] = [(1 + 2 * u) * (1 - u) ** 2, u * (1 - u) ** 2 * long, u * u * (3 - 2 * u), u * u * (u - 1) * long];
    return from.map((x, j) => a * x + b * fromWay[j] + c * to[j] + d * toWay[j]);
  });
}

export class Outside {
  constructor(canvas) {
    this.screen = new Screen(canvas);
    const ball = Array.from({ length: 13 }, (_, i) => [Math.sin((Math.PI * i) / 12), -Math.cos((Math.PI * i) / 12)]);
    this.ball = this.screen.mesh(...turned(ball));
    this.rod = this.screen.mesh(...turned([[1, 0], [1, 1]], 12));
    this.cone = this.screen.mesh(...turned([[0.15, 0], [1, 1]], 18));
    this.turn = 0.4;
    this.tilt = 0.1;
    this.far = 1;
  }

  look() {
    const { clientWidth: w, clientHeight: h } = this.screen.canvas;
    const middle = [-0.19, 0.01, -0.235];
    const [ct, st] = [Math.cos(this.tilt), Math.sin(this.tilt)];
    const far = this.far * Math.max(1, (0.72 * h) / w);
    const eye = add(middle, [far * ct * Math.cos(this.turn), -far * ct * Math.sin(this.turn), far * st]);
    return camera(eye, middle, [0, 0, 1], 0.62, w / h);
  }

  draw({ at, ahead, lumen, tube, tip, diameter, targets, colours, force, limit }) {
    const { screen } = this;
    screen.begin(this.look());
    const end = add(at, ahead, -tip);
    const last = tube.length - 1;
    const way = last > 0 ? unit(add(tube[last], tube[last - 1], -1)) : ahead;
    const section = last >= 0 ? bent(tube[last], way, end, ahead) : [end];
    const line = [...tube, ...section, at];
    const scope = (from, to, colour) => {
      screen.draw(this.rod, between(from, to, diameter / 2), colour);
      screen.draw(this.ball, placed(to, diameter / 2), colour);
    };
    for (let i = 0; i + 1 < line.length; ++i) scope(line[i], line[i + 1], i < last ? colours.scope : colours.section);
    screen.draw(this.ball, placed(at, 0.62 * diameter), force > limit ? colours.bad : colours.hand);
    for (const target of targets) screen.draw(this.ball, placed(target, 6e-3), colours.target);
    screen.draw(this.cone, between(at, add(at, ahead, 0.035), 0.018), colours.target, 0.25);
    if (lumen) {
      this.wall ??= { ...screen.mesh([0, 0, 0], []), ...this.indexed(lumen) };
      fillMesh(screen.gl, this.wall, lumen.places, lumen.normals);
      screen.draw(this.wall, placed([0, 0, 0], 1), colours.tissue, 0.3);
    }
  }

  indexed({ triangles }) {
    const gl = this.screen.gl;
    const made = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, made);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles), gl.STATIC_DRAW);
    return { triangles: made, count: triangles.length };
  }
}
