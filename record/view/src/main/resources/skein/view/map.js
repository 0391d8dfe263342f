// The vehicles from above, north up: what stands there and what lidars see of it, trails, plans, where each is expected when
// its command acts, and the velocity commanded.

export class FlightMap {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.view = undefined;
  }

  draw(flight) {
    const { canvas, pen } = this;
    const ratio = devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (canvas.width !== Math.round(width * ratio)) canvas.width = Math.round(width * ratio);
    if (canvas.height !== Math.round(height * ratio)) canvas.height = Math.round(height * ratio);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = "#fbfcfd";
    pen.fillRect(0, 0, width, height);
    const vehicles = [...flight.vehicles.values()].filter(vehicle => vehicle.north !== undefined);
    if (!vehicles.length) return;
    this.follow(vehicles, width, height);
    const { north, east, scale } = this.view;
    const x = value => width / 2 + (value - east) * scale;
    const y = value => height / 2 - (value - north) * scale;
    this.grid(width, height, x, y);
    this.obstacles(flight.obstacles, width, height, x, y);
    this.clouds(flight.clouds, x, y);
    const close = vehicles.length > 8;
    for (const vehicle of vehicles) {
      this.trail(vehicle, flight.now, x, y);
      const px = x(vehicle.east), py = y(vehicle.north);
      if (vehicle.plan && !flight.paused) this.plan(vehicle, x, y);
      if (vehicle.predicted && !flight.paused) {
        pen.strokeStyle = pen.fillStyle = vehicle.colour;
        pen.lineWidth = 1.5;
        pen.setLineDash([3, 3]);
        line(pen, px, py, x(vehicle.predicted.east), y(vehicle.predicted.north));
        pen.setLineDash([]);
        pen.beginPath();
        pen.arc(x(vehicle.predicted.east), y(vehicle.predicted.north), 5, 0, 7);
        pen.stroke();
        if (vehicle.errorM * scale > 5) {
          pen.globalAlpha = 0.35;
          pen.beginPath();
          pen.arc(x(vehicle.predicted.east), y(vehicle.predicted.north), vehicle.errorM * scale, 0, 7);
          pen.stroke();
          pen.globalAlpha = 1;
        }
      }
      if (vehicle.command && !flight.paused) {
        const from = vehicle.predicted ?? vehicle;
        pen.strokeStyle = "rgba(40,50,70,.45)";
        pen.lineWidth = 1.5;
        arrow(pen, x(from.east), y(from.north), x(from.east + vehicle.command.east), y(from.north + vehicle.command.north));
      }
      this.body(vehicle, px, py);
      pen.fillStyle = "#1d2430";
      pen.font = "12px sans-serif";
      if (!close) pen.fillText(vehicle.name, px + 10, py - 8);
    }
  }

  /** Fits the vehicles and what they have flown; the scale changes slowly, so that the eye can follow. */
  follow(vehicles, width, height) {
    let [top, bottom, left, right] = [-Infinity, Infinity, Infinity, -Infinity];
    const seen = (n, e) => { top = Math.max(top, n); bottom = Math.min(bottom, n); left = Math.min(left, e); right = Math.max(right, e); };
    for (const vehicle of vehicles) {
      seen(vehicle.north, vehicle.east);
      for (const point of vehicle.trail) seen(point[1], point[2]);
    }
    const wanted = {
      north: (top + bottom) / 2, east: (left + right) / 2,
      scale: Math.min(width / (right - left + 10), height / (top - bottom + 10)) * 0.9,
    };
    const now = performance.now(), share = 1 - Math.exp((this.followed - now) / 250);
    this.followed = now;
    if (!this.view) this.view = wanted;
    else for (const key of ["north", "east", "scale"]) this.view[key] += (wanted[key] - this.view[key]) * share;
  }

  grid(width, height, x, y) {
    const { pen, view } = this;
    const step = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find(step => step * view.scale > 60) ?? 5000;
    pen.strokeStyle = "#e9edf2";
    pen.fillStyle = "#98a2b3";
    pen.lineWidth = 1;
    pen.font = "10px sans-serif";
    for (let east = Math.ceil((view.east - width / 2 / view.scale) / step) * step; x(east) < width; east += step) {
      line(pen, x(east), 0, x(east), height);
      pen.fillText(`${east} m`, x(east) + 3, height - 5);
    }
    for (let north = Math.ceil((view.north - height / 2 / view.scale) / step) * step; y(north) > 0; north += step) {
      line(pen, 0, y(north), width, y(north));
      if (y(north) > 30 && y(north) < height - 16) pen.fillText(`${north} m`, width - 38, y(north) - 3);
    }
    pen.strokeStyle = "#98a2b3";
    arrow(pen, 12, height - 26, 12, height - 56);
    arrow(pen, 12, height - 26, 42, height - 26);
    pen.fillText("north", 8, height - 61);
    pen.fillText("east", 46, height - 22);
  }

  obstacles(all, width, height, x, y) {
    const { pen, view } = this;
    pen.lineWidth = 1;
    for (const { north, east, reach, corners, rgb } of all) {
      const px = x(east), py = y(north), far = reach * view.scale;
      if (px + far < 0 || px - far > width || py + far < 0 || py - far > height) continue;
      pen.fillStyle = `rgba(${rgb},.4)`;
      pen.strokeStyle = `rgba(${rgb},.9)`;
      pen.beginPath();
      if (corners) {
        for (const [n, e] of corners) pen.lineTo(x(e), y(n));
        pen.closePath();
      } else pen.arc(px, py, Math.max(far, 1.5), 0, 7);
      pen.fill();
      pen.stroke();
    }
  }

  clouds(all, x, y) {
    const { pen } = this;
    for (const { points, colour } of all.values()) {
      pen.fillStyle = colour;
      pen.globalAlpha = 0.6;
      for (let at = 0; at < points.length; at += 2) pen.fillRect(x(points[at + 1]) - 1, y(points[at]) - 1, 2, 2);
      pen.globalAlpha = 1;
    }
  }

  /** Where its plan leads, with a dot for each half second. */
  plan({ plan: { north, east, stepS }, colour }, x, y) {
    const { pen } = this, every = Math.max(1, Math.round(0.5 / stepS));
    pen.strokeStyle = pen.fillStyle = colour;
    pen.lineWidth = 1.5;
    pen.setLineDash([1, 4]);
    pen.beginPath();
    north.forEach((value, at) => pen.lineTo(x(east[at]), y(value)));
    pen.stroke();
    pen.setLineDash([]);
    for (let at = every - 1; at < north.length; at += every) {
      pen.beginPath();
      pen.arc(x(east[at]), y(north[at]), 2, 0, 7);
      pen.fill();
    }
  }

  trail(vehicle, now, x, y) {
    const { pen } = this, { trail } = vehicle;
    pen.strokeStyle = vehicle.colour;
    pen.lineWidth = 2;
    // In pieces, each as faint as it is old.
    for (let from = 0; from < trail.length - 1; from += 20) {
      const piece = trail.slice(from, from + 21);
      pen.globalAlpha = Math.max(0.08, 0.7 - (now - piece[0][0]) / 28);
      pen.beginPath();
      piece.forEach(([, north, east], at) => at ? pen.lineTo(x(east), y(north)) : pen.moveTo(x(east), y(north)));
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  body(vehicle, px, py) {
    const { pen } = this;
    const fast = Math.hypot(vehicle.velocityNorth, vehicle.velocityEast) > 0.3;
    if (fast) vehicle.course = Math.atan2(vehicle.velocityEast, vehicle.velocityNorth);
    const car = vehicle.kind === "Car";
    pen.save();
    pen.translate(px, py);
    pen.rotate(fast || car ? vehicle.course ?? 0 : 0);
    pen.fillStyle = vehicle.colour;
    pen.beginPath();
    // A car from above: its windscreen is left open.
    if (car) { pen.rect(-5, -10, 10, 6); pen.rect(-5, -1, 10, 11); }
    else if (fast) { pen.moveTo(0, -9); pen.lineTo(6, 7); pen.lineTo(0, 3); pen.lineTo(-6, 7); }
    else pen.arc(0, 0, 6, 0, 7);
    pen.fill();
    pen.restore();
  }
}

function line(pen, x0, y0, x1, y1) {
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1, y1);
  pen.stroke();
}

function arrow(pen, x0, y0, x1, y1) {
  const angle = Math.atan2(y1 - y0, x1 - x0);
  line(pen, x0, y0, x1, y1);
  for (const side of [-0.5, 0.5]) line(pen, x1, y1, x1 - 7 * Math.cos(angle + side), y1 - 7 * Math.sin(angle + side));
}
