// Foxglove's own client: subscribes to every topic, holds every message to its topic's schema, and says what it saw.
// node client.mjs FOLDER-OF-PACKAGES WEBSOCKET-URL SUBPROTOCOL READINGS TOPIC…, until it has seen so many readings and
// something of each of these topics, or 90 s have passed, or the connection or standard input ends
import { createRequire } from "node:module";
import { join, resolve } from "node:path";

const [folder, url, protocol, enough, ...needed] = process.argv.slice(2);
const require = createRequire(join(resolve(folder), "node_modules", "none.js"));
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const WebSocket = require("ws");
const Ajv = require("ajv");
const { createFileRegistry, fromBinary } = require("@bufbuild/protobuf");
const { FileDescriptorSetSchema } = require("@bufbuild/protobuf/wkt");

// A flight is listed when it has started.
const listed = new URL(url.replace(/^ws/, "http")), flight = listed.pathname.split("/").pop();
for (const end = Date.now() + 60_000; Date.now() < end; await new Promise(again => setTimeout(again, 50))) {
  const flights = await (await fetch(new URL("/flights", listed))).json();
  if (flights.some(one => one.id === flight)) break;
}

const schemas = new Ajv({ strict: false, validateFormats: false });
const socket = new WebSocket(url, [protocol]);
const client = new FoxgloveClient({ ws: socket });
const topics = new Map(), bySubscription = new Map(), wrong = [], readings = [], statuses = [];
let info;

client.on("serverInfo", event => { info = event; });
client.on("status", event => statuses.push(event.message));
client.on("error", event => wrong.push(String(event)));
client.on("advertise", channels => {
  for (const channel of channels) {
    const topic = { name: channel.topic, schema: channel.schemaName, messages: 0 };
    if (channel.encoding === "protobuf") 
      topic.type = createFileRegistry(fromBinary(FileDescriptorSetSchema, Buffer.from(channel.schema, "base64"))).getMessage(channel.schemaName);
    else topic.valid = schemas.compile(JSON.parse(channel.schema));
    topics.set(channel.topic, topic);
    bySubscription.set(client.subscribe(channel.id), topic);
  }
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const topic = bySubscription.get(subscriptionId);
  topic.messages++;
  if (topic.type) {
    const message = fromBinary(topic.type, new Uint8Array(data.buffer, data.byteOffset, data.byteLength));
    if (!message.data?.length) wrong.push(`${topic.name}: no data`);
    // JPEG's first bytes.
    if (message.format === "jpeg" && (message.data[0] !== 0xff || message.data[1] !== 0xd8)) wrong.push(`${topic.name}: no JPEG`);
    return;
  }
  const message = JSON.parse(new TextDecoder().decode(data));
  if (!topic.valid(message)) wrong.push(`${topic.name}: ${schemas.errorsText(topic.valid.errors)}`);
  if (topic.name === "/skein/reading") readings.push([message.vehicle, message.sequence, message.positionNorthM, String(timestamp)]);
  if (readings.length >= enough && needed.every(name => topics.get(name)?.messages > 0)) tell();
});
const tell = () => {
  console.log(JSON.stringify({
    protocol: socket.protocol, info, statuses, wrong: wrong.slice(0, 10), readings,
    topics: [...topics.values()].map(({ name, schema, messages }) => ({ name, schema, messages })),
  }));
  process.exit(0);
};
client.on("close", tell);
process.stdin.on("end", tell).resume();
setTimeout(tell, 90_000);
