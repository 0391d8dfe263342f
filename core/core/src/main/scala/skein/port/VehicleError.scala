package skein.port

/** Why a call to a vehicle failed. Expected, so a value. `message` is one line for a person: what was
  * expected, what came, where.
  */
enum VehicleError(val message: String):

  /** No answer in time. The call may still be carried out. */
  case TimedOut(override val message: String) extends VehicleError(message)

  /** The vehicle will not do it, and says why. */
  case Refused(override val message: String) extends VehicleError(message)

  /** The connection ended before the answer came.
    *
    * @param mayHaveRun whether the call may have reached the vehicle
    */
  case Lost(override val message: String, mayHaveRun: Boolean) extends VehicleError(message)

  /** Nobody answers at the address; nothing was sent. */
  case Unreachable(override val message: String) extends VehicleError(message)

  /** Too many calls are unanswered; nothing was sent. */
  case Overloaded(override val message: String) extends VehicleError(message)

  /** The answer cannot be read. */
  case Malformed(override val message: String) extends VehicleError(message)

  /** The connection was closed from this side. */
  case Cancelled(override val message: String) extends VehicleError(message)

  /** The vehicle has no such action or sensor; nothing was sent. */
  case Unsupported(override val message: String) extends VehicleError(message)

  /** Whether the call is certainly neither carried out nor on its way. */
  def isCertain: Boolean = this match
    case Lost(_, mayHaveRun)                                          => !mayHaveRun
    case Refused(_) | Overloaded(_) | Unreachable(_) | Unsupported(_) => true
    case TimedOut(_) | Malformed(_) | Cancelled(_)                    => false
