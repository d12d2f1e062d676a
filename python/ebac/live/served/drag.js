// The mouse, a finger or the arrow keys as the hand; beside the hand they turn the view.

const NEAR = 34; // pixels
const KEY_STEP = 1e-3; // m

/** `hand()` is where the hand is, by axis [m]; `drag(place)` and `drop()` are called; `changed()` for another view. */
export function dragging(canvas, scene, { hand, drag, drop, changed }) {
  const held = new Map();
  let grabbed = null;
  const three = (p) => [p[0] ?? 0, p[1] ?? 0, p[2] ?? 0];
  const screenAt = (event) => {
    const box = canvas.getBoundingClientRect();
    return [(2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height];
  };
  /** Where the ray through a point of the screen meets the plane of the hand. */
  const meets = (event, through, axes) => {
    const c = scene.look();
    const [u, v] = screenAt(event);
    const ray = unit(add(add(c.back.map((x) => -x), c.right, (u * c.aspect) / c.f), c.above, v / c.f));
    const normal = axes === 3 ? c.back : [0, 0, 1];
    const slope = dot(ray, normal);
    if (Math.abs(slope) < 0.05) return null;
    return add(c.eye, ray, dot(add(through, c.eye, -1), normal) / slope);
  };
  const isNear = (event) => {
    const [u, v] = seen(scene.look().matrix, three(hand()));
    const [a, b] = screenAt(event);
    return Math.hypot(((u - a) * canvas.clientWidth) / 2, ((v - b) * canvas.clientHeight) / 2) < NEAR;
  };

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    if (held.size === 1 && hand() && isNear(event)) {
      const at = three(hand());
      const met = meets(event, at, hand().length);
      if (met) grabbed = { at, offset: add(at, met, -1), axes: hand().length };
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    held.set(event.pointerId, [event.clientX, event.clientY]);
    if (grabbed) {
      const met = meets(event, grabbed.at, grabbed.axes);
      if (met) drag(add(met, grabbed.offset).slice(0, grabbed.axes));
    } else {
      scene.turn += 0.008 * (event.clientX - before[0]);
      scene.tilt = Math.min(1.5, Math.max(0.05, scene.tilt + 0.008 * (event.clientY - before[1])));
      changed();
    }
  });
  for (const name of ["pointerup", "pointercancel"]) {
    canvas.addEventListener(name, (event) => {
      held.delete(event.pointerId);
      if (grabbed) drop();
      grabbed = null;
    });
  }
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    scene.far = Math.min(0.8, Math.max(0.15, scene.far * Math.exp(1e-3 * event.deltaY)));
    changed();
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const [axis, way] = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowDown: [1, -1], ArrowUp: [1, 1] }[event.key] ?? [];
    if (axis === undefined || !hand() || axis >= hand().length) return;
    event.preventDefault();
    drag(hand().map((x, i) => x + (i === axis ? way * KEY_STEP : 0)));
  });
}
