// Foxglove's WebSocket protocol, as far as the page needs it.

const protocols = ["foxglove.sdk.v1", "foxglove.websocket.v1"];
const statuses = ["playing", "paused", "buffering", "ended"];

/** Connects, again after a second where the connection ends, and subscribes to what is wanted.
 *  @param on info(serverInfo), row(topic, row, logNs) of JSON, sight(topic, bytes, logNs) of Protocol Buffers, time(ns), playback(state), warning(id, text), closed() */
export function connect(path, wanted, on) {
  let socket, ended = false, timer, sign;
  const open = () => {
    const topics = new Map();
    socket = new WebSocket(`ws://${location.host}${path}`, protocols);
    socket.binaryType = "arraybuffer";
    socket.onmessage = ({ data }) => typeof data === "string" ? text(JSON.parse(data), topics) : bytes(data, topics);
    socket.onclose = () => { if (!ended) { timer = setTimeout(open, 1000); on.closed(); } };
  };
  const text = (message, topics) => {
    if (message.op === "serverInfo") on.info(message);
    else if (message.op === "status") on.warning(message.id, message.message);
    else if (message.op === "advertise") {
      const chosen = message.channels.filter(channel => wanted(channel.topic));
      for (const { id, topic, encoding } of chosen) topics.set(id, { topic, isBinary: encoding === "protobuf" });
      socket.send(JSON.stringify({ op: "subscribe", subscriptions: chosen.map(({ id }) => ({ id, channelId: id })) }));
    }
  };
  const bytes = (buffer, topics) => {
    const view = new DataView(buffer);
    switch (view.getUint8(0)) {
      case 1: {
        const { topic, isBinary } = topics.get(view.getUint32(1, true)), data = new Uint8Array(buffer, 13), logNs = view.getBigUint64(5, true);
        if (isBinary) on.sight(topic, data, logNs);
        else on.row(topic, JSON.parse(new TextDecoder().decode(data)), logNs);
        break;
      }
      case 2: on.time(view.getBigUint64(1, true)); break;
      case 5: on.playback({
        status: statuses[view.getUint8(1)], now: view.getBigUint64(2, true), speed: view.getFloat32(10, true), seeked: view.getUint8(14) === 1,
      });
    }
  };
  open();
  // Who says nothing makes room where many want to look; this asks for nothing.
  sign = setInterval(() => { if (socket.readyState === WebSocket.OPEN) socket.send('{"op":"subscribe","subscriptions":[]}'); }, 3000);
  return {
    isOpen() { return socket.readyState === WebSocket.OPEN; },
    close() { ended = true; clearTimeout(timer); clearInterval(sign); socket.close(); },
    /** Plays or stands, and jumps where a time is given. */
    play(playing, speed, seekNs) {
      if (socket.readyState !== WebSocket.OPEN) return;
      const request = new DataView(new ArrayBuffer(19));
      request.setUint8(0, 3);
      request.setUint8(1, playing ? 0 : 1);
      request.setFloat32(2, speed, true);
      request.setUint8(6, seekNs === undefined ? 0 : 1);
      request.setBigUint64(7, seekNs ?? 0n, true);
      socket.send(request.buffer);
    },
  };
}
