// The picture: a handle on its rail, the virtual wall, the hand that pulls, and the arrow of the force.

import { fitted } from "./strips.js";
import { quantity } from "./words.js";

const RADIUS = 20; // pixels, of the handle

/** Which metres lie between the edges of the picture, for its width. */
export function view(width) {
  return width < 500 ? { from: -0.03, to: 0.06 } : { from: -0.045, to: 0.075 };
}

/** Draw one frame: positions [m] of wall, handle and hand, what the handle passed since the last frame, force [N]. */
export function scene(canvas, { wall, x, least, most, target, force, colour, pulled, theme }) {
  const { g, width, height } = fitted(canvas);
  const { from, to } = view(width);
  const at = (metres) => ((metres - from) / (to - from)) * width;
  const middle = Math.round(0.5 * height) - 4;
  rail(g, width, height, middle, at, wall, theme);
  block(g, width, height, at(wall), middle, theme, force, colour);
  const way = target > x ? 1 : -1;
  if (Math.abs(at(target) - at(x)) > 2 * RADIUS + 4) {
    spring(g, at(x) - RADIUS + way * RADIUS, at(target) - RADIUS - way * (RADIUS + 4), middle, theme);
  }
  hand(g, at(target) - RADIUS, middle, pulled, theme);
  blur(g, at(least) - RADIUS, at(most) - RADIUS, middle, colour);
  handle(g, at(x) - RADIUS, middle, colour);
  arrow(g, at(x) - 2 * RADIUS - 6, middle, force, theme);
}

function rail(g, width, height, middle, at, wall, theme) {
  g.strokeStyle = theme.grid;
  g.lineWidth = 6;
  g.lineCap = "round";
  line(g, 8, middle, width - 8, middle);
  g.lineCap = "butt";
  g.font = "11px system-ui, sans-serif";
  g.textAlign = "center";
  g.fillStyle = theme.soft;
  g.strokeStyle = theme.axis;
  g.lineWidth = 1;
  const step = width < 500 ? 20 : 10;
  for (let mm = -40; mm <= 70; mm += step) {
    const px = at(wall + mm / 1000);
    if (px < 12 || px > width - 12) continue;
    line(g, px, height - 22, px, height - 17);
    g.fillText(mm === 0 ? "surface" : `${String(mm).replace("-", "−")}${mm === step ? " mm" : ""}`, px, height - 6);
  }
}

function block(g, width, height, left, middle, theme, force, colour) {
  const [top, bottom] = [14, height - 28];
  g.fillStyle = theme.wall;
  g.fillRect(left, top, width - left, bottom - top);
  g.save();
  g.beginPath();
  g.rect(left, top, width - left, bottom - top);
  g.clip();
  g.strokeStyle = theme.hatch;
  g.lineWidth = 1;
  for (let px = left - height; px < width; px += 11) line(g, px, bottom, px + (bottom - top), top);
  const glow = Math.min(1, Math.abs(force) / 20);
  const light = g.createRadialGradient(left, middle, 0, left, middle, 40 + 70 * glow);
  light.addColorStop(0, colour + Math.round(150 * glow).toString(16).padStart(2, "0"));
  light.addColorStop(1, colour + "00");
  g.fillStyle = light;
  g.fillRect(left, top, width - left, bottom - top);
  g.restore();
  g.strokeStyle = theme.ink;
  g.lineWidth = 2;
  line(g, left, top, left, bottom);
  g.fillStyle = theme.soft;
  g.font = "12px system-ui, sans-serif";
  g.textAlign = "right";
  g.fillText("virtual wall", width - 10, top + 17);
}

function spring(g, a, b, y, theme) {
  const turns = 12;
  g.strokeStyle = theme.axis;
  g.lineWidth = 1.5;
  g.beginPath();
  g.moveTo(a, y);
  for (let i = 1; i < turns; ++i) g.lineTo(a + ((b - a) * i) / turns, y + (i % 2 ? -6 : 6));
  g.lineTo(b, y);
  g.stroke();
}

function hand(g, px, y, pulled, theme) {
  g.save();
  g.strokeStyle = theme.hand;
  g.fillStyle = theme.hand + (pulled ? "44" : "1e");
  g.lineWidth = 2;
  g.setLineDash(pulled ? [] : [5, 4]);
  circle(g, px, y, RADIUS + 4);
  g.fill();
  g.stroke();
  g.setLineDash([]);
  g.lineWidth = 2;
  for (const side of [-1, 1]) {
    g.beginPath();
    g.moveTo(px + side * 6, y - 5);
    g.lineTo(px + side * 12, y);
    g.lineTo(px + side * 6, y + 5);
    g.stroke();
  }
  g.fillStyle = theme.hand;
  g.font = "600 12px system-ui, sans-serif";
  g.textAlign = "center";
  g.fillText(pulled ? "hand" : "drag the hand", px, y + RADIUS + 22);
  g.restore();
}

function blur(g, a, b, y, colour) {
  if (b - a < 2) return;
  g.fillStyle = colour + "40";
  g.beginPath();
  g.roundRect(a - RADIUS, y - RADIUS, b - a + 2 * RADIUS, 2 * RADIUS, RADIUS);
  g.fill();
}

function handle(g, px, y, colour) {
  const shade = g.createRadialGradient(px - 7, y - 8, 2, px, y, RADIUS);
  shade.addColorStop(0, "#ffffff");
  shade.addColorStop(0.25, colour + "cc");
  shade.addColorStop(1, colour);
  g.fillStyle = shade;
  circle(g, px, y, RADIUS);
  g.fill();
}

/** It points the way the motor pushes: out of the wall, to the left. */
function arrow(g, px, y, force, theme) {
  const length = Math.min(130, px - 8, 6.5 * Math.abs(force));
  g.fillStyle = theme.ink;
  g.font = "600 13px system-ui, sans-serif";
  g.textAlign = "left";
  if (length >= 4) {
    const way = force > 0 ? -1 : 1;
    const from = force > 0 ? px : px + 2 * RADIUS + 12 + RADIUS;
    const head = Math.min(11, length);
    g.fillRect(Math.min(from, from + way * (length - head)), y - 3, length - head, 6);
    g.beginPath();
    g.moveTo(from + way * length, y);
    g.lineTo(from + way * (length - head), y - 9);
    g.lineTo(from + way * (length - head), y + 9);
    g.fill();
  }
  g.textAlign = "center";
  g.fillText(`force ${quantity(force, "N")}`, Math.max(58, px - 0.5 * Math.max(40, length)), y - 34);
}

function line(g, x0, y0, x1, y1) {
  g.beginPath();
  g.moveTo(x0, y0);
  g.lineTo(x1, y1);
  g.stroke();
}

function circle(g, x, y, radius) {
  g.beginPath();
  g.arc(x, y, radius, 0, 2 * Math.PI);
}
