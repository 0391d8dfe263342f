package skein.scene

/** Numbers of a [[Moment]]'s items: the ground, then the scene's objects, then vehicles. */
object Item:
  val Nothing: Int = -1

  val Ground: Int = 0

  private[scene] val FirstObject = 1
