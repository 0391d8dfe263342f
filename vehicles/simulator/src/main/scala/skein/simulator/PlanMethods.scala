package skein.simulator

import skein.units.Expect
import upack.Str

/** The function that gives a vehicle a plan: moves for several times in one call. AirSim has no such
  * function. It answers immediately and needs no worker, because the vehicle has one move at a time. Plans
  * are numbered, so that they may arrive over any connection: a plan that is older than the newest has no
  * effect. A move, a reset or `skeinHoverAt` restarts the numbering. `hover` does not, so that a late plan
  * does not undo it.
  */
private[simulator] object PlanMethods extends MethodList:
  import ServerMethod.*

  many[(Argument.Unsigned32, Seq[PlannedMove], String)](PlanCall.Function):
    case (simulation, (sequence, moves, name)) =>
      val call = PlanCall(sequence, moves.toVector, name)
      multirotor(simulation, name): (index, _) =>
        call.mistake.toLeft(orders(simulation, call)).flatten match
          case Left(mistake)  => CallOutcome.Threw(mistake)
          case Right(planned) =>
            if planned.nonEmpty then simulation.follow(index, sequence, planned)
            answer(true)

  private def orders(simulation: Simulated, call: PlanCall): Either[String, Move.Plan] =
    Expect.each(call.moves)(move =>
      order(simulation, move, call.vehicle).map(flies => (at = move.at, action = flies))
    )

  private def order(simulation: Simulated, move: PlannedMove, name: String): Either[String, Move.Order] =
    PlanCall.functions(move.method)(simulation, move.params :+ Str(name)) match
      case CallOutcome.Flies(_, order) => Right(order)
      case CallOutcome.Threw(text)     => Left(text)
      case _                           => Left(s"${move.method} is no move")
