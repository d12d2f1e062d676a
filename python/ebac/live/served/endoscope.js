// What the camera at the tip sees: a wide lens, whose angles are distances in the picture, and a lamp beside it.

const LENS = `
attribute vec3 place, normal; uniform vec3 at, right, down, ahead; uniform float halfAngle; uniform vec2 fit;
uniform vec4 model; varying vec3 n, from; varying vec2 seen; varying float off;
void main() {
  vec3 x = model.xyz + model.w * place - at;
  vec3 own = vec3(dot(x, right), dot(x, down), dot(x, ahead));
  float aside = length(own.xy);
  off = atan(aside, own.z) / halfAngle;
  float share = aside > 1e-7 ? off / aside : 0.0;
  from = x; n = normal; seen = share * own.xy;
  gl_Position = vec4(share * own.x * fit.x, -share * own.y * fit.y, clamp(length(x) / 0.4, 0.0, 1.0) * 2.0 - 1.0, 1.0);
}`;
const LAMP = `
precision mediump float; varying vec3 n, from; varying vec2 seen; varying float off; uniform vec3 colour;
void main() {
  if (length(seen) > 1.0 || off - length(seen) > 0.6) discard; // what lies behind is spread over the picture
  float far = length(from);
  float lit = (0.35 + 0.65 * abs(dot(normalize(n), from / far))) * (0.12 + 0.95 * exp(-far / 0.075));
  gl_FragColor = vec4(colour * lit + vec3(0.25) * pow(lit, 6.0), 1.0);
}`;

export class Endoscope {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl", { antialias: true, alpha: true }));
    if (!gl) throw new Error("this browser has no WebGL");
    this.at = used(gl, LENS, LAMP, ["at", "right", "down", "ahead", "halfAngle", "fit", "model", "colour"]);
    const ball = turned(Array.from({ length: 11 }, (_, i) => [Math.sin((Math.PI * i) / 10), -Math.cos((Math.PI * i) / 10)]));
    this.ball = this.mesh(new Float32Array(ball[0]), new Float32Array(ball[0]), ball[1]);
  }

  mesh(places, normals, triangles) {
    const gl = this.gl;
    const mesh = { places: gl.createBuffer(), normals: gl.createBuffer(), triangles: gl.createBuffer(), count: triangles.length };
    this.fill(mesh, places, normals);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles), gl.STATIC_DRAW);
    return mesh;
  }

  fill(mesh, places, normals) {
    fillMesh(this.gl, mesh, places, normals);
  }

  draw({ at, ahead, right, lumen, targets, colours, field }) {
    const { gl, canvas } = this;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniform3fv(this.at.at, at);
    gl.uniform3fv(this.at.right, right);
    gl.uniform3fv(this.at.down, cross(ahead, right));
    gl.uniform3fv(this.at.ahead, ahead);
    gl.uniform1f(this.at.halfAngle, field / 2);
    gl.uniform2f(this.at.fit, Math.min(1, h / w), Math.min(1, w / h));
    if (lumen) {
      this.wall ??= this.mesh(lumen.places, lumen.normals, lumen.triangles);
      this.fill(this.wall, lumen.places, lumen.normals);
      this.one(this.wall, [0, 0, 0, 1], colours.tissue);
    }
    for (const target of targets) this.one(this.ball, [...target, 4e-3], colours.target);
  }

  one(mesh, model, colour) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.places);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.normals);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles);
    gl.uniform4fv(this.at.model, model);
    gl.uniform3fv(this.at.colour, colour);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0);
  }
}

export function fillMesh(gl, mesh, places, normals) {
  for (const [buffer, data] of [[mesh.places, places], [mesh.normals, normals]]) {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }
}
