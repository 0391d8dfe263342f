// The official TypeScript library's twin of McapSpeed: ROUNDS KIND CORPUS. It has no compressor for LZ4.
import { crc32Final, crc32Init, crc32Update } from "@foxglove/crc";
import zstd from "@foxglove/wasm-zstd";
import { McapStreamReader, McapWriter } from "@mcap/core";
import { FileHandleWritable } from "@mcap/nodejs";
import { loadDecompressHandlers } from "@mcap/support";
import { closeSync, openSync, readFileSync, readSync, statSync, unlinkSync } from "node:fs";
import { open } from "node:fs/promises";

const [rounds, kind, corpus] = [Number(process.argv[2]), process.argv[3], process.argv[4]];
const content = readFileSync(corpus);
const messages = [];
let megabytes = 0;
for (let at = 0; at < content.length; ) {
  const length = content.readUInt32LE(at + 8);
  messages.push({ logTime: content.readBigUInt64LE(at), data: new Uint8Array(content.buffer, content.byteOffset + at + 12, length) });
  megabytes += length / 1e6;
  at += 12 + length;
}
await zstd.isLoaded;
const decompressHandlers = await loadDecompressHandlers();
const path = `${corpus}.typescript.mcap`;
const cpu = () => { const used = process.cpuUsage(); return (used.user + used.system) / 1e6; };
for (const [name, level] of [["none", 0], ["zstd 1", 1], ["zstd 3", 3]]) {
  let bestWrite = Infinity, bestRead = Infinity, witness;
  for (let round = 0; round < rounds; round++) {
    const begin = cpu();
    const file = await open(path, "w");
    const writer = new McapWriter({
      writable: new FileHandleWritable(file),
      compressChunk: level === 0 ? undefined : (data) => ({ compression: "zstd", compressedData: zstd.compress(data, level) }),
    });
    await writer.start();
    const channelId = await writer.registerChannel({ topic: "/speed", messageEncoding: "raw", schemaId: 0, metadata: new Map() });
    for (let sequence = 0; sequence < messages.length; sequence++) {
      const { logTime, data } = messages[sequence];
      await writer.addMessage({ channelId, sequence, logTime, publishTime: logTime, data });
    }
    await writer.end();
    await file.close();
    const written = cpu();
    const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
    let sum = crc32Init(), count = 0;
    const input = openSync(path, "r");
    for (;;) {
      const piece = new Uint8Array(1 << 20);
      const got = readSync(input, piece);
      if (got === 0) break;
      reader.append(piece.subarray(0, got));
      for (let record; (record = reader.nextRecord()); ) {
        if (record.type === "Message") { sum = crc32Update(sum, record.data); count++; }
      }
    }
    closeSync(input);
    const read = cpu();
    if (count !== messages.length || !reader.done()) throw new Error(`${count} of ${messages.length} messages`);
    bestWrite = Math.min(bestWrite, written - begin);
    bestRead = Math.min(bestRead, read - written);
    witness = (crc32Final(sum) >>> 0).toString(16).padStart(8, "0");
  }
  const size = (statSync(path).size / 1e6).toFixed(1);
  console.log(`| TypeScript write | ${kind} | ${name} | ${(megabytes / bestWrite).toFixed(0)} | ${size} | ${witness} |`);
  console.log(`| TypeScript read | ${kind} | ${name} | ${(megabytes / bestRead).toFixed(0)} | ${size} | ${witness} |`);
}
unlinkSync(path);
