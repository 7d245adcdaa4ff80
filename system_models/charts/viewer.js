"use strict";
// Values under the pointer in charts; maps from above and in 3-D; details unfold on paper.

const number = (value) => {
  if (value === null || !isFinite(value)) return "–";
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(+value.toPrecision(4));
};

// ---- charts -------------------------------------------------------------------------------------------------------
const SVG = "http://www.w3.org/2000/svg";

function nearest(xs, x) {
  let low = 0, high = xs.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (xs[middle] < x) low = middle; else high = middle;
  }
  return Math.abs(xs[low] - x) <= Math.abs(xs[high] - x) ? low : high;
}

function readable(svg) {
  let data = null, tip = null, cursor = null;
  const hide = () => { tip?.remove(); cursor?.remove(); tip = cursor = null; };
  svg.addEventListener("pointerleave", hide);
  svg.addEventListener("pointermove", (event) => {
    data ??= JSON.parse(document.getElementById("points-" + svg.dataset.chart).textContent);
    const [left, top, right, bottom] = data.box, frame = svg.getBoundingClientRect();
    const scale = frame.width / svg.viewBox.baseVal.width, at = (event.clientX - frame.left) / scale;
    if (at < left || at > right) return hide();
    const [low, high] = data.log ? data.range.map(Math.log) : data.range, there = low + (at - left) / (right - left) * (high - low);
    const x = data.log ? Math.exp(there) : there;
    if (!tip) {
      tip = document.createElement("div");
      tip.className = "tip";
      svg.parentElement.append(tip);
      cursor = document.createElementNS(SVG, "line");
      cursor.setAttribute("class", "cursor");
      cursor.setAttribute("y1", top);
      cursor.setAttribute("y2", bottom);
      svg.append(cursor);
    }
    const rows = data.lines.map((line) => {
      const k = nearest(line.x, x), half = line.half?.[k];
      const band = half ? " ± " + number(half) : "";
      return [line, k, (data.lines.length > 1 ? line.label + ": " : "") + number(line.y[k]) + band];
    });
    const shown = rows[0][0].x[rows[0][1]];
    const place = left + ((data.log ? Math.log(shown) : shown) - low) / (high - low) * (right - left);
    cursor.setAttribute("x1", place);
    cursor.setAttribute("x2", place);
    tip.replaceChildren(`${data.x}: ${number(shown)}`, ...rows.flatMap(([line, , words]) => {
      const row = document.createElement("div");
      row.style.color = line.colour;
      row.textContent = words;
      return [row];
    }), data.y);
    const inside = place * scale, half = inside > frame.width / 2;
    tip.style.left = half ? "" : `${inside + 12}px`;
    tip.style.right = half ? `${frame.width - inside + 12}px` : "";
    tip.style.top = `${svg.offsetTop + 14}px`;
  });
}
document.querySelectorAll("svg[data-chart]").forEach(readable);

// ---- maps ---------------------------------------------------------------------------------------------------------
async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new DataView(await new Response(stream).arrayBuffer());
}

const CODES = 65534;

class Maps {
  constructor(root, data) {
    this.root = root;
    this.data = data;
    this.flat = root.querySelector(".flat");
    this.solid = root.querySelector(".solid");
    this.what = root.querySelector(".what");
    this.when = root.querySelector(".when");
    this.turn = [-0.6, 0.75];  // about the vertical, above the horizon [rad]
    this.pointer = null;
    this.listen();
    root.hidden = false;
    this.show();
  }

  get map() { return this.data.maps[this.what.value]; }

  async show() {
    const map = this.map;
    map.codes ??= await unpacked(map.data);
    if (map !== this.map) return;  // another one was chosen meanwhile
    const [rows, columns] = map.shape, size = rows * columns, from = size * this.when.value;
    this.values = Float64Array.from({length: size}, (_, k) => {
      const code = map.codes.getUint16(2 * (from + k), true);
      return code > CODES ? NaN : map.low + (map.high - map.low) * code / CODES;
    });
    this.root.querySelector(".now").textContent = this.data.times[this.when.value];
    this.root.querySelector(".what-it-is").textContent = map.caption;
    this.drawFlat();
    this.drawSolid();
  }

  share(value) {  // of the range of colours, 0 to 1
    const map = this.map;
    if (map.log) {
      const low = Math.log(Math.max(map.low, 1e-30));
      return Math.min(1, Math.max(0, (Math.log(Math.max(value, map.low)) - low) / (Math.log(map.top) - low)));
    }
    const least = Math.min(map.low, 0);
    return Math.min(1, Math.max(0, (value - least) / (map.top - least || 1)));
  }

  colour(share) {
    const stops = this.data.stops[this.map.colours], at = share * (stops.length - 1), k = Math.min(Math.floor(at), stops.length - 2);
    return stops[k].map((part, n) => part + (at - k) * (stops[k + 1][n] - part));
  }

  box() {  // of the map in its canvas: left, top, width, height; the longer side fills it
    const map = this.map, across = map.x[1] - map.x[0], up = map.y[1] - map.y[0];
    const room = [770, 760], ratio = Math.min(3, Math.max(1 / 3, across / up));
    const wide = Math.min(room[0], room[1] * ratio), high = wide / ratio;
    return [110, 20 + (room[1] - high) / 2, wide, high];
  }

  drawFlat() {
    const map = this.map, [rows, columns] = map.shape, pen = this.flat.getContext("2d");
    const image = new ImageData(columns, rows);
    this.values.forEach((value, k) => {
      const row = rows - 1 - Math.floor(k / columns), at = 4 * (row * columns + k % columns);
      const [r, g, b] = isNaN(value) ? [225, 225, 225] : this.colour(this.share(value));
      image.data.set([r, g, b, 255], at);
    });
    const small = new OffscreenCanvas(columns, rows);
    small.getContext("2d").putImageData(image, 0, 0);
    const [left, top, wide, high] = this.box();
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, this.flat.width, this.flat.height);
    pen.imageSmoothingEnabled = false;
    pen.drawImage(small, left, top, wide, high);
    pen.strokeStyle = "#7b858f";
    pen.strokeRect(left, top, wide, high);
    this.drawTrack(pen, left, top, wide, high);
    this.drawAxes(pen, left, top, wide, high);
    this.drawColours(pen);
  }

  place(x, y) {
    const map = this.map, [left, top, wide, high] = this.box();
    return [left + (x - map.x[0]) / (map.x[1] - map.x[0]) * wide, top + (map.y[1] - y) / (map.y[1] - map.y[0]) * high];
  }

  drawTrack(pen, left, top, wide, high) {
    const map = this.map, [a, b] = this.data.half, inside = b < map.y[1];
    pen.save();
    pen.beginPath();
    pen.rect(left, top, wide, high);
    pen.clip();
    for (const [ink, line] of [["#000", 4.5], ["#fff", 2]]) {  // white on black is seen on every colour
      pen.strokeStyle = ink;
      pen.lineWidth = line;
      pen.globalAlpha = ink === "#000" ? 0.35 : 0.95;
      pen.setLineDash(map.body ? [16, 10] : []);
      pen.beginPath();
      if (!inside) continue;
      if (map.body) {
        for (const edge of [-b, b]) {
          pen.moveTo(left, this.place(0, edge)[1]);
          pen.lineTo(left + wide, this.place(0, edge)[1]);
        }
      } else {
        const [x, y] = this.place(0, 0);
        pen.ellipse(x, y, a / (map.x[1] - map.x[0]) * wide, b / (map.y[1] - map.y[0]) * high, 0, 0, 2 * Math.PI);
      }
      pen.stroke();
    }
    pen.restore();
    pen.setLineDash([]);
    pen.lineWidth = 1;
  }

  drawAxes(pen, left, top, wide, high) {
    const map = this.map;
    pen.fillStyle = "#333b44";
    pen.font = "24px system-ui, sans-serif";
    pen.textAlign = "center";
    for (const x of round(map.x)) {
      const [at] = this.place(x, map.y[0]);
      pen.fillRect(at - 0.5, top + high, 1, 8);
      pen.fillText(number(x).replace("-", "−"), at, top + high + 34);
    }
    pen.fillText(`${map.body ? "along the track" : "x"} [${this.data.length}]`, left + wide / 2, top + high + 72);
    pen.textAlign = "right";
    for (const y of round(map.y)) {
      const [, at] = this.place(map.x[0], y);
      pen.fillRect(left - 8, at - 0.5, 8, 1);
      pen.fillText(number(y).replace("-", "−"), left - 14, at + 8);
    }
    pen.save();
    pen.translate(26, top + high / 2);
    pen.rotate(-Math.PI / 2);
    pen.textAlign = "center";
    pen.fillText(`y [${this.data.length}]`, 0, 0);
    pen.restore();
  }

  drawColours(pen) {
    const map = this.map, left = 910, top = 60, high = 680, least = map.log ? map.low : Math.min(map.low, 0);
    for (let k = 0; k < high; k++) {
      const [r, g, b] = this.colour(1 - k / high);
      pen.fillStyle = `rgb(${r},${g},${b})`;
      pen.fillRect(left, top + k, 30, 1.5);
    }
    pen.strokeStyle = "#7b858f";
    pen.strokeRect(left, top, 30, high);
    pen.fillStyle = "#333b44";
    pen.textAlign = "left";
    for (const value of map.log ? decades(least, map.top) : round([least, map.top])) {
      const at = top + high * (1 - this.share(value));
      pen.fillRect(left + 30, at - 0.5, 6, 1);
      pen.fillText(number(value).replace("-", "−"), left + 42, at + 8);
    }
    pen.textAlign = "center";
    pen.fillText(`[${map.unit}]`, left + 40, 40);
    if (map.high > map.top * 1.001) {
      pen.font = "20px system-ui, sans-serif";
      pen.fillText(`peaks to ${number(map.high)}`, left + 50, top + high + 34);
    }
  }

  drawSolid() {
    const map = this.map, [rows, columns] = map.shape, pen = this.solid.getContext("2d");
    const step = Math.max(1, Math.ceil(Math.max(rows, columns) / 90)), least = map.log ? map.low : Math.min(map.low, 0);
    const [turn, lift] = this.turn, [s, c, sl, cl] = [Math.sin(turn), Math.cos(turn), Math.sin(lift), Math.cos(lift)];
    const ratio = (map.y[1] - map.y[0]) / (map.x[1] - map.x[0]), sides = [Math.min(1, 1 / ratio), Math.min(1, ratio)];
    const put = (u, v, w) => {  // each from -.5 to .5, height from 0 to 1
      const x = u * sides[0], y = v * sides[1], z = 0.42 * (w - 0.4);
      const [across, deep] = [x * c - y * s, x * s + y * c];
      return [520 + 640 * across, 420 - 640 * (deep * sl + z * cl), deep * cl - z * sl];
    };
    pen.fillStyle = "#fff";
    pen.fillRect(0, 0, this.solid.width, this.solid.height);
    const down = /wear|plastic|pits/i.test(map.title), sign = down ? -1 : 1;
    const tall = (k) => isNaN(this.values[k]) ? NaN : (down ? 1 : 0) + sign * this.share(this.values[k]);
    const tiles = [];
    for (let j = 0; j + step < rows; j += step) {
      for (let i = 0; i + step < columns; i += step) {
        const corners = [[j, i], [j, i + step], [j + step, i + step], [j + step, i]];
        const heights = corners.map(([m, n]) => tall(m * columns + n));
        if (heights.some(isNaN)) continue;
        const points = corners.map(([m, n], k) => put(n / (columns - 1) - 0.5, m / (rows - 1) - 0.5, heights[k]));
        const slope = (heights[1] - heights[0] + heights[2] - heights[3]) * 0.5;
        const mean = heights.reduce((sum, height) => sum + height, 0) / 4;
        tiles.push([points.reduce((sum, point) => sum + point[2], 0), points, down ? 1 - mean : mean, slope]);
      }
    }
    const floor = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(([u, v]) => put(u, v, 0));
    pen.strokeStyle = "#b6bec6";
    outline(pen, floor);
    pen.stroke();
    tiles.sort((one, other) => other[0] - one[0]);
    for (const [, points, share, slope] of tiles) {
      const light = Math.min(1.15, Math.max(0.7, 1 + 1.4 * slope));
      const ink = `rgb(${this.colour(share).map((part) => Math.min(255, part * light)).join()})`;
      pen.fillStyle = pen.strokeStyle = ink;
      outline(pen, points);
      pen.fill();
      pen.stroke();
    }
    this.nameSides(pen, put, map, least);
  }

  nameSides(pen, put, map, least) {
    pen.fillStyle = "#333b44";
    pen.font = "24px system-ui, sans-serif";
    pen.textAlign = "center";
    const span = (range) => number(range[1] - range[0]);
    const front = [[0, -0.62], [0, 0.62]].map(([u, v]) => put(u, v, 0)).sort((one, other) => one[2] - other[2])[0];
    const side = [[-0.62, 0], [0.62, 0]].map(([u, v]) => put(u, v, 0)).sort((one, other) => one[2] - other[2])[0];
    pen.fillText(`${map.body ? "along the track" : "x"}: ${span(map.x)} ${this.data.length}`, front[0], front[1] + 20);
    pen.fillText(`y: ${span(map.y)} ${this.data.length}`, side[0], side[1] + 20);
    const how = map.log ? ", logarithmic" : "";
    pen.fillText(`height: ${number(least)} to ${number(map.top)} ${map.unit}${how}`, 520, 860);
  }

  read(event) {
    const frame = this.flat.getBoundingClientRect(), scale = this.flat.width / frame.width;
    const [left, top, wide, high] = this.box(), map = this.map, [rows, columns] = map.shape;
    const u = ((event.clientX - frame.left) * scale - left) / wide, v = ((event.clientY - frame.top) * scale - top) / high;
    const caption = this.flat.nextElementSibling;
    if (u < 0 || u > 1 || v < 0 || v > 1) return;
    const i = Math.min(columns - 1, Math.floor(u * columns)), j = Math.min(rows - 1, Math.floor((1 - v) * rows));
    const x = map.x[0] + i / (columns - 1) * (map.x[1] - map.x[0]), y = map.y[0] + j / (rows - 1) * (map.y[1] - map.y[0]);
    const at = `x = ${number(x)} ${this.data.length}, y = ${number(y)} ${this.data.length}`;
    caption.textContent = `${at}: ${number(this.values[j * columns + i])} ${map.unit}`;
  }

  listen() {
    this.what.addEventListener("input", () => this.show());
    this.when.addEventListener("input", () => this.show());
    this.flat.addEventListener("pointermove", (event) => this.read(event));
    this.solid.addEventListener("pointerdown", (event) => {
      this.pointer = [event.clientX, event.clientY];
      this.solid.setPointerCapture(event.pointerId);
    });
    this.solid.addEventListener("pointerup", () => { this.pointer = null; });
    this.solid.addEventListener("pointercancel", () => { this.pointer = null; });
    this.solid.addEventListener("pointermove", (event) => {
      if (!this.pointer) return;
      this.rotate((event.clientX - this.pointer[0]) / 120, (event.clientY - this.pointer[1]) / 120);
      this.pointer = [event.clientX, event.clientY];
    });
    const keys = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
    this.solid.addEventListener("keydown", (event) => {
      if (!(event.key in keys)) return;
      event.preventDefault();
      this.rotate(...keys[event.key]);
    });
    const play = this.root.querySelector(".play");
    play.addEventListener("click", () => {
      if (this.clock) return this.stop(play);
      play.textContent = "■ stop";
      if (+this.when.value === +this.when.max) this.when.value = 0;
      this.show();
      this.clock = setInterval(() => {
        if (+this.when.value === +this.when.max) return this.stop(play);
        this.when.value = +this.when.value + 1;
        this.show();
      }, 700);
    });
  }

  stop(play) {
    clearInterval(this.clock);
    this.clock = null;
    play.textContent = "▶ play";
  }

  rotate(turn, lift) {
    this.turn = [this.turn[0] + turn, Math.min(1.5, Math.max(0.15, this.turn[1] + lift))];
    this.drawSolid();
  }
}

function outline(pen, points) {
  pen.beginPath();
  points.forEach(([x, y], k) => k ? pen.lineTo(x, y) : pen.moveTo(x, y));
  pen.closePath();
}

function round([low, high]) {  // about five round numbers between two
  const rough = (high - low) / 5 || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 2.5, 5, 10].map((factor) => factor * power).find((each) => each >= rough * (1 - 1e-9));
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high * (1 + 1e-9) + 1e-30; k++) found.push(k * step);
  return found;
}

function decades(low, high) {
  const found = [];
  for (let k = Math.floor(Math.log10(low)); k <= Math.log10(high); k++) {
    for (const m of [1, 2, 5]) if (m * 10 ** k >= low && m * 10 ** k <= high) found.push(m * 10 ** k);
  }
  return found;
}

const maps = document.getElementById("maps-data");
if (maps) new Maps(maps.closest(".viewer"), JSON.parse(maps.textContent));

// ---- paper --------------------------------------------------------------------------------------------------------
addEventListener("beforeprint", () => document.querySelectorAll("details").forEach((each) => { each.open = true; }));
