"""Writes files into a folder with the official library, in every way that it has, and beside each what is in it."""

import itertools
import pathlib
import random
import sys

from mcap.records import Attachment, Channel, Message, Metadata, Schema
from mcap.writer import CompressionType, IndexType, Writer
from telling import told_attachment, told_message, told_metadata

folder = pathlib.Path(sys.argv[1])
count = 0
for seed, (compression, index, chunking, crcs, data_crcs) in enumerate(
    itertools.product(CompressionType, (IndexType.ALL, IndexType.NONE), (True, False), (True, False), (True, False))
):
    draw = random.Random(seed)
    path = folder / f"written{seed}.mcap"
    writer = Writer(
        str(path),
        # Of some files, every chunk has several of LZ4's blocks of 64 kB, which look back into one another.
        chunk_size=draw.choice((300, 5000, 400_000)),
        compression=compression,
        index_types=index,
        use_chunking=chunking,
        enable_crcs=crcs,
        enable_data_crcs=data_crcs,
        repeat_channels=draw.random() < 0.8,
        use_statistics=draw.random() < 0.8,
        use_summary_offsets=draw.random() < 0.8,
    )
    writer.start("", "official")
    messages, attachments, metadata = [], [], []
    schemas = {0: None}
    for number in range(2):
        schema = Schema(id=0, name=f"Pose{number}", encoding="jsonschema", data=b'{"type": "object"}')
        schemas[writer.register_schema(schema.name, schema.encoding, schema.data)] = schema
    channels = {}
    for number in range(3):
        channel = Channel(id=0, topic=f"/ä{number}", message_encoding="json", metadata={"n": f"{number}"}, schema_id=number)
        channels[writer.register_channel(channel.topic, channel.message_encoding, number, channel.metadata)] = channel
    words = [draw.randbytes(40) for _ in range(9)]
    for step in range(2000 if seed % 3 == 0 else 60):
        time = step * 1000 + draw.randrange(3000)
        message = Message(
            channel_id=draw.choice(list(channels)),
            log_time=time,
            publish_time=time + 1,
            sequence=step,
            data=b"".join(draw.choices(words, k=draw.randrange(20))),
        )
        writer.add_message(message.channel_id, message.log_time, message.data, message.publish_time, message.sequence)
        channel = channels[message.channel_id]
        messages.append(told_message(schemas[channel.schema_id], channel, message))
        if step % 25 == 3:
            one = Attachment(log_time=time, create_time=0, name=f"a{step}", media_type="text/plain", data=draw.randbytes(9))
            writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)
            attachments.append(told_attachment(one))
            described = Metadata(name=f"m{step}", metadata={"step": f"{step}"})
            writer.add_metadata(described.name, described.metadata)
            metadata.append(told_metadata(described))
    writer.finish()
    path.with_suffix(".txt").write_text("".join(line + "\n" for line in messages + attachments + metadata))
    count += 1
print(f"WROTE {count} files")
