package skein.mcap

/** Parts that a writer adds to the given records. The defaults are what readers need to find messages by time
  * and topic without reading the whole file.
  *
  * @param profile the header's profile: a convention for the file's fields, such as `ros2`; empty for none
  * @param library the header's library: the writing program
  * @param chunked whether messages are gathered in chunks; otherwise nothing is compressed or indexed
  * @param chunkBytes a chunk ends with the message that makes it this long, uncompressed
  * @param messageIndex whether each chunk is followed by the positions of each channel's messages in it
  * @param chunkIndex whether the summary lists the positions of the chunks
  * @param statistics whether the summary states the number of records of each kind and the range of times
  * @param repeatSchemas whether the summary repeats the schemas; likewise `repeatChannels` the channels,
  *   without which an index is of little use
  * @param attachmentIndex whether the summary lists the positions of attachments; likewise `metadataIndex`
  *   those of metadata
  * @param summaryOffsets whether the summary is followed by the positions of its parts
  */
final case class WriterOptions(
    profile: String = "",
    library: String = "skein-mcap",
    chunked: Boolean = true,
    chunkBytes: Int = 1 << 20,
    compression: Compression = Compression.Zstd(),
    messageIndex: Boolean = true,
    chunkIndex: Boolean = true,
    statistics: Boolean = true,
    repeatSchemas: Boolean = true,
    repeatChannels: Boolean = true,
    attachmentIndex: Boolean = true,
    metadataIndex: Boolean = true,
    summaryOffsets: Boolean = true
):
  require(chunkBytes > 0, s"expected a chunk of at least a byte, got $chunkBytes")
