package skein.simulator

import skein.port.CommandPlan
import skein.units.{Expect, Instant}
import upack.{Arr, Msg, Str}

/** The function that gives a vehicle a plan: moves for several moments in one call. It is not one of
  * AirSim's. It answers immediately, and needs no worker: the vehicle has one move at a time, that of the
  * moment. Plans bear numbers, so that they may come over any connection: one that is older than another is
  * without effect. A move, a reset or `skeinHoverAt` begins the count anew; `hover` does not, and so a late
  * plan does not undo it.
  */
private[simulator] object PlanMethods:
  import ServerMethod.*

  /** A move and the moment from which it acts, on the simulator's clock.
    *
    * @param params of the function, without the vehicle
    */
  final case class PlannedCall(at: Instant, method: String, params: Vector[Msg])

  given Argument[PlannedCall] =
    case Arr(values) if values.size == 3 =>
      PlannedCall(
        summon[Argument[Instant]].read(values(0)),
        summon[Argument[String]].read(values(1)),
        values(2) match
          case Arr(params) => params.toVector
          case _           => throw BadArgument("expected a list of parameters")
      )
    case _ => throw BadArgument("expected a moment, a function's name and its parameters")

  val all: Seq[ServerMethod] = Seq(
    many[(Argument.Unsigned32, Seq[PlannedCall], String)]("skeinFollowPlan"):
      case (simulation, (sequence, calls, name)) =>
        multirotor(simulation, name): (index, _) =>
          CommandPlan.mistake(calls.map(_.at)).toLeft(orders(simulation, calls, name)).flatten match
            case Left(mistake) => CallOutcome.Threw(mistake)
            case Right(moves)  =>
              if moves.nonEmpty then simulation.follow(index, sequence, moves)
              answer(true)
  )

  private type Planned = Vector[(at: Instant, action: Move.Order)]

  private def orders(
      simulation: Simulated,
      calls: Seq[PlannedCall],
      name: String
  ): Either[String, Planned] =
    Expect.each(calls)(call => order(simulation, call, name).map(move => (at = call.at, action = move)))

  private def order(simulation: Simulated, call: PlannedCall, name: String): Either[String, Move.Order] =
    val params = call.params :+ Str(name)
    byName.get(call.method).toRight(s"expected a function that moves, came '${call.method}'").flatMap:
      method =>
        if !method.takes(params) then Left(s"wrong parameters of ${call.method}")
        else
          method(simulation, params) match
            case CallOutcome.Flies(_, order) => Right(order)
            case CallOutcome.Threw(text)     => Left(text)
            case _                           => Left(s"${call.method} is no move")

  private lazy val byName = MoveMethods.all.map(method => method.name -> method).toMap
