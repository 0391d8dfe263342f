package skein.loop

import skein.policy.{Action, ActionGuidance, Fleet}
import skein.units.*
import skein.vehicle.{Guidance, Setpoint}

/** Converts decisions and sent moves to actions and setpoints. */
private object Acting:
  /** The command of a sent move for a vehicle model's prediction. */
  def guidance(fleet: Fleet, move: SentCommand): Guidance =
    val agent = fleet.agents(move.vehicle)
    move.action.fold {
      val velocity = agent.velocityNed(move.headingRad, move.speed)
      Setpoint.velocityZ(velocity.x, velocity.y, agent.startPositionNed.z)
    }(ActionGuidance.of)

  /** The action to command: the decided one, or for a heading the velocity along it, at the altitude of the
    * start.
    */
  def action(fleet: Fleet, decision: Decision): Action =
    decision.action.getOrElse:
      val agent    = fleet.agents(decision.vehicle)
      val velocity = agent.velocityNed(decision.heading.value, decision.speed)
      Action.VelocityAt(velocity.x, velocity.y, Metres(agent.startPositionNed.z))
