package skein.port

/** Why a vehicle did not answer as asked. Expected, so a value. `message` is one line for a person: what was expected,
  * what came, where.
  */
enum VehicleError(val message: String):

  /** No answer in time. What was asked for may still happen. */
  case TimedOut(override val message: String) extends VehicleError(message)

  /** The vehicle will not do it, and says why. */
  case Refused(override val message: String) extends VehicleError(message)

  /** The connection ended before the answer came.
    *
    * @param mayHaveRun
    *   whether what was asked for may have reached the vehicle
    */
  case Lost(override val message: String, mayHaveRun: Boolean) extends VehicleError(message)

  /** Nobody answers there; nothing was asked for. */
  case Unreachable(override val message: String) extends VehicleError(message)

  /** A bound on what may be under way was met; nothing was asked for. */
  case Overloaded(override val message: String) extends VehicleError(message)

  /** What came is no answer. */
  case Malformed(override val message: String) extends VehicleError(message)

  /** It was given up because the connection was closed from this side. */
  case Cancelled(override val message: String) extends VehicleError(message)

  /** The vehicle knows no such action or sensor; nothing was asked for. */
  case Unsupported(override val message: String) extends VehicleError(message)

  /** Whether what was asked for certainly neither happens nor is on its way. */
  def isCertain: Boolean = this match
    case Lost(_, mayHaveRun)                                          => !mayHaveRun
    case Refused(_) | Overloaded(_) | Unreachable(_) | Unsupported(_) => true
    case TimedOut(_) | Malformed(_) | Cancelled(_)                    => false
