// Triangles on the screen by WebGL: one program, light from the camera.

const VERTEX = `
attribute vec3 place, normal; uniform mat4 view, model; varying vec3 n;
void main() { n = mat3(model) * normal; gl_Position = view * model * vec4(place, 1.0); }`;
const FRAGMENT = `
precision mediump float; varying vec3 n; uniform vec4 colour; uniform vec3 light;
void main() {
  float lit = 0.35 + 0.65 * abs(dot(normalize(n), light));
  gl_FragColor = vec4(colour.rgb * lit, 1.0) * colour.a;
}`;

/** Compiles and uses a program with the attributes place and normal; returns where its uniforms are. */
export function used(gl, vertex, fragment, uniforms) {
  const program = gl.createProgram();
  for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  ["place", "normal"].forEach((name, i) => gl.bindAttribLocation(program, i, name));
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  gl.enableVertexAttribArray(0);
  gl.enableVertexAttribArray(1);
  return Object.fromEntries(uniforms.map((name) => [name, gl.getUniformLocation(program, name)]));
}

export class Screen {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = (this.gl = canvas.getContext("webgl", { antialias: false, alpha: true }));
    if (!gl) throw new Error("this browser has no WebGL");
    this.at = used(gl, VERTEX, FRAGMENT, ["view", "model", "colour", "light"]);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  /** Triangles by the numbers of their corners; what shares a corner is drawn smooth. */
  mesh(places, triangles) {
    const gl = this.gl;
    const normals = new Float32Array(places.length);
    for (let t = 0; t < triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[t + k]);
      const [u, v] = [b, c].map((p) => [0, 1, 2].map((i) => places[p + i] - places[a + i]));
      const n = cross(u, v);
      for (const p of [a, b, c]) for (let i = 0; i < 3; ++i) normals[p + i] += n[i];
    }
    for (let p = 0; p < normals.length; p += 3) {
      const long = Math.hypot(normals[p], normals[p + 1], normals[p + 2]) || 1;
      for (let i = 0; i < 3; ++i) normals[p + i] /= long;
    }
    const buffer = (target, data) => {
      const made = gl.createBuffer();
      gl.bindBuffer(target, made);
      gl.bufferData(target, data, gl.STATIC_DRAW);
      return made;
    };
    return {
      places: buffer(gl.ARRAY_BUFFER, new Float32Array(places)),
      normals: buffer(gl.ARRAY_BUFFER, normals),
      triangles: buffer(gl.ELEMENT_ARRAY_BUFFER, new Uint16Array(triangles)),
      count: triangles.length,
    };
  }

  free(mesh) {
    for (const name of ["places", "normals", "triangles"]) this.gl.deleteBuffer(mesh[name]);
  }

  begin(camera) {
    const { gl, canvas } = this;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    const [w, h] = [Math.round(canvas.clientWidth * scale), Math.round(canvas.clientHeight * scale)];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.at.view, false, camera.matrix);
    gl.uniform3fv(this.at.light, unit(add(camera.back, camera.above, 0.5)));
  }

  draw(mesh, model, colour, opaque = 1) {
    const gl = this.gl;
    gl[opaque < 1 ? "enable" : "disable"](gl.BLEND);
    gl.depthMask(opaque === 1);
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.places);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.normals);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, mesh.triangles);
    gl.uniformMatrix4fv(this.at.model, false, model);
    gl.uniform4f(this.at.colour, ...colour, opaque);
    gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_SHORT, 0);
    gl.depthMask(true);
  }
}

/** A ball of radius 1, or what turns around z by (radius, height). */
export function turned(profile, around = 20) {
  const places = [], triangles = [];
  profile.forEach(([r, z]) => {
    for (let k = 0; k < around; ++k) {
      const a = (2 * Math.PI * k) / around;
      places.push(r * Math.cos(a), r * Math.sin(a), z);
    }
  });
  for (let i = 0; i + 1 < profile.length; ++i) {
    for (let k = 0; k < around; ++k) {
      const [a, b] = [i * around + k, i * around + ((k + 1) % around)];
      triangles.push(a, b, b + around, a, b + around, a + around);
    }
  }
  return [places, triangles];
}
