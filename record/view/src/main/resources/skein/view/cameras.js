// What cameras and lidars see, from messages of Protocol Buffers, by Foxglove's schemas.

const text = bytes => new TextDecoder().decode(bytes);

/** The fields of a message, by number; of repeated ones the last. */
function fields(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), found = [];
  let at = 0;
  const varint = () => {
    let value = 0, scale = 1, byte;
    do { byte = view.getUint8(at++); value += (byte & 127) * scale; scale *= 128; } while (byte > 127);
    return value;
  };
  while (at < bytes.length) {
    const tag = varint(), number = tag >> 3;
    switch (tag & 7) {
      case 0: found[number] = varint(); break;
      case 1: found[number] = view.getFloat64(at, true); at += 8; break;
      case 2: { const size = varint(); found[number] = bytes.subarray(at, at + size); at += size; break; }
      case 5: found[number] = view.getUint32(at, true); at += 4; break;
      default: throw new Error(`no such field: ${tag}`);
    }
  }
  return found;
}

function nanoseconds(time) {
  const [, seconds = 0, nanos = 0] = fields(time);
  return BigInt(seconds) * 1000000000n + BigInt(nanos);
}

/** Where the points of a foxglove.PointCloud are, from above: north and east of each, m, one after the other. Those on the
 *  ground are left out. */
export function pointsOf(bytes) {
  const [, , , pose, , , data] = fields(bytes), [, position, orientation] = fields(pose);
  const [, north = 0, east = 0, down = 0] = fields(position), [, x = 0, y = 0, z = 0, w = 0] = fields(orientation);
  const own = new DataView(data.buffer, data.byteOffset, data.byteLength), points = [];
  for (let at = 0; at + 12 <= data.length; at += 12) {
    const [f, r, d] = [0, 4, 8].map(offset => own.getFloat32(at + offset, true));
    if (down + 2 * (x * z - w * y) * f + 2 * (y * z + w * x) * r + (1 - 2 * (x * x + y * y)) * d > -0.2) continue;
    points.push(
      north + (1 - 2 * (y * y + z * z)) * f + 2 * (x * y - w * z) * r + 2 * (x * z + w * y) * d,
      east + 2 * (x * y + w * z) * f + (1 - 2 * (x * x + z * z)) * r + 2 * (y * z - w * x) * d,
    );
  }
  return points;
}

/** The cameras' newest images, side by side. An image that comes while one is decoded waits, and the newest wins. */
export class Cameras {
  constructor(section) {
    this.section = section;
    this.place = section.querySelector("div");
    this.clear();
  }

  clear() {
    this.cameras = new Map();
    this.place.replaceChildren();
    this.section.hidden = true;
  }

  /** Takes a foxglove.CompressedImage.
   *  @param logNs when it came to the controller */
  take(topic, bytes, logNs) {
    const camera = this.cameras.get(topic) ?? this.add(topic);
    camera.came.push(Number(logNs) / 1e9);
    while (camera.came.length > 1 && camera.came.at(-1) - camera.came[0] > 2) camera.came.shift();
    camera.waiting = { bytes, logNs };
    if (!camera.busy) this.decode(camera);
  }

  add(topic) {
    const [, , vehicle, ...name] = topic.split("/");
    const figure = document.createElement("figure"), canvas = document.createElement("canvas"), words = document.createElement("figcaption");
    const camera = { name: `${vehicle}, ${name.slice(0, -1).join("/")}`, canvas, words, came: [], shown: 0 };
    figure.append(canvas, words);
    figure.onclick = () => figure.classList.toggle("large");
    this.place.append(figure);
    this.cameras.set(topic, camera);
    this.section.hidden = false;
    return camera;
  }

  async decode(camera) {
    camera.busy = true;
    while (camera.waiting) {
      const { bytes, logNs } = camera.waiting;
      camera.waiting = undefined;
      const [, time, data, format] = fields(bytes);
      const picture = await createImageBitmap(new Blob([data], { type: `image/${text(format)}` })).catch(() => undefined);
      if (!picture) continue;
      if (camera.canvas.width !== picture.width) camera.canvas.width = picture.width;
      if (camera.canvas.height !== picture.height) camera.canvas.height = picture.height;
      camera.canvas.getContext("2d").drawImage(picture, 0, 0);
      picture.close();
      camera.shown++;
      const { came } = camera, rate = came.length > 1 ? (came.length - 1) / (came.at(-1) - came[0]) : 0;
      camera.words.textContent = `${camera.name}: ${Number((logNs - nanoseconds(time)) / 1000000n)} ms from exposure to arrival${rate > 0 ? `, ${rate.toFixed(0)}/s` : ""}`;
    }
    camera.busy = false;
  }
}
