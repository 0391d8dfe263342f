package skein.mavlink

/** Encodes frames of one component with sequence numbers. Not thread-safe.
  *
  * @param signing without it frames are not signed
  */
final class FrameWriter(system: Int, component: Int, signing: Option[Signing] = None):
  require((1 to 255).contains(system), s"expected a system from 1 to 255, got $system")
  require((1 to 255).contains(component), s"expected a component from 1 to 255, got $component")

  private var sequence = 0

  /** Encodes a message as a frame of at most [[Frame.MostLength]] bytes. */
  def write(message: Message): Array[Byte] =
    val definition = Dialect.of(message)
    val payload    = definition.encode(message)
    val flags      = if signing.isDefined then Frame.Signed else 0
    val numbers    =
      Seq(payload.length, flags, 0, sequence, system, component) ++ Seq(0, 8, 16).map(definition.id >> _)
    val told  = numbers.map(_.toByte).toArray ++ payload
    val sum   = Checksum.Start.add(told).add(definition.crcExtra).value
    val frame = Frame.Start.toByte +: (told ++ Array(sum.toByte, (sum >> 8).toByte))
    sequence = (sequence + 1) & 0xff
    frame ++ signing.fold(Array.emptyByteArray)(_.sign(frame))
