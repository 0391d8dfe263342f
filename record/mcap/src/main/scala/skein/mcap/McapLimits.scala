package skein.mcap

/** A reader's limits, whatever a file states. Nothing is allocated for a size beyond them.
  *
  * @param recordBytes one record, thus one message, one attachment, or one chunk as stored
  * @param chunkBytes the records of one chunk, uncompressed
  */
final case class McapLimits(
    recordBytes: Int = 256 << 20,
    chunkBytes: Int = 256 << 20
):
  require(recordBytes >= 32 && chunkBytes > 0, s"no limit below that: $this")

  private[mcap] def hold(claimed: Long, limit: Long, what: String, at: Place): Unit =
    if java.lang.Long.compareUnsigned(claimed, limit) > 0 then
      throw Refused(McapError.TooLarge(at, what, claimed, limit))
