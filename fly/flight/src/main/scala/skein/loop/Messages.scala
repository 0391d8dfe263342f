package skein.loop

/** How one vehicle's controller learns the states of vehicles that it does not read itself: each controller
  * sends the readings of its own vehicle to the other controllers.
  */
trait Messages:

  /** Sends a reading of this controller's vehicle to all other controllers. */
  def send(reading: Reading): Unit

  /** Sets the receiver of each message that arrives: the sender's reading, received now, numbered by
    * [[Reading.relayed]].
    */
  def onReceived(take: Reading => Unit): Unit
