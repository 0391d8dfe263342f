package skein.mcap

/** What a writer writes beside the records that it is given. What is on by default is what readers need to
  * find messages by time and topic without reading the whole file.
  *
  * @param profile of the header: what the file's fields keep to, such as `ros2`; empty for none
  * @param library of the header: who wrote it
  * @param chunked whether messages are gathered in chunks; without, nothing is compressed, and nothing can be
  *   found by index
  * @param chunkBytes a chunk ends with the message that makes it so long, uncompressed
  * @param messageIndex behind each chunk, where each channel's messages are in it
  * @param chunkIndex in the summary, where the chunks are
  * @param statistics in the summary, how many there are of everything, and between which times
  * @param repeatSchemas in the summary; as `repeatChannels`, what an index is worth little without
  * @param attachmentIndex in the summary, where attachments are; as `metadataIndex` for metadata
  * @param summaryOffsets behind the summary, where its parts are
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
  require(chunkBytes > 0, s"expected a chunk of at least a byte, came $chunkBytes")
