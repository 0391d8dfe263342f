package skein.buffer

import java.nio.charset.StandardCharsets.UTF_8
import skein.simulator.PlanCall
import upack.{Binary, Bool, Msg, Str}

/** The meaning of a client's call for the buffer, which does not see other calls. A vehicle's name may be
  * empty, for the simulator's default vehicle.
  */
private[buffer] enum Wish:
  /** A plan for a vehicle, or the text of the error with which the call is answered. */
  case Plan(call: Either[String, PlanCall])

  /** Moves a vehicle. Its plans end; a later plan may have any sequence number. */
  case Move(vehicle: String)

  /** Lets a vehicle hover. Its plans end; older ones that arrive later have no effect. */
  case Hover(vehicle: String)

  /** Ends a vehicle's plans like [[Hover]], by a call that is not a move. */
  case Stop(vehicle: String)

  /** Places a vehicle. Its plans end, as with [[Move]]. */
  case Place(vehicle: String)

  /** Ends the plans of all vehicles, and forgets their sequence numbers. */
  case Reset

private[buffer] object Wish:
  /** Maximum size of a call that is decoded, bytes. A plan of sixteen velocities takes about 2,000. */
  val MostBytes: Int = 64 << 10

  def of(method: String, params: IndexedSeq[Msg]): Option[Wish] = method match
    case PlanCall.Function                       => Some(Plan(PlanCall.of(params)))
    case "hover"                                 => Some(Hover(vehicleOf(params)))
    case move if PlanCall.isMove(move)           => Some(Move(vehicleOf(params)))
    case "cancelLastTask"                        => Some(Stop(vehicleOf(params)))
    case "enableApiControl" if takesAway(params) => Some(Stop(vehicleOf(params)))
    case "skeinHoverAt"                          => Some(Place(vehicleOf(params)))
    case "reset"                                 => Some(Reset)
    case _                                       => None

  /** The meaning of a call too long to decode. A long move may be for any vehicle, so it ends all plans. */
  def ofLong(method: String): Option[Wish] =
    if method == PlanCall.Function then
      Some(Plan(Left(PlanCall.refusal(s"expected a plan of at most $MostBytes bytes, got more"))))
    else Option.when(PlanCall.isMove(method))(Reset)

  /** The vehicle's name: the last parameter of functions of one vehicle. */
  private def vehicleOf(params: IndexedSeq[Msg]): String = params.lastOption match
    case Some(Str(name))   => name
    case Some(Binary(raw)) => String(raw, UTF_8)
    case _                 => ""

  private def takesAway(params: IndexedSeq[Msg]) = params.headOption match
    case Some(Bool(on)) => !on
    case _              => false
