package skein.ros.message

import scala.util.Random

/** Damages sample messages by a seed, and reads them as any type. Every message must be read or refused. */
private object MalformedCdr:
  /** @return the numbers of messages read and refused */
  def read(count: Int, seed: Long): (read: Int, refused: Int) =
    val random          = Random(seed)
    val (intact, kinds) = (Samples.written.map(_.bytes), Samples.all)
    var taken           = 0
    for number <- 0 until count do
      val bytes = damaged(intact(random.nextInt(intact.size)), random)
      val kind  = kinds(random.nextInt(kinds.size))
      try
        kind.read(bytes) match
          case Right(value) =>
            taken += 1
            // A value that was read can be written; its encoding is unique except for byte order and padding.
            require(kind.read(Samples.Sample(value.asInstanceOf[Any])(using
              kind.kind.asInstanceOf
            ).written).isRight)
          case Left(why) => require(why.startsWith("expected"), why)
      catch
        case failure: Throwable =>
          throw AssertionError(s"seed $seed, message $number as ${kind.kind}: $failure", failure)
    (read = taken, refused = count - taken)

  private def damaged(bytes: Array[Byte], random: Random): Array[Byte] =
    val copy = bytes.clone
    random.nextInt(4) match
      case 0 => copy.take(random.nextInt(copy.length + 1))
      case 1 => copy ++ Array.fill(random.nextInt(64))(random.nextInt().toByte)
      case 2 =>
        // Counts and lengths are whole words.
        val at = 4 * random.nextInt(copy.length / 4)
        val _  = java.nio.ByteBuffer.wrap(copy).putInt(at, random.nextInt() >> random.nextInt(32))
        copy
      case _ =>
        for _ <- 0 to random.nextInt(8) do copy(random.nextInt(copy.length)) = random.nextInt().toByte
        copy
