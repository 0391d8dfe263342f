package skein.port

/** The reason why a call to a vehicle failed. Failures are expected, so this is a value, not an exception.
  * `message` is one line for the user: what was expected, what was received, and where.
  */
enum VehicleError(val message: String):

  /** The answer was not received in time. The call may still be carried out. */
  case TimedOut(override val message: String) extends VehicleError(message)

  /** The vehicle rejected the call and gave a reason. */
  case Refused(override val message: String) extends VehicleError(message)

  /** The connection ended before the answer was received.
    *
    * @param mayHaveRun whether the call may have reached the vehicle
    */
  case Lost(override val message: String, mayHaveRun: Boolean) extends VehicleError(message)

  /** The address does not respond; nothing was sent. */
  case Unreachable(override val message: String) extends VehicleError(message)

  /** Too many calls are unanswered; nothing was sent. */
  case Overloaded(override val message: String) extends VehicleError(message)

  case Malformed(override val message: String) extends VehicleError(message)

  /** This side closed the connection before the answer. */
  case Cancelled(override val message: String) extends VehicleError(message)

  /** The vehicle has no such action or sensor; nothing was sent. */
  case Unsupported(override val message: String) extends VehicleError(message)

  /** Whether it is certain that the call neither had an effect nor will have one. */
  def isCertain: Boolean = this match
    case Lost(_, mayHaveRun)                                          => !mayHaveRun
    case Refused(_) | Overloaded(_) | Unreachable(_) | Unsupported(_) => true
    case TimedOut(_) | Malformed(_) | Cancelled(_)                    => false
