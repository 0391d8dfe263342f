"""The official Python library's twin of McapSpeed: ROUNDS KIND CORPUS."""

import os
import struct
import sys
import time
import zlib

from mcap.reader import NonSeekingReader
from mcap.writer import CompressionType, Writer

rounds, kind, corpus = int(sys.argv[1]), sys.argv[2], sys.argv[3]
with open(corpus, "rb") as file:
    content = file.read()
messages, at = [], 0
while at < len(content):
    log_time, length = struct.unpack_from("<QI", content, at)
    messages.append((log_time, content[at + 12 : at + 12 + length]))
    at += 12 + length
megabytes = sum(len(data) for _, data in messages) / 1e6
path = corpus + ".python.mcap"
for name, compression in (("none", CompressionType.NONE), ("lz4", CompressionType.LZ4), ("zstd 3", CompressionType.ZSTD)):
    best_write = best_read = float("inf")
    for _ in range(rounds):
        begin = time.process_time()
        with open(path, "wb") as file:
            writer = Writer(file, compression=compression, enable_data_crcs=True)
            writer.start()
            channel = writer.register_channel("/speed", "raw", 0)
            for number, (log_time, data) in enumerate(messages):
                writer.add_message(channel, log_time, data, log_time, number)
            writer.finish()
        written = time.process_time()
        witness = count = 0
        with open(path, "rb") as file:
            for _, _, message in NonSeekingReader(file, validate_crcs=True).iter_messages(log_time_order=False):
                witness = zlib.crc32(message.data, witness)
                count += 1
        read = time.process_time()
        assert count == len(messages)
        best_write, best_read = min(best_write, written - begin), min(best_read, read - written)
    size = os.path.getsize(path) / 1e6
    print(f"| Python write | {kind} | {name} | {megabytes / best_write:.0f} | {size:.1f} | {witness:08x} |")
    print(f"| Python read | {kind} | {name} | {megabytes / best_read:.0f} | {size:.1f} | {witness:08x} |")
os.remove(path)
