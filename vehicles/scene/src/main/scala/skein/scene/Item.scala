package skein.scene

/** How a [[Moment]] counts what is there: the ground, then the scene's objects, then vehicles. */
object Item:
  /** None of them. */
  val Nothing: Int = -1

  val Ground: Int = 0

  private[scene] val FirstObject = 1
