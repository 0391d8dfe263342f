package skein.mavlink

/** MAVLink's checksum of 16 bits: CRC-16/MCRF4XX, which the definitions call X.25. */
opaque type Checksum = Int

object Checksum:
  val Start: Checksum = 0xffff

  extension (sum: Checksum)
    def value: Int = sum

    def add(byte: Int): Checksum =
      val low   = (byte ^ sum) & 0xff
      val with4 = (low ^ (low << 4)) & 0xff
      (sum >> 8) ^ (with4 << 8) ^ (with4 << 3) ^ (with4 >> 4)

    def add(bytes: Array[Byte]): Checksum = add(bytes, 0, bytes.length)

    def add(bytes: Array[Byte], from: Int, until: Int): Checksum =
      var all   = sum
      var index = from
      while index < until do
        all = all.add(bytes(index).toInt)
        index += 1
      all
