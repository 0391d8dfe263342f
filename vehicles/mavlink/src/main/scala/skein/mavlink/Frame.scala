package skein.mavlink

/** A message that came, and from whom.
  *
  * @param system 1 to 255: a vehicle, or a ground station
  * @param component a part of it; 1 is the autopilot
  * @param sequence 0 to 255, one more with every frame of that component
  * @param isSigned whether it bore a signature that is right
  */
final case class Frame(
    system: Int,
    component: Int,
    sequence: Int,
    message: Message,
    isSigned: Boolean = false
)

object Frame:
  /** The first byte of every frame of MAVLink 2, and of MAVLink 1. */
  private[mavlink] val Start         = 0xfd
  private[mavlink] val StartVersion1 = 0xfe

  private[mavlink] val HeaderLength    = 10
  private[mavlink] val ChecksumLength  = 2
  private[mavlink] val SignatureLength = 13

  /** Of the flags that a receiver must know, the one that is known: a signature follows. */
  private[mavlink] val Signed = 0x01

  val MostLength: Int = HeaderLength + 255 + ChecksumLength + SignatureLength
