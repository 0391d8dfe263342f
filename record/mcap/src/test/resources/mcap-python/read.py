"""Opens every file of a folder with the official library, by stream and by index, with every CRC held, and tells what it
finds: NAME.stream.txt and, of files that have indexes, NAME.index.txt."""

import pathlib
import sys

from mcap.reader import NonSeekingReader, SeekingReader
from mcap.stream_reader import StreamReader
from telling import told_attachment, told_message, told_metadata


def told(reader):
    lines = [told_message(*found) for found in reader.iter_messages(log_time_order=isinstance(reader, SeekingReader))]
    return lines


count = 0
for path in sorted(pathlib.Path(sys.argv[1]).glob("*.mcap")):
    with path.open("rb") as file:
        for _ in StreamReader(file, validate_crcs=True).records:
            pass
    with path.open("rb") as file:
        lines = told(NonSeekingReader(file, validate_crcs=True))
    with path.open("rb") as file:
        lines += [told_attachment(one) for one in NonSeekingReader(file, validate_crcs=True).iter_attachments()]
    with path.open("rb") as file:
        lines += [told_metadata(one) for one in NonSeekingReader(file, validate_crcs=True).iter_metadata()]
    path.with_suffix(".stream.txt").write_text("".join(line + "\n" for line in lines))
    if path.name.startswith("indexed"):
        with path.open("rb") as file:
            reader = SeekingReader(file, validate_crcs=True)
            lines = told(reader)
            lines += [told_attachment(one) for one in reader.iter_attachments()]
            lines += [told_metadata(one) for one in reader.iter_metadata()]
            statistics = reader.get_summary().statistics
            lines.append(
                f"statistics {statistics.message_count} {statistics.chunk_count} "
                f"{statistics.message_start_time} {statistics.message_end_time}"
            )
        path.with_suffix(".index.txt").write_text("".join(line + "\n" for line in lines))
    count += 1
print(f"READ {count} files")
