"""What a file holds, a line for each thing, as OfficialPythonLibraryLiveSuite tells it too."""


def text(value):
    return value.encode().hex() or "-"


def told_map(entries):
    return ",".join(f"{text(key)}={text(value)}" for key, value in entries.items()) or "-"


def told_message(schema, channel, message):
    named = f"{text(schema.name)} {text(schema.encoding)} {schema.data.hex() or '-'}" if schema else "none"
    return (
        f"message {text(channel.topic)} {text(channel.message_encoding)} {told_map(channel.metadata)} {named} "
        f"{message.sequence} {message.log_time} {message.publish_time} {message.data.hex() or '-'}"
    )


def told_attachment(one):
    return f"attachment {one.log_time} {one.create_time} {text(one.name)} {text(one.media_type)} {one.data.hex() or '-'}"


def told_metadata(one):
    return f"metadata {text(one.name)} {told_map(one.metadata)}"
