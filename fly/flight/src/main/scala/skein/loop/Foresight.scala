package skein.loop

import skein.forecast.Forecast
import skein.port.CommandPlan

/** Adds to each decision of a running loop the vehicle's foreseen actions. */
private final class Foresight(foreseen: Foreseen, starts: Vector[Memory]):
  import Foreseen.*

  @volatile private var minds = starts.map(Mind(_, None))

  // Each vehicle of a team foresees equal actions: those foreseen for one are kept for the others.
  @volatile private var last = Option.empty[(Forecast, Vector[Actions])]

  /** Notes a decision and the memory after it. */
  def decided(vehicle: Int, memory: Memory, decision: Decision): Unit = synchronized:
    minds = minds.updated(vehicle, Mind(memory, Some(decision)))

  /** A decision with its plan; one without predictions stays as it is. */
  def planned(decision: Decision): Decision =
    val foretold =
      for
        forecast  <- decision.view.forecast
        estimates <- decision.view.estimates
      yield (forecast, estimates(decision.vehicle).predictedFor)
    foretold.fold(decision): (forecast, actsAt) =>
      val later = of(forecast, decision)(decision.vehicle).filter(_.at > actsAt)
      val first = (at = actsAt, action = decision.performed)
      decision.copy(plan = Some(CommandPlan(decision.sequence, (first +: later).take(CommandPlan.Most))))

  private def of(forecast: Forecast, decision: Decision): Vector[Actions] =
    last.collect { case (of, actions) if of eq forecast => actions }.getOrElse:
      val asked = minds.map: mind =>
        mind.copy(decision = mind.decision.filter(_.view.forecast.exists(_ eq forecast)))
      val actions = foreseen.actions(decision.vehicle, decision.view, asked, decision.decidedAt)
      last = Some((forecast, actions))
      actions
