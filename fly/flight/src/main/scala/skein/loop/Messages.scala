package skein.loop

/** How the controller of one vehicle learns where the others are, where it does not read them itself: each
  * controller sends what it reads of its own vehicle to the others.
  */
trait Messages:

  /** Sends a reading of the own vehicle to all others. */
  def send(reading: Reading): Unit

  /** Sets who is given each message that arrives: the sender's reading, received now, with the number of
    * [[Reading.relayed]].
    */
  def onReceived(take: Reading => Unit): Unit
