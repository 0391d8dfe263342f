package skein.mavlink

/** A received message and its sender.
  *
  * @param system 1 to 255: a vehicle, or a ground station
  * @param component a part of it; 1 is the autopilot
  * @param sequence 0 to 255, one more with every frame of that component
  * @param isSigned whether it had a valid signature
  */
final case class Frame(
    system: Int,
    component: Int,
    sequence: Int,
    message: Message,
    isSigned: Boolean = false
)

object Frame:
  /** The first byte of every MAVLink 2 frame, and of every MAVLink 1 frame. */
  private[mavlink] val Start         = 0xfd
  private[mavlink] val StartVersion1 = 0xfe

  private[mavlink] val HeaderLength         = 10
  private[mavlink] val HeaderLengthVersion1 = 6
  private[mavlink] val ChecksumLength       = 2
  private[mavlink] val SignatureLength      = 13

  /** The only supported one of the flags that a receiver must understand: a signature follows. */
  private[mavlink] val Signed = 0x01

  val MostLength: Int = HeaderLength + 255 + ChecksumLength + SignatureLength
