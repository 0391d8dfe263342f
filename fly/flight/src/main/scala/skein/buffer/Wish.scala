package skein.buffer

import java.nio.charset.StandardCharsets.UTF_8
import skein.simulator.PlanCall
import upack.{Binary, Bool, Msg, Str}

/** What a client's call means to the buffer; other calls pass without its knowledge. A vehicle's name may be
  * empty: the simulator's default vehicle.
  */
private[buffer] enum Wish:
  /** A plan for a vehicle, or the text of the error that answers it. */
  case Plan(call: Either[String, PlanCall])

  /** Moves a vehicle: its plans end, and their numbers may begin anew. */
  case Move(vehicle: String)

  /** Lets a vehicle hover: its plans end, older ones too that are still on their way. */
  case Hover(vehicle: String)

  /** Ends what a vehicle does, like [[Hover]], without a move. */
  case Stop(vehicle: String)

  /** Places a vehicle: its plans end, as by [[Move]]. */
  case Place(vehicle: String)

  /** Ends the plans of all vehicles, and forgets their numbers. */
  case Reset

private[buffer] object Wish:
  /** Longest call that is read, bytes. Sixteen moves by velocity have some 2,000. */
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

  /** What a call means that is too long to be read: a move may be any vehicle's. */
  def ofLong(method: String): Option[Wish] =
    if method == PlanCall.Function then
      Some(Plan(Left(PlanCall.refusal(s"expected a plan of at most $MostBytes bytes, came more"))))
    else Option.when(PlanCall.isMove(method))(Reset)

  /** The last parameter of functions of one vehicle. */
  private def vehicleOf(params: IndexedSeq[Msg]): String = params.lastOption match
    case Some(Str(name))   => name
    case Some(Binary(raw)) => String(raw, UTF_8)
    case _                 => ""

  private def takesAway(params: IndexedSeq[Msg]) = params.headOption match
    case Some(Bool(on)) => !on
    case _              => false
